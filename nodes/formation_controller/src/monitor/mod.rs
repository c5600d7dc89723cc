//! The run-time monitor: whether the stability argument of the law in force holds while the robot drives.

mod conditions;
mod energy;
mod kinematic;
mod news;
mod recursion;

pub(crate) use conditions::Violation;
pub(crate) use energy::Driving;
pub(crate) use kinematic::{Expected, watched};
pub(crate) use news::News;
pub(crate) use recursion::Recursion;

use crate::dynamic::DynamicLaw;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_formation::Vector2;
use trench_formation::agent::RemedyState;
use trench_formation::stability::{Balance, Balanced, Moment, Supply};

/// How far measurements and motors may be off before it counts against the law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MonitorSettings {
    window: f64,
    patience: f64,
    /// m, of a pose.
    pose_error: f64,
    /// m/s, by which a robot may miss its command.
    speed_error: f64,
}

/// A pose's heading may be off by this (rad), and its rate (rad/s).
const HEADING_ERROR: (f64, f64) = (0.03, 0.4);

pub(crate) fn descriptors() -> Vec<ParameterDescriptor> {
    use ParameterDescriptor as P;
    vec![
        P::double("monitor.window", 0.6, "s, over which the Lyapunov function is watched").range(0.1, 60.0),
        P::double("monitor.patience", 0.1, "s, beyond its bound before that counts as a violation").range(0.0, 60.0),
        P::double("monitor.pose_error", 0.008, "m, by which a pose may be off").range(0.0, 10.0),
        P::double("monitor.speed_error", 0.04, "m/s, by which a robot may miss its command").range(0.0, 10.0),
    ]
}

impl MonitorSettings {
    pub(crate) fn read(parameters: &Parameters) -> Result<Self, ConfigError> {
        let double = |name: &str| parameters.f64(name);
        Ok(Self {
            window: double("monitor.window")?,
            patience: double("monitor.patience")?,
            pose_error: double("monitor.pose_error")?,
            speed_error: double("monitor.speed_error")?,
        })
    }
}

/// Which function V is: another one begins anew.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Function {
    /// None for the laws of chapter 4.
    pub(crate) law: Option<DynamicLaw>,
    pub(crate) epoch: u64,
    /// Whether a point draws the robot.
    pub(crate) draws: bool,
    pub(crate) remedy: RemedyState,
    /// Phase of the goal, and whether the robot rests in its dead band.
    pub(crate) goal: (u8, bool),
}

/// V at a tick, and all that its proof looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Watched {
    pub(crate) function: Function,
    pub(crate) value: f64,
    /// dV/dt as the law's proof has it.
    pub(crate) rate: f64,
    /// dV/dp, p the point that is steered, and dV/dtheta.
    pub(crate) gradient: (Vector2<f64>, f64),
    /// What came otherwise than was expected at the tick before.
    pub(crate) news: Supply,
    /// What the inputs bring in up to the next tick.
    pub(crate) supply: Supply,
    /// What a law of chapter 4 expects the robot to do; of a dynamic law the next tick tells ([`News`]).
    pub(crate) expected: Option<Expected>,
}

/// What the monitor remembers.
#[derive(Debug, Clone)]
pub(crate) struct Monitor {
    settings: MonitorSettings,
    balance: Balance,
    function: Option<Function>,
    pending: Supply,
}

impl Monitor {
    pub(crate) fn new(settings: MonitorSettings) -> Self {
        let balance = Balance::new(settings.window, settings.patience);
        Self { settings, balance, function: None, pending: Supply::default() }
    }

    /// The robot rests whatever its law says, or the law is another one.
    pub(crate) fn restart(&mut self) {
        self.balance.restart();
        self.function = None;
        self.pending = Supply::default();
    }

    /// Judges a tick at `time` (s); `filtered` is what limits and the safety filter do up to the next one.
    pub(crate) fn observe(&mut self, time: f64, watched: &Watched, filtered: Supply) -> Balanced {
        let anew = self.function != Some(watched.function);
        // What a remedy does to V has no bound: it is there to lead out of a minimum.
        if anew || watched.function.remedy != RemedyState::None {
            self.restart();
        }
        self.function = Some(watched.function);
        let (along, turning) = (watched.gradient.0.norm(), watched.gradient.1.abs());
        let MonitorSettings { pose_error, speed_error, .. } = self.settings;
        let balanced = self.balance.observe(Moment {
            time,
            value: watched.value,
            supply: self.pending.with(&watched.news),
            uncertainty: along * pose_error + turning * HEADING_ERROR.0,
            drift: along * speed_error + turning * HEADING_ERROR.1,
        });
        self.pending = watched.supply.with(&filtered);
        balanced
    }
}
