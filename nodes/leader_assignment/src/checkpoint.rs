//! What outlives the process: run state, zero of time, assignment (invariant 12).
//!
//! A checkpoint is there for a process that died and was started again. A clean end clears it, and one that is older than
//! [`FRESH`] is of another run: nobody wants yesterday's run to go on.

use crate::RunMachine;
use crate::held::Held;
use trench_core::RosTime;
use trench_msgs::msg::{Assignment, Formation, RunState};
use trench_msgs::std_msgs::Header;
use trench_msgs::{Encode, Message};

/// A checkpoint is rewritten every second and lasts this long, s: the time a supervisor takes to start a process again.
pub(crate) const FRESH: f64 = 10.0;

/// Between names: no name holds one.
const SEPARATOR: &str = "\n";

/// A checkpoint that has been read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Checkpoint {
    pub(crate) written: RosTime,
    pub(crate) run: RunMachine,
    pub(crate) assignment: Option<Assignment>,
    pub(crate) formation: Formation,
    /// All that take part, those that have quit too, in order of name.
    pub(crate) robots: Vec<String>,
    /// Hash of the formation that the process was started with.
    pub(crate) configured: u64,
    /// When virtual points set out, where that is not t0, and the size of the formation.
    pub(crate) since: Option<RosTime>,
    pub(crate) scale: f64,
}

/// The state of a run as it goes into a file: three messages, the robots' names, the hash of the first formation,
/// when the present one set out (0: at t0) and its scale, each behind its length.
#[must_use]
pub(crate) fn write(
    now: RosTime,
    run: &RunMachine,
    assignment: Option<&Assignment>,
    held: &Held,
    configured: u64,
) -> Vec<u8> {
    let state = RunState {
        header: Header { stamp: now.into(), frame_id: String::new() },
        state: run.state(),
        t0: run.t0().map(Into::into).unwrap_or_default(),
        reason: run.reason().to_owned(),
        ..RunState::default()
    };
    let mut bytes = Vec::new();
    let assignment = assignment.map(Encode::to_cdr).unwrap_or_default();
    let robots = held.robots.join(SEPARATOR).into_bytes();
    let numbers =
        [configured.to_le_bytes(), held.since.map_or(0, |since| since.0).to_le_bytes(), held.scale.to_le_bytes()];
    let parts = [state.to_cdr(), assignment, held.message.to_cdr(), robots].into_iter();
    for part in parts.chain(numbers.map(|number| number.to_vec())) {
        bytes.extend_from_slice(&(part.len() as u32).to_le_bytes());
        bytes.extend_from_slice(&part);
    }
    bytes
}

/// Reads it back, or nothing where the bytes are not what [`write`] makes: a damaged checkpoint is no checkpoint.
#[must_use]
pub(crate) fn read(bytes: &[u8]) -> Option<Checkpoint> {
    let (state, rest) = part(bytes)?;
    let (assignment, rest) = part(rest)?;
    let (formation, rest) = part(rest)?;
    let (robots, rest) = part(rest)?;
    let (configured, rest) = part(rest)?;
    let (since, rest) = part(rest)?;
    let (scale, rest) = part(rest)?;
    if !rest.is_empty() {
        return None;
    }
    let state = RunState::decode(state).ok()?;
    let t0 = RosTime::from(&state.t0);
    let run = RunMachine::resume(state.state, (t0.0 != 0).then_some(t0), state.reason.clone());
    let assignment = if assignment.is_empty() { None } else { Some(Assignment::decode(assignment).ok()?) };
    let formation = Formation::decode(formation).ok()?;
    let robots = std::str::from_utf8(robots).ok()?;
    let robots = robots.split(SEPARATOR).filter(|robot| !robot.is_empty()).map(str::to_owned).collect();
    let configured = u64::from_le_bytes(configured.try_into().ok()?);
    let since = Some(RosTime(i64::from_le_bytes(since.try_into().ok()?))).filter(|since| since.0 != 0);
    let scale = f64::from_le_bytes(scale.try_into().ok()?);
    let written = RosTime::from(&state.header.stamp);
    Some(Checkpoint { written, run, assignment, formation, robots, configured, since, scale })
}

fn part(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk::<4>()?;
    rest.split_at_checked(u32::from_le_bytes(*length) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Request;

    fn held() -> Held {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/formations/square.yaml");
        let plan = trench_plan::parse(path, &std::fs::read_to_string(path).unwrap()).unwrap();
        Held::new(plan, vec!["robot1".to_owned(), "robot2".to_owned()])
    }

    #[test]
    fn what_is_written_is_read() {
        let mut run = RunMachine::default();
        run.request(Request::Arm, Ok(())).unwrap();
        run.request(Request::Start, Ok(())).unwrap();
        run.localised(RosTime(1_500_000_000));
        let assignment = Assignment { epoch: 7, ..Default::default() };
        let written = RosTime(9_000_000_000);
        for (assignment, since) in [(Some(assignment), None), (None, Some(RosTime(2_000_000_000)))] {
            let held = Held { since, scale: 0.75, ..held() };
            let bytes = write(written, &run, assignment.as_ref(), &held, 9);
            let (run, formation, robots) = (run.clone(), held.message, held.robots);
            let expected =
                Checkpoint { written, run, assignment, formation, robots, configured: 9, since, scale: 0.75 };
            assert_eq!(read(&bytes), Some(expected));
        }
    }

    #[test]
    fn damage_is_noticed() {
        let bytes = write(RosTime(0), &RunMachine::default(), None, &held(), 9);
        for length in 0..bytes.len() {
            assert_eq!(read(&bytes[..length]), None, "cut to {length}");
        }
        assert_eq!(read(&[bytes, vec![0]].concat()), None);
        assert_eq!(read(&[0xff; 64]), None);
    }
}
