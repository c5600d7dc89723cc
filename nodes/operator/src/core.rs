//! The node core.

use crate::settings::{Settings, descriptors};
use crate::{Conduct, Step, Verdict, distances, shape_error};
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Event, Files, Interface, Level, NodeContext, NodeCore, NodeDescription, Qos, Serve, Sink, StartError, Steady,
    Subscribe, Times,
};
use trench_msgs::Message;
use trench_msgs::msg::{Goals, RunState, TeamState};
use trench_msgs::std_srvs::{Trigger, TriggerRequest, TriggerResponse};

const TEAM_STATE: usize = 0;
const GOALS: usize = 1;
const RUN_STATE: usize = 2;

const ARM: usize = 0;
const START: usize = 1;
const STOP: usize = 2;
const RESET: usize = 3;

/// Seconds between looks at the run, and between lines of progress.
const LOOK: f64 = 0.1;
const LINE: f64 = 2.0;

/// Arms, starts, watches, stops, judges.
pub struct Operator {
    interface: Interface,
    conduct: Conduct,
    team: Option<TeamState>,
    goals: Option<Goals>,
    run: Option<RunState>,
    next_look: Steady,
    next_line: Steady,
    over: bool,
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
    let Settings { duration, tolerance, start_timeout, robots, assignment_node } = settings;
    Ok(Box::new(Operator {
        interface: interface(&assignment_node),
        conduct: Conduct::new(duration, tolerance, start_timeout, robots.len()),
        team: None,
        goals: None,
        run: None,
        next_look: Steady(0),
        next_line: Steady(0),
        over: false,
    }))
}

fn interface(assignment_node: &str) -> Interface {
    Interface {
        subscriptions: vec![
            Subscribe::to::<TeamState>("/team_state", Qos::RELIABLE),
            Subscribe::to::<Goals>("/goals", Qos::RELIABLE),
            Subscribe::to::<RunState>("/run_state", Qos::LATCHED),
        ],
        clients: ["arm", "start", "stop", "reset"]
            .map(|name| Serve::of::<Trigger>(format!("{assignment_node}/{name}")))
            .into(),
        ..Interface::default()
    }
}

impl Operator {
    fn take(&mut self, port: usize, cdr: &[u8]) {
        // A message that does not decode leaves the last good one in place: the nodes that drive report it.
        match port {
            TEAM_STATE => self.team = TeamState::decode(cdr).ok().or(self.team.take()),
            GOALS => self.goals = Goals::decode(cdr).ok().or(self.goals.take()),
            RUN_STATE => self.run = RunState::decode(cdr).ok().or(self.run.take()),
            _ => {}
        }
    }

    fn look(&mut self, at: Times, sink: &mut dyn Sink) {
        self.next_look = at.steady.plus_seconds(LOOK);
        let (distances, shape) = match (&self.team, &self.goals) {
            (Some(team), Some(goals)) => (distances(team, goals), shape_error(team, goals)),
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
        match event {
            Event::Started => self.next_look = at.steady,
            Event::Message { port, cdr, .. } => self.take(port, cdr),
            Event::Response { cdr, .. } => self.answered(cdr),
            _ => {}
        }
        if at.steady >= self.next_look && !self.over {
            self.look(at, sink);
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        (!self.over).then_some(self.next_look)
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        Err(parameters.error("duration", "the operator's plan is fixed once it runs", "restart the operator"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_core::RosTime;

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
