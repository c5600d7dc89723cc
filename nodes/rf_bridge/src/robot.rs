//! One robot as the bridge knows it: who commands it, what, and since when.

use crate::dither::Dither;
use crate::drive::wheels;
use crate::monitor::Monitor;
use crate::odometry::WheelOdometry;
use crate::relays::Reach;
use crate::settings::Tuning;
use crate::twins::Twins;
use trench_core::{Master, RosTime, Source, Steady, Times};
use trench_msgs::geometry_msgs::Twist;
use trench_radio::{WheelTimer, Wheels};

/// A stamp this far ahead of the clock is no stamp, s.
const FUTURE: f64 = 0.05;

/// A command that would be obeyed for less time than this, s, is not worth sending: frames come every 33 ms, and the time that one
/// frame gives holds for all robots in it.
const SHORTEST: f64 = 0.04;

/// A robot without a command for this long is not waited for, s.
const EXPECTED: f64 = 0.2;

/// Why a command was not taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Refusal {
    #[error("another publisher commands this robot")]
    Master,
    #[error("it is not a finite number")]
    NotFinite,
    #[error("it is beyond limits.linear or limits.angular")]
    OutOfRange,
    #[error("it is older than age.information")]
    Old,
    #[error("it is stamped in the future")]
    Future,
    #[error(
        "it has no stamp, so nobody knows how old it is: fill header.stamp (`ros2 topic pub`: `header: auto`), or set stamped to \
         false and send Twist"
    )]
    Unstamped,
}

/// A command that was taken.
#[derive(Debug, Clone, Copy)]
struct Command {
    received: Steady,
    stamp: Option<RosTime>,
    /// Of the information it rests on, when it was received, s.
    age: f64,
    v: f64,
    omega: f64,
}

/// How old what a command rests on is.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Dated {
    /// It says so.
    Stamp(RosTime),
    /// It has no stamp, and is taken for so old, s.
    Age(f64),
}

/// What a frame says to one robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Order {
    /// Turn the wheels, for so many seconds from the robot's receipt.
    Drive(Wheels, f64),
    /// Stand still.
    Stop,
    /// Nothing: it goes on with what it has.
    Silence,
}

/// A robot.
#[derive(Debug, Clone)]
pub(crate) struct Robot {
    pub(crate) name: String,
    pub(crate) id: u8,
    pub(crate) twins: Twins,
    pub(crate) monitor: Monitor,
    pub(crate) odometry: WheelOdometry,
    pub(crate) reach: Reach,
    /// Whether it was heard when that was looked at last.
    pub(crate) was_up: bool,
    /// Commands that were too old when the line was free.
    pub(crate) expired: u64,
    master: Master,
    /// When a command was taken last.
    commanded: Option<Steady>,
    command: Option<Command>,
    driven_at: Option<Steady>,
    dither: Dither,
}

impl Robot {
    pub(crate) fn new(name: String, id: u8) -> Self {
        Self {
            name,
            id,
            twins: Twins::default(),
            monitor: Monitor::default(),
            odometry: WheelOdometry::default(),
            reach: Reach::default(),
            was_up: false,
            expired: 0,
            master: Master::default(),
            commanded: None,
            command: None,
            driven_at: None,
            dither: Dither::default(),
        }
    }

    /// Takes a command. Each robot has one master: the publisher heard first, until it falls silent.
    pub(crate) fn accept(
        &mut self,
        at: Times,
        source: Source,
        twist: &Twist,
        dated: Dated,
        tuning: &Tuning,
    ) -> Result<(), Refusal> {
        self.master.check(source, at.steady, tuning.silence).map_err(|_| Refusal::Master)?;
        let numbers =
            [twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.x, twist.angular.y, twist.angular.z];
        if !numbers.iter().all(|number| number.is_finite()) {
            return Err(Refusal::NotFinite);
        }
        let (v, omega) = (twist.linear.x, twist.angular.z);
        if v.abs() > tuning.max_v || omega.abs() > tuning.max_omega {
            return Err(Refusal::OutOfRange);
        }
        let (stamp, age) = match dated {
            // ROS's way to leave it out.
            Dated::Stamp(RosTime(0)) => return Err(Refusal::Unstamped),
            Dated::Stamp(stamp) => (Some(stamp), at.ros.seconds_since(stamp)),
            Dated::Age(age) => (None, age),
        };
        if age < -FUTURE {
            return Err(Refusal::Future);
        }
        if age > tuning.information_age {
            // It knows nothing new, and is there.
            if self.master.is(source) {
                self.master.pin(source, at.steady);
            }
            return Err(Refusal::Old);
        }
        self.master.pin(source, at.steady);
        self.commanded = Some(at.steady);
        self.command = Some(Command { received: at.steady, stamp, age: age.max(0.0), v, omega });
        Ok(())
    }

    /// Whether what it is told, if anything, is to turn on the spot no faster than `most`, rad/s.
    pub(crate) fn only_turns(&self, most: f64) -> bool {
        self.command.is_none_or(|command| command.v == 0.0 && command.omega.abs() <= most)
    }

    /// Whether a command waits to be sent, and with which stamp.
    pub(crate) fn waiting(&self) -> Option<Option<RosTime>> {
        self.command.map(|command| command.stamp)
    }

    /// Whether a command may be expected in every camera frame.
    pub(crate) fn expected(&self, now: Steady) -> bool {
        self.commanded.is_some_and(|last| now.seconds_since(last) <= EXPECTED)
    }

    /// Forgets what it was told.
    pub(crate) fn halt(&mut self) {
        self.command = None;
        self.driven_at = None;
        self.dither.reset();
    }

    /// What the next frame tells it. It arrives after `line` seconds at the latest, and the time in the air; or, where that is more,
    /// after what a report and the packet that it names took lately: whoever holds all packets back does not make them younger. Until
    /// that is known, nobody drives: how old a packet is when it comes only the robot can tell, and only by the ones before.
    pub(crate) fn order(&mut self, now: Steady, line: f64, tuning: &Tuning) -> Order {
        let Some(round_trip) = self.monitor.least_round_trip(now) else {
            self.halt();
            return Order::Stop;
        };
        let transport = line.max(round_trip) + tuning.radio_delay;
        let obeying = self.driven_at.is_some_and(|at| now.seconds_since(at) <= tuning.frame_age);
        let Some(command) = self.command.take() else {
            if obeying {
                return Order::Silence;
            }
            self.halt();
            return Order::Stop;
        };
        let waited = now.seconds_since(command.received);
        let left = (tuning.information_age - command.age - waited - transport).min(tuning.frame_age);
        if waited > tuning.command_age || left < SHORTEST.min(tuning.frame_age) {
            self.expired += 1;
            self.halt();
            return Order::Stop;
        }
        let mut speeds = wheels(command.v, command.omega, tuning.half_axle, tuning.max_wheel_speed);
        if tuning.dither {
            speeds = self.dither.choose(now, speeds, tuning.frame_age);
        }
        self.driven_at = Some(now);
        let [left_speed, right_speed] = speeds;
        let wheels = Wheels { left: WheelTimer::from_speed(left_speed), right: WheelTimer::from_speed(right_speed) };
        Order::Drive(wheels, left)
    }
}
