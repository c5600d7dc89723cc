//! The steps of a run, as a state machine over what the operator sees.

use crate::Distances;
use trench_core::{RosTime, Steady, Times};
use trench_msgs::msg::RunState;

/// What the operator is to do next.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Nothing but watch.
    Watch,
    /// Call reset: an earlier run was stopped.
    Reset,
    /// Call arm.
    Arm,
    /// Call start.
    Start,
    /// Call stop: the time of the run is over.
    Stop,
    /// The run is over.
    End(Verdict),
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// Every robot within the tolerance of its goal.
    Formed,
    /// Some robot is too far from its goal, or not seen.
    NotFormed(String),
    /// The run never started or was stopped by somebody else.
    Aborted(String),
}

impl Verdict {
    /// The process's exit code: 0 formed, 10 not formed, 11 aborted.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Formed => 0,
            Self::NotFormed(_) => 10,
            Self::Aborted(_) => 11,
        }
    }
}

/// Seconds between two calls of the same service: long enough for the answer, short enough not to be noticed.
const RETRY: f64 = 0.5;

/// Where the run is, as the operator knows it.
#[derive(Debug, Clone)]
pub struct Conduct {
    duration: f64,
    tolerance: f64,
    start_timeout: f64,
    robots: usize,
    began: Option<Steady>,
    called: Option<Steady>,
    started: bool,
    stopping: Option<Verdict>,
    refusal: String,
}

impl Conduct {
    /// A run of `duration` seconds from t0 in which each of `robots` robots ends within `tolerance` metres of its goal,
    /// given up when it has not started after `start_timeout` seconds.
    #[must_use]
    pub fn new(duration: f64, tolerance: f64, start_timeout: f64, robots: usize) -> Self {
        Self {
            duration,
            tolerance,
            start_timeout,
            robots,
            began: None,
            called: None,
            started: false,
            stopping: None,
            refusal: "no answer from leader_assignment".to_owned(),
        }
    }

    /// Remembers why the last call was refused.
    pub fn refused(&mut self, why: &str) {
        why.clone_into(&mut self.refusal);
    }

    /// Seconds since t0, while running.
    #[must_use]
    pub fn elapsed(now: RosTime, run: &RunState) -> Option<f64> {
        let t0 = RosTime::from(&run.t0);
        (run.state == RunState::RUNNING && t0.0 != 0).then(|| now.seconds_since(t0))
    }

    /// The next step.
    pub fn step(&mut self, at: Times, run: Option<&RunState>, distances: &Distances) -> Step {
        let began = *self.began.get_or_insert(at.steady);
        let Some(run) = run else { return self.wait(at, began, Step::Watch) };
        if let Some(verdict) = &self.stopping {
            let over = run.state == RunState::STOPPED || self.tired(at);
            return if over { Step::End(verdict.clone()) } else { Step::Watch };
        }
        match run.state {
            RunState::IDLE => self.wait(at, began, Step::Arm),
            RunState::ARMED => self.wait(at, began, Step::Start),
            RunState::RUNNING => self.watch(at, run, distances),
            _ if self.started => Step::End(Verdict::Aborted(run.reason.clone())),
            _ => self.wait(at, began, Step::Reset),
        }
    }

    fn watch(&mut self, at: Times, run: &RunState, distances: &Distances) -> Step {
        self.started = true;
        match Self::elapsed(at.ros, run) {
            Some(elapsed) if elapsed >= self.duration => {
                self.stopping = Some(self.judge(distances));
                self.called = Some(at.steady);
                Step::Stop
            }
            _ => Step::Watch,
        }
    }

    fn wait(&mut self, at: Times, began: Steady, wish: Step) -> Step {
        if at.steady.seconds_since(began) > self.start_timeout {
            let why = format!("the run did not start within {} s: {}", self.start_timeout, self.refusal);
            return Step::End(Verdict::Aborted(why));
        }
        if wish == Step::Watch || !self.tired(at) {
            return Step::Watch;
        }
        self.called = Some(at.steady);
        wish
    }

    fn tired(&self, at: Times) -> bool {
        self.called.is_none_or(|called| at.steady.seconds_since(called) >= RETRY)
    }

    fn judge(&self, distances: &Distances) -> Verdict {
        if distances.len() < self.robots {
            return Verdict::NotFormed(format!("{} of {} robots are seen", distances.len(), self.robots));
        }
        let far = distances.iter().filter(|(_, distance)| **distance > self.tolerance);
        let far: Vec<String> = far.map(|(name, distance)| format!("{name} {distance:.3} m")).collect();
        if far.is_empty() {
            Verdict::Formed
        } else {
            Verdict::NotFormed(format!("further than {} m from their goals: {}", self.tolerance, far.join(", ")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: f64) -> Times {
        Times { ros: RosTime(1).plus_seconds(seconds), steady: Steady(0).plus_seconds(seconds) }
    }

    fn run(state: u8) -> RunState {
        RunState { state, t0: RosTime(1).into(), reason: "because".to_owned(), ..Default::default() }
    }

    fn near(distance: f64) -> Distances {
        [("robot1".to_owned(), distance)].into()
    }

    #[test]
    fn arms_starts_stops_and_judges() {
        let mut conduct = Conduct::new(10.0, 0.02, 5.0, 1);
        assert_eq!(conduct.step(at(0.0), None, &near(1.0)), Step::Watch);
        assert_eq!(conduct.step(at(0.1), Some(&run(RunState::IDLE)), &near(1.0)), Step::Arm);
        assert_eq!(conduct.step(at(0.2), Some(&run(RunState::IDLE)), &near(1.0)), Step::Watch, "waits for the answer");
        assert_eq!(conduct.step(at(0.7), Some(&run(RunState::ARMED)), &near(1.0)), Step::Start);
        assert_eq!(conduct.step(at(0.8), Some(&run(RunState::RUNNING)), &near(1.0)), Step::Watch);
        assert_eq!(conduct.step(at(10.1), Some(&run(RunState::RUNNING)), &near(0.01)), Step::Stop);
        let stopped = conduct.step(at(10.2), Some(&run(RunState::STOPPED)), &near(0.01));
        assert_eq!(stopped, Step::End(Verdict::Formed));
    }

    #[test]
    fn tells_who_is_too_far() {
        let mut conduct = Conduct::new(1.0, 0.02, 5.0, 1);
        conduct.step(at(0.0), Some(&run(RunState::RUNNING)), &near(1.0));
        conduct.step(at(1.5), Some(&run(RunState::RUNNING)), &near(0.5));
        let end = conduct.step(at(1.6), Some(&run(RunState::STOPPED)), &near(0.5));
        let why = "further than 0.02 m from their goals: robot1 0.500 m".to_owned();
        assert_eq!(end, Step::End(Verdict::NotFormed(why)));
    }

    #[test]
    fn gives_up_with_the_reason_of_the_last_refusal() {
        let mut conduct = Conduct::new(1.0, 0.02, 5.0, 1);
        conduct.step(at(0.0), Some(&run(RunState::IDLE)), &near(1.0));
        conduct.refused("robot2 is not localised");
        let end = conduct.step(at(5.1), Some(&run(RunState::IDLE)), &near(1.0));
        let why = "the run did not start within 5 s: robot2 is not localised".to_owned();
        assert_eq!(end, Step::End(Verdict::Aborted(why)));
    }

    #[test]
    fn what_an_earlier_run_left_is_reset() {
        let mut conduct = Conduct::new(10.0, 0.02, 5.0, 1);
        assert_eq!(conduct.step(at(0.0), Some(&run(RunState::STOPPED)), &near(1.0)), Step::Reset);
        assert_eq!(conduct.step(at(0.6), Some(&run(RunState::IDLE)), &near(1.0)), Step::Arm);
    }

    #[test]
    fn a_stop_by_somebody_else_ends_the_run() {
        let mut conduct = Conduct::new(10.0, 0.02, 5.0, 1);
        conduct.step(at(0.0), Some(&run(RunState::RUNNING)), &near(1.0));
        let end = conduct.step(at(1.0), Some(&run(RunState::STOPPED)), &near(1.0));
        assert_eq!(end, Step::End(Verdict::Aborted("because".to_owned())));
    }
}
