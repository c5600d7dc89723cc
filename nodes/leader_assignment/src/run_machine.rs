//! The run state: changed by the services alone. A robot that is lost rests by itself, the others go on.

use trench_core::RosTime;
use trench_msgs::msg::RunState;

/// A request of the operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Request {
    /// IDLE to ARMED: checks that everything is there.
    Arm,
    /// ARMED to RUNNING.
    Start,
    /// Anything to STOPPED.
    Stop,
    /// STOPPED (or ARMED) to IDLE.
    Reset,
}

/// The run's state and its zero of time.
#[derive(Debug, Clone, PartialEq)]
pub struct RunMachine {
    state: u8,
    t0: Option<RosTime>,
    reason: String,
}

impl Default for RunMachine {
    fn default() -> Self {
        Self { state: RunState::IDLE, t0: None, reason: "not armed".to_owned() }
    }
}

impl RunMachine {
    /// A machine that goes on where an earlier life of the process was.
    #[must_use]
    pub fn resume(state: u8, t0: Option<RosTime>, reason: String) -> Self {
        Self { state, t0, reason }
    }

    /// One of `RunState`'s constants.
    #[must_use]
    pub fn state(&self) -> u8 {
        self.state
    }

    /// Why the state is what it is.
    #[must_use]
    pub fn reason(&self) -> &str {
        &self.reason
    }

    /// The first tick with all robots localised while running.
    #[must_use]
    pub fn t0(&self) -> Option<RosTime> {
        self.t0
    }

    /// Whether controllers drive.
    #[must_use]
    pub fn running(&self) -> bool {
        self.state == RunState::RUNNING
    }

    /// Carries out a request. `ready` is what speaks against moving, if anything.
    ///
    /// # Errors
    /// A sentence for the operator when the request does not fit the state or the robots are not ready.
    pub fn request(&mut self, request: Request, ready: Result<(), String>) -> Result<String, String> {
        let (state, reason) = match (request, self.state) {
            (Request::Arm, RunState::IDLE) => {
                ready?;
                (RunState::ARMED, "armed, waiting for start")
            }
            (Request::Start, RunState::ARMED) => {
                ready?;
                (RunState::RUNNING, "started by the operator")
            }
            (Request::Stop, _) => (RunState::STOPPED, "stopped by the operator"),
            (Request::Reset, RunState::STOPPED | RunState::ARMED | RunState::IDLE) => (RunState::IDLE, "reset"),
            (request, state) => return Err(refusal(request, state)),
        };
        self.enter(state, reason);
        Ok(self.reason.clone())
    }

    /// The process ends, and the run with it. Gives whether it was running.
    pub fn end(&mut self) -> bool {
        let was_running = self.running();
        if was_running {
            self.enter(RunState::STOPPED, "leader_assignment has ended");
        }
        was_running
    }

    /// Tells that all robots are localised at `stamp`; sets t0 the first time while running. Gives whether it was set.
    pub fn localised(&mut self, stamp: RosTime) -> bool {
        let first = self.running() && self.t0.is_none();
        if first {
            self.t0 = Some(stamp);
        }
        first
    }

    /// The clock was set: the zero of time goes with it (ns). Gives whether there is one.
    pub fn move_with_clock(&mut self, jump: i64) -> bool {
        self.t0 = self.t0.map(|t0| RosTime(t0.0.saturating_add(jump)));
        self.t0.is_some()
    }

    fn enter(&mut self, state: u8, reason: &str) {
        if state == RunState::IDLE || state == RunState::ARMED {
            self.t0 = None;
        }
        self.state = state;
        reason.clone_into(&mut self.reason);
    }
}

/// The name of a state for people.
#[must_use]
pub fn state_name(state: u8) -> &'static str {
    match state {
        RunState::IDLE => "idle",
        RunState::ARMED => "armed",
        RunState::RUNNING => "running",
        RunState::STOPPED => "stopped",
        _ => "unknown",
    }
}

fn refusal(request: Request, state: u8) -> String {
    let (wish, from) = match request {
        Request::Arm => ("arm", "idle (call reset first)"),
        Request::Start => ("start", "armed (call arm first)"),
        Request::Reset => ("reset", "stopped (call stop first)"),
        Request::Stop => ("stop", "any state"),
    };
    format!("cannot {wish}: the run is {}, it must be {from}", state_name(state))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn machine_after(requests: &[Request]) -> RunMachine {
        let mut machine = RunMachine::default();
        for request in requests {
            machine.request(*request, Ok(())).unwrap();
        }
        machine
    }

    #[test]
    fn the_way_through_a_run() {
        let mut machine = machine_after(&[Request::Arm, Request::Start]);
        assert!(machine.running());
        assert_eq!(machine.t0(), None);
        assert!(machine.localised(RosTime(5)));
        assert!(!machine.localised(RosTime(6)));
        assert_eq!(machine.t0(), Some(RosTime(5)));
        assert!(machine.move_with_clock(-3) && machine.move_with_clock(3));
        machine.request(Request::Stop, Ok(())).unwrap();
        assert_eq!(machine.t0(), Some(RosTime(5)), "the zero of time outlives the stop");
        machine.request(Request::Reset, Ok(())).unwrap();
        assert_eq!((machine.state(), machine.t0()), (RunState::IDLE, None));
    }

    #[test]
    fn requests_out_of_order_are_refused_with_the_way_out() {
        let mut machine = RunMachine::default();
        let refused = machine.request(Request::Start, Ok(())).unwrap_err();
        assert_eq!(refused, "cannot start: the run is idle, it must be armed (call arm first)");
        let mut running = machine_after(&[Request::Arm, Request::Start]);
        assert!(running.request(Request::Reset, Ok(())).is_err());
        assert!(running.request(Request::Arm, Ok(())).is_err());
        assert!(running.running());
    }

    #[test]
    fn nothing_moves_before_all_is_ready() {
        let mut machine = RunMachine::default();
        let missing = Err("robot2 is not localised".to_owned());
        assert_eq!(machine.request(Request::Arm, missing).unwrap_err(), "robot2 is not localised");
        assert_eq!(machine.state(), RunState::IDLE);
    }

    #[test]
    fn a_run_ends_with_its_process_and_what_does_not_run_stays_as_it_is() {
        let mut running = machine_after(&[Request::Arm, Request::Start]);
        assert!(running.end() && running.state() == RunState::STOPPED);
        let mut armed = machine_after(&[Request::Arm]);
        assert!(!armed.end() && armed.state() == RunState::ARMED);
    }

    #[test]
    fn stop_is_always_obeyed() {
        for before in [&[][..], &[Request::Arm], &[Request::Arm, Request::Start]] {
            let mut machine = machine_after(before);
            machine.request(Request::Stop, Err("not ready".to_owned())).unwrap();
            assert_eq!(machine.state(), RunState::STOPPED);
        }
    }
}
