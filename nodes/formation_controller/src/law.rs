//! The laws a controller can follow, behind one call.

use trench_formation::kinematics::{Polar, Pose, Twist};
use trench_formation::laws::{
    DeadBand, Direct, Family, GoalMotion, Lyapunov, Nominal, PointLaw, Robust, Tracked, Tracking,
};

/// A kinematic law of chapter 4, as chosen by the parameter `law`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// (3.9).
    Direct(Direct),
    /// (3.10).
    Nominal(Nominal),
    /// (3.13).
    Robust(Robust),
    /// (4.4).
    Family(Family),
    /// (3.13) with the goal point's velocity fed forward.
    Tracking(Tracking),
}

impl Law {
    /// Its number in the thesis.
    #[must_use]
    pub fn equation(&self) -> &'static str {
        match self {
            Self::Direct(_) => "(3.9)",
            Self::Nominal(_) => "(3.10)",
            Self::Robust(_) | Self::Tracking(_) => "(3.13)",
            Self::Family(_) => "(4.4)",
        }
    }

    /// The command for a robot at `pose` with its goal at `goal`, both at the moment the command acts. `holding` is what
    /// the last call returned.
    #[must_use]
    pub fn track(&self, dead_band: DeadBand, pose: Pose, goal: GoalMotion, holding: bool) -> Tracked {
        match self {
            Self::Direct(law) => track_point(law, dead_band, pose, goal, holding),
            Self::Nominal(law) => track_point(law, dead_band, pose, goal, holding),
            Self::Robust(law) => track_point(law, dead_band, pose, goal, holding),
            Self::Family(law) => track_point(law, dead_band, pose, goal, holding),
            Self::Tracking(law) => law.track(pose, goal, holding),
        }
    }
}

/// A law for resting goal points, applied to where the goal is now: what the thesis does with moving ones.
fn track_point(law: &impl PointLaw, dead_band: DeadBand, pose: Pose, goal: GoalMotion, holding: bool) -> Tracked {
    let polar = Polar::of(pose, goal.position);
    let holding = dead_band.holds(polar.distance, holding);
    let twist = if holding { Twist::ZERO } else { law.twist(polar) };
    Tracked {
        twist,
        distance: polar.distance,
        misalignment: polar.misalignment,
        lyapunov: Lyapunov::of(polar, twist),
        holding,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_formation::Vector2;

    #[test]
    fn every_law_drives_a_facing_robot_ahead_and_rests_in_the_dead_band() {
        let dead_band = DeadBand { hold: 0.01, resume: 0.02 };
        let robust = Robust { k1: 0.5, k2: 1.0, k3: 0.6 };
        let laws = [
            Law::Direct(Direct { k1: 0.5, k2: 1.0 }),
            Law::Nominal(Nominal { k1: 0.5, k2: 1.0 }),
            Law::Robust(robust),
            Law::Family(Family { k1: 0.5, k2: 1.0, n: 0, p: 1, q: 0, s: 0 }),
            Law::Tracking(Tracking { gains: robust, dead_band }),
        ];
        for law in laws {
            let goal = GoalMotion::at_rest(Vector2::new(1.0, 0.0));
            let far = law.track(dead_band, Pose::new(0.0, 0.0, 0.0), goal, false);
            assert!((far.twist.v - 0.5).abs() < 1e-12 && far.twist.omega.abs() < 1e-12, "{law:?} {far:?}");
            assert!(far.lyapunov.rate < 0.0, "{law:?}");
            let near = law.track(dead_band, Pose::new(0.995, 0.0, 2.0), goal, false);
            assert!(near.holding && near.twist == Twist::ZERO, "{law:?} {near:?}");
        }
    }
}
