//! What an operator may ask for: the steps of a run, and another formation.

use crate::core::{FORMATION, LeaderAssignment};
use crate::held::Held;
use crate::settings::admit_robots;
use crate::{Request, organise};
use trench_core::{Condition, Level, RequestId, RosTime, Sink, Times};
use trench_formation::Vector2;
use trench_msgs::Message;
use trench_msgs::msg::Formation;
use trench_msgs::msg::{SetFormationRequest, SetFormationResponse};
use trench_msgs::std_srvs::TriggerResponse;
use trench_plan::plan_from_message;

/// In the order of the services: ~/arm, ~/start, ~/stop, ~/reset; ~/set_formation follows.
const REQUESTS: [Request; 4] = [Request::Arm, Request::Start, Request::Stop, Request::Reset];

/// Formations are made larger or smaller by this much at most.
const MOST_SCALE: f64 = 100.0;

impl LeaderAssignment {
    pub(crate) fn serve(&mut self, at: Times, (service, id): (usize, RequestId), cdr: &[u8], sink: &mut dyn Sink) {
        if let Some(&request) = REQUESTS.get(service) {
            let response = self.request(at, request, sink);
            sink.respond(service, id, &response);
            return;
        }
        let answer = match SetFormationRequest::decode(cdr) {
            Ok(request) => self.chosen(&request).and_then(|held| self.hold(at, held, sink)),
            Err(error) => Err(error.to_string()),
        };
        let response = self.told(answer, sink);
        sink.respond(service, id, &response);
    }

    fn request(&mut self, at: Times, request: Request, sink: &mut dyn Sink) -> TriggerResponse {
        if !self.run.running() {
            self.target.forget_if_silent(at.steady);
        }
        let ready = self.ready();
        let answer = self.run.request(request, ready);
        if answer.is_ok() {
            if matches!(request, Request::Arm | Request::Start) {
                self.held.since = None;
                self.members.begin();
                self.assign(at, sink);
            }
            self.announce(at, sink);
        }
        let (success, message) = match answer {
            Ok(message) => (true, message),
            Err(message) => (false, message),
        };
        sink.log(Level::Info, &format!("{request:?}: {message}"));
        TriggerResponse { success, message }
    }

    /// Somebody sent a formation to hold from now on.
    pub(crate) fn formation_asked(&mut self, at: Times, message: &Formation, sink: &mut dyn Sink) {
        let answer = match plan_from_message(message) {
            Ok(plan) => self.hold(at, Held::new(plan, self.held.robots.clone()), sink),
            Err(error) => Err(error.to_string()),
        };
        self.told(answer, sink);
    }

    /// The formation that a request means, with its robots. The same request twice means the same: an answer may be lost.
    fn chosen(&self, request: &SetFormationRequest) -> Result<Held, String> {
        let named = |name: &str| {
            let known = || self.settings.library.iter().map(|plan| plan.name.as_str()).collect::<Vec<_>>().join(", ");
            let plan = self.settings.library.iter().find(|plan| plan.name == name);
            plan.ok_or_else(|| format!("no formation is called {name}; there are {}", known()))
        };
        let (plan, present) = match request.name.as_str() {
            "" => (&self.held.original, self.held.scale),
            name => (named(name)?, 1.0),
        };
        let scale = if request.scale == 0.0 { present } else { request.scale };
        if !(scale.is_finite() && scale > 0.0 && scale <= MOST_SCALE) {
            return Err(format!("scale is {scale}: write a factor above 0, up to {MOST_SCALE}"));
        }
        let robots = if request.robots.is_empty() { self.held.robots.clone() } else { request.robots.clone() };
        Held::at_scale(plan, scale, admit_robots(&robots, &self.settings.robots)?)
    }

    /// Puts a formation into force, if it fits.
    fn hold(&mut self, at: Times, mut held: Held, sink: &mut dyn Sink) -> Result<String, String> {
        let Held { plan, robots, .. } = &held;
        if robots.len() > plan.places() {
            return Err(format!("{} robots, but {} has {} places", robots.len(), plan.name, plan.places()));
        }
        self.settings.room.admit(plan)?;
        let missing = self.unlocalised(robots);
        if self.run.running() && !missing.is_empty() {
            return Err(format!("not localised: {}", missing.join(", ")));
        }
        if held.message.hash == self.held.message.hash && held.robots == self.held.robots {
            return Ok(format!("{} is in force already", held.plan.name));
        }
        held.since = if held.goes_on_from(&self.held) { self.held.since } else { self.run.running().then_some(at.ros) };
        // Positions that make no assignment are refused before anything changes.
        let known: Vec<(String, Vector2<f64>)> = self.positions(&held, at).unwrap_or_default();
        organise(&held.plan, &known, &self.seats, self.settings.seating).map_err(|error| error.to_string())?;
        let text = format!("{} with {} robots is in force", held.plan.name, held.robots.len());
        self.held = held;
        sink.publish(FORMATION, &self.held.stamped(at.ros));
        if self.assignment.is_some() {
            self.assign(at, sink);
        }
        self.announce(at, sink);
        Ok(text)
    }

    fn told(&mut self, answer: Result<String, String>, sink: &mut dyn Sink) -> SetFormationResponse {
        let (success, message) = match answer {
            Ok(message) => (true, message),
            Err(message) => (false, format!("the formation stays as it is: {message}")),
        };
        let (condition, level) = if success { (Condition::Ok, Level::Info) } else { (Condition::Warn, Level::Warn) };
        self.health.set("formation", condition, message.clone());
        sink.log(level, &message);
        SetFormationResponse { success, message }
    }

    /// Somebody set the wall clock: a run goes on at the age that it has.
    pub(crate) fn clock_jumped(&mut self, at: Times, jump: i64, sink: &mut dyn Sink) {
        sink.log(
            Level::Warn,
            &format!("the clock jumped by {:.3} s, and with it what a run counts from", 1e-9 * jump as f64),
        );
        self.held.since = self.held.since.map(|since| RosTime(since.0.saturating_add(jump)));
        if self.run.move_with_clock(jump) {
            self.announce(at, sink);
        }
    }

    /// Seconds for which the present formation has been moving: since t0, or since it replaced one of another shape.
    pub(crate) fn elapsed(&self, stamp: RosTime) -> f64 {
        let began = self.run.t0().map(|t0| self.held.since.map_or(t0, |since| since.max(t0)));
        began.map_or(0.0, |began| stamp.seconds_since(began))
    }
}
