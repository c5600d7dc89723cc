//! Faults that are put into a test bed on purpose, each for its time.

use crate::air::Station;
use std::collections::BTreeSet;
use trench_optics::Pose2;

/// A fault with its time.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// When it begins, ns after the bed's start.
    pub from: u64,
    /// When it is over, ns after the bed's start.
    pub to: u64,
    /// What is wrong.
    pub kind: FaultKind,
}

/// What can be wrong. Robots are indices.
#[derive(Debug, Clone, PartialEq)]
pub enum FaultKind {
    /// Wheels turn as told and move the robot by this share of the way only: 0 is a wheel that is stuck.
    Slip {
        /// Whose wheels.
        robots: Vec<usize>,
        /// Shares of the left and the right wheel.
        grip: [f64; 2],
    },
    /// Somebody carries a robot somewhere else, at once.
    Carried {
        /// Which.
        robot: usize,
        /// Where to.
        pose: Pose2,
    },
    /// The battery has this voltage.
    Battery {
        /// Whose.
        robots: Vec<usize>,
        /// mV.
        millivolts: u16,
    },
    /// The radios of these robots are off.
    Silent {
        /// Whose.
        robots: Vec<usize>,
    },
    /// These robots are switched off; at the end they are switched on again, and know nothing of before.
    Off {
        /// Which.
        robots: Vec<usize>,
    },
    /// Somebody has given this robot the id of another one and switched it off and on.
    Doubled {
        /// Which.
        robot: usize,
        /// As whom it answers.
        like: usize,
    },
    /// These robots do not hear each other; everybody else hears them.
    Parted {
        /// Which.
        robots: Vec<usize>,
    },
    /// These robots and the base station do not hear each other; their neighbours hear both.
    Far {
        /// Which.
        robots: Vec<usize>,
    },
    /// Somebody else is on the air who has no key.
    Intruder(Intrusion),
    /// Motors miss this share of the steps that they are told to make.
    Missed {
        /// Whose.
        robots: Vec<usize>,
        /// 0 to 1.
        share: f64,
    },
    /// Everybody misses this share of the packets.
    Loss {
        /// 0 to 1.
        loss: f64,
    },
    /// Something lies on the pads of these robots.
    Covered {
        /// Which.
        robots: Vec<usize>,
    },
    /// Something is wrong with the camera.
    Frames(FrameFault),
    /// Nobody is told where obstacles are.
    Untold,
    /// What the lasers of these robots see is not told.
    Blind {
        /// Whose.
        robots: Vec<usize>,
    },
}

/// What somebody without the key does on the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Intrusion {
    /// Sends commands of its own right behind the base station's: full speed ahead.
    Forged,
    /// Sends what the base station said half a second ago once more.
    Replayed,
    /// Sends all that the base station said since the beginning once more, in its order, and then again.
    Recorded,
    /// Spoils a bit of half of the base station's packets.
    Corrupted,
}

/// What can be wrong with frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameFault {
    /// None comes.
    Stopped,
    /// The last one comes again and again with fresh stamps.
    Frozen,
    /// They are black.
    Black,
    /// Their lower half is black.
    Half,
    /// They come so much later, ns.
    Late(u64),
    /// Only each so-manieth comes.
    Every(u64),
}

impl FaultKind {
    /// As files name it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Slip { .. } => "slip",
            Self::Carried { .. } => "carried",
            Self::Battery { .. } => "battery",
            Self::Silent { .. } => "silent",
            Self::Off { .. } => "switched_off",
            Self::Doubled { .. } => "doubled",
            Self::Parted { .. } => "parted",
            Self::Far { .. } => "far",
            Self::Intruder(Intrusion::Forged) => "forged",
            Self::Intruder(Intrusion::Replayed) => "replayed",
            Self::Intruder(Intrusion::Recorded) => "recorded",
            Self::Intruder(Intrusion::Corrupted) => "corrupted",
            Self::Missed { .. } => "missed",
            Self::Loss { .. } => "loss",
            Self::Covered { .. } => "covered",
            Self::Frames(FrameFault::Stopped) => "stopped",
            Self::Frames(FrameFault::Frozen) => "frozen",
            Self::Frames(FrameFault::Black) => "black",
            Self::Frames(FrameFault::Half) => "half",
            Self::Frames(FrameFault::Late(_)) => "late",
            Self::Frames(FrameFault::Every(_)) => "every",
            Self::Untold => "untold",
            Self::Blind { .. } => "blind",
        }
    }
}

/// All faults of a bed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Faults {
    faults: Vec<Fault>,
}

impl Faults {
    /// These.
    #[must_use]
    pub fn new(faults: Vec<Fault>) -> Self {
        Self { faults }
    }

    /// Those in force at `time` (ns after the start).
    pub fn at(&self, time: u64) -> impl Iterator<Item = &FaultKind> {
        self.faults.iter().filter(move |fault| (fault.from..fault.to).contains(&time)).map(|fault| &fault.kind)
    }

    /// Whether there is any fault at any time that `is`.
    pub(crate) fn any(&self, is: impl Fn(&FaultKind) -> bool) -> bool {
        self.faults.iter().any(|fault| is(&fault.kind))
    }

    /// When something begins or ends next after `time`, ns after the start.
    pub(crate) fn next_change(&self, time: u64) -> Option<u64> {
        self.faults.iter().flat_map(|fault| [fault.from, fault.to]).filter(|change| *change > time).min()
    }

    /// Robots that are carried away between `after` and `until`, that instant included.
    pub(crate) fn carried(&self, after: Option<u64>, until: u64) -> impl Iterator<Item = (usize, Pose2)> {
        let now = move |from: u64| after.is_none_or(|after| from > after) && from <= until;
        self.faults.iter().filter_map(move |fault| match fault.kind {
            FaultKind::Carried { robot, pose } if now(fault.from) => Some((robot, pose)),
            _ => None,
        })
    }
}

/// Who does not hear whom.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Cuts {
    pub(crate) silent: BTreeSet<usize>,
    /// Who and the base station do not hear each other.
    pub(crate) far: BTreeSet<usize>,
    pub(crate) parted: Vec<BTreeSet<usize>>,
}

impl Cuts {
    pub(crate) fn separates(&self, from: Station, to: Station) -> bool {
        let silent = |station| matches!(station, Station::Robot(robot) if self.silent.contains(&robot));
        let apart = match (from, to) {
            (Station::Robot(one), Station::Robot(other)) => {
                self.parted.iter().any(|group| group.contains(&one) && group.contains(&other))
            }
            (Station::Robot(robot), Station::Base) | (Station::Base, Station::Robot(robot)) => {
                self.far.contains(&robot)
            }
            (Station::Base, Station::Base) => false,
        };
        apart || silent(from) || silent(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_have_their_time() {
        let covered = FaultKind::Covered { robots: vec![1] };
        let pose = Pose2 { x: 1.0, y: 1.0, theta: 0.0 };
        let carried = FaultKind::Carried { robot: 0, pose };
        let faults = Faults::new(vec![
            Fault { from: 10, to: 20, kind: covered.clone() },
            Fault { from: 15, to: 30, kind: carried },
        ]);
        assert_eq!(faults.at(9).count(), 0);
        assert_eq!(faults.at(10).collect::<Vec<_>>(), [&covered]);
        assert_eq!(faults.at(20).count(), 1);
        assert_eq!(faults.at(30).count(), 0);
        assert_eq!(
            [0, 10, 15, 20, 30].map(|time| faults.next_change(time)),
            [Some(10), Some(15), Some(20), Some(30), None]
        );
        assert_eq!(faults.carried(Some(14), 15).collect::<Vec<_>>(), [(0, pose)]);
        assert_eq!(faults.carried(Some(15), 40).count(), 0);
    }
}
