//! The node core.

use crate::settings::{Settings, descriptors};
use crate::{Conduct, Distances, Route, Step, Verdict, distances, shape_error};
use std::collections::BTreeMap;
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Advertise, Event, Files, Interface, JumpWatch, Latched, Level, Local, Master, NodeContext, NodeCore,
    NodeDescription, Qos, RosTime, Serve, Sink, Source, StartError, Steady, Subscribe, Times,
};
use trench_msgs::Message;
use trench_msgs::msg::{Goals, LeaderState, RunState, TeamState};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::std_srvs::{Trigger, TriggerRequest, TriggerResponse};

const TEAM_STATE: usize = 0;
const GOALS: usize = 1;
const RUN_STATE: usize = 2;
/// What robots say of themselves follows, where they are judged by their segments.
const ROBOTS: usize = 3;

const TARGET: usize = 0;

const ARM: usize = 0;
const START: usize = 1;
const STOP: usize = 2;
const RESET: usize = 3;

/// Seconds between looks at the run, and between lines of progress.
const LOOK: f64 = 0.1;
/// Seconds between two messages about the target.
const TARGET_PERIOD: f64 = 0.02;
const LINE: f64 = 2.0;

/// Arms, starts, watches, stops, judges.
pub struct Operator {
    interface: Interface,
    conduct: Conduct,
    team: Option<TeamState>,
    goals: Option<Goals>,
    run: Option<RunState>,
    /// What everybody says of the run, from which the one is chosen.
    runs: Latched<RunState>,
    /// Who writes each of the other topics.
    masters: BTreeMap<usize, Master>,
    next_look: Steady,
    next_line: Steady,
    robots: Vec<String>,
    /// Distance of each robot from its segment, m, where that is what counts.
    from_segments: Distances,
    by_segment: bool,
    route: Option<Route>,
    depart: f64,
    next_target: Steady,
    /// Seconds since t0 for which the target was led; it stays where it is once the run is over.
    led: f64,
    over: bool,
    jumps: JumpWatch,
}

/// The node as processes and the simulator make it.
#[must_use]
pub fn description() -> NodeDescription {
    NodeDescription {
        name: "operator",
        about: "Arms, starts, watches and stops a run; the exit code is its verdict (0 formed, 10 not formed, 11 aborted)",
        parameters: descriptors,
        build,
    }
}

fn build(_context: &NodeContext, parameters: &Parameters, _files: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let settings = Settings::read(parameters)?;
    let interface = interface(&settings);
    let Settings { duration, tolerance, start_timeout, robots, route, depart, by_segment, .. } = settings;
    Ok(Box::new(Operator {
        interface,
        conduct: Conduct::new(duration, tolerance, start_timeout, robots.len()),
        team: None,
        goals: None,
        run: None,
        runs: Latched::default(),
        masters: BTreeMap::new(),
        next_look: Steady(0),
        next_line: Steady(0),
        robots,
        from_segments: Distances::new(),
        by_segment,
        route,
        depart,
        next_target: Steady(0),
        led: 0.0,
        over: false,
        jumps: JumpWatch::default(),
    }))
}

fn interface(settings: &Settings) -> Interface {
    let assignment_node = &settings.assignment_node;
    // It looks ten times a second and need not wake for every frame.
    let mut subscriptions = vec![
        Subscribe::to::<TeamState>("/team_state", Qos::RELIABLE).without_waking(),
        Subscribe::to::<Goals>("/goals", Qos::RELIABLE).without_waking(),
        Subscribe::to::<RunState>("/run_state", Qos::LATCHED),
    ];
    if settings.by_segment {
        let state = |robot: &String| {
            Subscribe::to::<LeaderState>(format!("/{robot}/leader_state"), Qos::RELIABLE).without_waking()
        };
        subscriptions.extend(settings.robots.iter().map(state));
    }
    let target = settings.route.iter().map(|_| Advertise::of::<Odometry>("/target", Qos::RELIABLE, Local::SMALL));
    Interface {
        subscriptions,
        publications: target.collect(),
        clients: ["arm", "start", "stop", "reset"]
            .map(|name| Serve::of::<Trigger>(format!("{assignment_node}/{name}")))
            .into(),
        ..Interface::default()
    }
}

impl Operator {
    fn take(&mut self, at: Times, port: usize, source: Source, cdr: &[u8]) {
        // A message that does not decode or has numbers that are none, or of a second publisher, leaves the last good one in place: the nodes
        // that drive report it.
        if port != RUN_STATE && self.masters.entry(port).or_default().admit(source, at.steady).is_err() {
            return;
        }
        match port {
            TEAM_STATE => self.team = TeamState::decode(cdr).ok().filter(TeamState::is_finite).or(self.team.take()),
            GOALS => {
                self.goals = Goals::decode(cdr).ok().filter(Goals::is_finite).or(self.goals.take());
                if self.runs.are_several() {
                    self.choose_run();
                }
            }
            RUN_STATE => {
                if let Ok(run) = RunState::decode(cdr) {
                    self.runs.hear(source.gid, run);
                    self.choose_run();
                }
            }
            _ => {
                if let (Some(robot), Ok(said)) = (self.robots.get(port - ROBOTS), LeaderState::decode(cdr)) {
                    self.from_segments.insert(robot.clone(), said.segment_distance);
                }
            }
        }
    }

    /// As controllers do it (their inputs/orders.rs).
    fn choose_run(&mut self) {
        let epoch = self.goals.as_ref().map_or(0, |goals| goals.epoch);
        let chosen = self.runs.follow(epoch, |run| run.epoch);
        self.run = chosen.map(|(_, run)| run.clone());
    }

    /// Tells where the target is: at its first waypoint until it sets out.
    fn lead(&mut self, at: Times, sink: &mut dyn Sink) {
        let Some(route) = self.route.as_ref().filter(|_| at.steady >= self.next_target) else { return };
        self.next_target = at.steady.plus_seconds(TARGET_PERIOD);
        if let Some(elapsed) = self.run.as_ref().and_then(|run| Conduct::elapsed(at.ros, run)) {
            self.led = elapsed;
        }
        sink.publish(TARGET, &route.odometry(self.led - self.depart, at.ros));
    }

    fn look(&mut self, at: Times, sink: &mut dyn Sink) {
        self.next_look = at.steady.plus_seconds(LOOK);
        let (distances, shape) = match (&self.team, &self.goals) {
            (Some(team), Some(goals)) if !self.by_segment => (distances(team, goals), shape_error(team, goals)),
            (Some(team), Some(goals)) => (self.from_segments.clone(), shape_error(team, goals)),
            _ => Default::default(),
        };
        match self.conduct.step(at, self.run.as_ref(), &distances) {
            Step::Watch => {}
            Step::Reset => sink.call(RESET, &TriggerRequest::default()),
            Step::Arm => sink.call(ARM, &TriggerRequest::default()),
            Step::Start => sink.call(START, &TriggerRequest::default()),
            Step::Stop => sink.call(STOP, &TriggerRequest::default()),
            Step::End(verdict) => self.end(&verdict, sink),
        }
        let elapsed = self.run.as_ref().and_then(|run| Conduct::elapsed(at.ros, run));
        if let Some(elapsed) = elapsed.filter(|_| at.steady >= self.next_line && !self.over) {
            self.next_line = at.steady.plus_seconds(LINE);
            sink.log(Level::Info, &line(elapsed, &distances, shape));
        }
    }

    fn end(&mut self, verdict: &Verdict, sink: &mut dyn Sink) {
        self.over = true;
        match verdict {
            Verdict::Formed => sink.log(Level::Info, "the formation stands"),
            Verdict::NotFormed(why) => sink.log(Level::Error, &format!("the formation does not stand: {why}")),
            Verdict::Aborted(why) => sink.log(Level::Error, &format!("the run was aborted: {why}")),
        }
        sink.exit(verdict.exit_code());
    }

    fn answered(&mut self, cdr: Option<&[u8]>) {
        let response = cdr.and_then(|cdr| TriggerResponse::decode(cdr).ok());
        if let Some(TriggerResponse { success: false, message }) = response {
            self.conduct.refused(&message);
        }
    }
}

fn line(elapsed: f64, distances: &crate::Distances, shape: f64) -> String {
    let robots: Vec<String> = distances.iter().map(|(name, distance)| format!("{name} {distance:.3}")).collect();
    format!("t = {elapsed:5.1} s   shape error {shape:.3} m   to the goal (m): {}", robots.join("  "))
}

impl NodeCore for Operator {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        // leader_assignment will say so too, in its own time.
        if let (Some(jump), Some(run)) = (self.jumps.look(at), &mut self.run)
            && RosTime::from(&run.t0).0 != 0
        {
            run.t0 = RosTime(RosTime::from(&run.t0).0.saturating_add(jump)).into();
        }
        match event {
            Event::Started => (self.next_look, self.next_target) = (at.steady, at.steady),
            Event::Message { port, source, cdr, .. } => self.take(at, port, source, cdr),
            Event::Response { cdr, .. } => self.answered(cdr),
            _ => {}
        }
        if !self.over {
            self.lead(at, sink);
        }
        if at.steady >= self.next_look && !self.over {
            self.look(at, sink);
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        let next = if self.route.is_some() { self.next_look.min(self.next_target) } else { self.next_look };
        (!self.over).then_some(next)
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        Err(parameters.error("duration", "the operator's plan is fixed once it runs", "restart the operator"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_progress() {
        let distances = [("robot1".to_owned(), 0.0123), ("robot2".to_owned(), 0.5)].into();
        let expected = "t =  12.0 s   shape error 0.004 m   to the goal (m): robot1 0.012  robot2 0.500";
        assert_eq!(line(12.0, &distances, 0.004), expected);
    }

    #[test]
    fn time_counts_from_t0_while_running() {
        let run = RunState { state: RunState::RUNNING, t0: RosTime(2_000_000_000).into(), ..Default::default() };
        assert_eq!(Conduct::elapsed(RosTime(5_000_000_000), &run), Some(3.0));
        let idle = RunState { state: RunState::IDLE, ..run };
        assert_eq!(Conduct::elapsed(RosTime(5_000_000_000), &idle), None);
    }
}
