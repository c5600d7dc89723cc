//! M_j = a_j |e_j(0)| + b_j M_{j-1}, (8.26) as corrected, while a chain drives by the queue law: each robot tells its own in its
//! leader state, and the one behind goes on from there.

use crate::dynamic::DynamicSettings;
use crate::inputs::Ahead;
use trench_formation::Vector2;
use trench_formation::agent::{Driven, Surroundings};
use trench_formation::kinematics::PointState;

/// What bounds the error of one robot from now on, as long as nothing but its law acts on it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Recursion {
    /// M_j of the tick before, and the M_{j-1} that it rests on.
    held: Option<(f64, f64)>,
}

impl Recursion {
    /// Something else than the law acted: what was promised before no longer holds.
    pub(crate) fn restart(&mut self) {
        self.held = None;
    }

    /// |e_j| and M_j at a tick under the queue law.
    pub(crate) fn observe(
        &mut self,
        settings: &DynamicSettings,
        around: &Surroundings<'_>,
        robot: PointState,
        leader: Option<Ahead>,
        driven: &Driven,
    ) -> Option<(f64, f64)> {
        let (growth, goal) = (settings.growth?, around.goal?);
        let error = libm::hypot((goal.position - robot.position).norm(), (goal.velocity - robot.velocity).norm());
        let ahead = leader.map_or(0.0, |leader| leader.error_bound);
        let bound = self.follow(growth.overshoot * error, growth.gain, ahead);
        let alone = !driven.pushed && goal.acceleration == Vector2::zeros();
        if !alone {
            self.restart();
        }
        Some((error, bound))
    }

    /// The bound that `own` = a |e_j| and M_{j-1} give now, unless the one before was less and still holds.
    fn follow(&mut self, own: f64, gain: f64, ahead: f64) -> f64 {
        let anew = if ahead > 0.0 { own + gain * ahead } else { own };
        let bound = match self.held {
            Some((bound, before)) if ahead <= before => bound.min(anew),
            _ => anew,
        };
        self.held = Some((bound, ahead));
        bound
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_falls_with_the_errors_and_rises_only_with_the_bound_ahead() {
        let mut recursion = Recursion::default();
        assert_eq!(recursion.follow(1.0, 5.0, 0.5), 3.5);
        assert_eq!(recursion.follow(0.5, 5.0, 0.25), 1.75);
        assert_eq!(recursion.follow(1.5, 5.0, 0.25), 1.75, "the promise of the tick before");
        assert_eq!(recursion.follow(0.5, 5.0, 0.5), 3.0, "the robot ahead promises less than it did");
        recursion.restart();
        assert_eq!(recursion.follow(1.0, 5.0, f64::INFINITY), f64::INFINITY);
        assert_eq!(recursion.follow(1.0, 5.0, 0.0), 1.0, "nobody ahead");
    }
}
