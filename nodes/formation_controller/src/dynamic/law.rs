//! Which law steers, by its equation.

use trench_config::{ConfigError, Parameters};
use trench_formation::Vector2;
use trench_formation::agent::Method;
use trench_formation::kinematics::PointState;
use trench_formation::laws::GoalMotion;
use trench_formation::trench::{AnyDamping, AnyTrench, CriticallyDamped, HyperbolicDamping, Quadratic};

/// A law for double integrators, as chosen by the parameter `law`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DynamicLaw {
    /// (5.1): to the goal point, whose velocity and acceleration are fed forward.
    Goal,
    /// (5.2): the same with damping that depends on the distance, critically damped.
    GoalDamped,
    /// (5.3): (5.1) to a goal point that is taken to rest.
    GoalAtRest,
    /// (6.1): across the segment, or in a direction of attraction, in a chain with zones; the chain leader follows (5.1).
    Zoned,
    /// (7.4): to the nearest point of the segment.
    Nearest,
    /// (7.13): the same in a chain with zones; the chain leader is drawn to its goal point.
    Chain,
    /// (8.11) as a double integrator can do it: to the place behind the leader; the chain leader by (8.7) to its goal point.
    Queue,
}

impl DynamicLaw {
    /// The law of this name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "goal" => Self::Goal,
            "goal_damped" => Self::GoalDamped,
            "goal_at_rest" => Self::GoalAtRest,
            "zoned" => Self::Zoned,
            "nearest" => Self::Nearest,
            "chain" => Self::Chain,
            "queue" => Self::Queue,
            _ => return None,
        })
    }

    /// Its number in the thesis.
    pub(crate) fn equation(self) -> &'static str {
        match self {
            Self::Goal => "(5.1)",
            Self::GoalDamped => "(5.2)",
            Self::GoalAtRest => "(5.3)",
            Self::Zoned => "(6.1)",
            Self::Nearest => "(7.4)",
            Self::Chain => "(7.13)",
            Self::Queue => "(8.11)",
        }
    }

    /// Whether zones keep robots in a chain.
    pub(crate) fn is_zoned(self) -> bool {
        matches!(self, Self::Zoned | Self::Chain)
    }

    /// Whether robots follow one another.
    pub(crate) fn is_chained(self) -> bool {
        self.is_zoned() || self == Self::Queue
    }

    /// Whether a robot of this rank needs to hear the robot ahead of it.
    pub(crate) fn follows(self, rank: u32) -> bool {
        self.is_chained() && rank > 1
    }

    /// Whether a robot of this rank is drawn to the segment, not to its goal point.
    pub(crate) fn seeks(self, rank: u32) -> bool {
        self == Self::Nearest || (self.is_zoned() && rank > 1)
    }

    /// The goal point as the law takes it.
    pub(crate) fn goal(self, goal: GoalMotion) -> GoalMotion {
        if self == Self::GoalAtRest { GoalMotion::at_rest(goal.position) } else { goal }
    }

    /// What formation's controllers call it, with what parameters add.
    pub(crate) fn method(self, parameters: &Parameters) -> Result<Method, ConfigError> {
        Ok(match self {
            Self::Goal | Self::GoalAtRest | Self::Queue => Method::Goal(None),
            Self::GoalDamped => Method::Goal(Some(damping(parameters)?)),
            Self::Zoned => Method::Directed {
                direction: direction(parameters)?,
                compensates: parameters.bool("zoned.compensates")?,
            },
            Self::Nearest | Self::Chain => Method::Nearest,
        })
    }

    /// The trench that belongs to the law whatever the parameters name: (5.2)'s follows from its damping, that of (8.11) is the first
    /// element of K.
    pub(crate) fn own_trench(self, parameters: &Parameters) -> Result<Option<AnyTrench>, ConfigError> {
        Ok(match self {
            Self::GoalDamped => {
                Some(AnyTrench::Critical(CriticallyDamped(AnyDamping::Hyperbolic(damping(parameters)?))))
            }
            Self::Queue => Some(AnyTrench::Quadratic(Quadratic { alpha: parameters.f64("queue.position_gain")? })),
            _ => None,
        })
    }

    /// k: for (8.11) the second element of K.
    pub(crate) fn damping(self, parameters: &Parameters) -> Result<f64, ConfigError> {
        parameters.f64(if self == Self::Queue { "queue.velocity_gain" } else { "damping" })
    }

    /// Where (8.11) wants a follower whose leader has its own goal point at `leaders_goal`: at its place behind it.
    pub(crate) fn behind(leader: PointState, leaders_goal: GoalMotion, own_goal: GoalMotion) -> GoalMotion {
        let spacing = leaders_goal.position - own_goal.position;
        GoalMotion { position: leader.position - spacing, velocity: leader.velocity, acceleration: Vector2::zeros() }
    }
}

/// Damping of Example A.9.2: twice `damping` far from the goal.
fn damping(parameters: &Parameters) -> Result<HyperbolicDamping, ConfigError> {
    Ok(HyperbolicDamping { alpha: 2.0 * parameters.f64("damping")?, a: parameters.f64("trench.a")? })
}

fn direction(parameters: &Parameters) -> Result<Option<Vector2<f64>>, ConfigError> {
    let key = "zoned.direction";
    let remedy = "write x and y of a direction in the segment's frame, or [] for across the segment";
    match *parameters.f64_list(key)? {
        [] => Ok(None),
        [x, y] => match Vector2::new(x, y).try_normalize(1e-9) {
            Some(direction) if direction.norm().is_finite() => Ok(Some(direction)),
            _ => Err(parameters.error(key, "is no direction", remedy)),
        },
        _ => Err(parameters.error(key, "is no direction", remedy)),
    }
}
