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
    use trench_config::params::{Source, resolve};
    use trench_formation::agent::Agent;
    use trench_formation::curve::{Curve, CurveShape};
    use trench_formation::hull::{Obstacle, Shape, combine};
    use trench_formation::laws::{GoalMotion, RigidMotion};

    /// The queue law with K = (4, 2): from rest |e| grows at first, so that the first bound is the least for a while.
    fn settings() -> DynamicSettings {
        let values = [
            ("law", "queue"),
            ("queue.position_gain", "4.0"),
            ("queue.velocity_gain", "2.0"),
            ("motion.speed", "9.0"),
            ("motion.acceleration", "90.0"),
        ];
        let sources = values.map(|(name, value)| Source::Override { node: None, name, value });
        let parameters = resolve(&sources, "/robot1", "controller", &(crate::description().parameters)()).unwrap();
        DynamicSettings::read(&parameters).unwrap().unwrap()
    }

    /// A robot at the origin, at rest, whose goal point is 1 m ahead of it: per tick the bound, a |e|, and whether obstacles pushed at its
    /// beginning and later. A corner lies `beside` metres off its way, a third of it on.
    fn ticks(beside: f64) -> Vec<(f64, f64, [bool; 2])> {
        let settings = settings();
        let overshoot = settings.growth.unwrap().overshoot;
        let curve =
            Curve::new(&CurveShape::Line(Vector2::new(-9.0, 0.0), Vector2::new(9.0, 0.0)), false, false).unwrap();
        let corners = [[0.35, beside], [0.45, beside + 0.1], [0.25, beside + 0.1]].map(Vector2::from);
        let real = [Obstacle { id: 1, shape: Shape::new(&corners, 0.0).unwrap() }];
        let apparent = combine(&real, 0.1).unwrap();
        let (mut agent, mut recursion) = (Agent::new(settings.agent.clone()), Recursion::default());
        let mut robot = PointState { position: Vector2::zeros(), velocity: Vector2::zeros() };
        let period = 1.0 / 30.0;
        (0..30)
            .map(|tick| {
                let around = Surroundings {
                    time: f64::from(tick) * period,
                    curve: &curve,
                    map_from_segment: nalgebra::Isometry2::identity(),
                    motion: RigidMotion::at_rest(),
                    goal: Some(GoalMotion::at_rest(Vector2::x())),
                    leader: None,
                    ahead: &[],
                    places: &[],
                    behind: 0,
                    real: &real,
                    apparent: &apparent,
                    velocities: &[],
                    clear: 0.0,
                };
                agent.sense(&around).unwrap();
                let driven = agent.drive(&around, robot, period, 1e-3);
                let (error, bound) = recursion.observe(&settings, &around, robot, None, &driven).unwrap();
                robot = driven.end;
                let first = driven.first.forces.obstacles != Vector2::zeros();
                (bound, overshoot * error, [first, driven.pushed])
            })
            .collect()
    }

    #[test]
    fn no_bound_outlasts_a_push_that_sets_in_between_two_ticks() {
        let free = ticks(9.0);
        assert!(free.iter().all(|(bound, _, pushed)| *bound <= free[0].0 && *pushed == [false; 2]), "{free:?}");
        // The cut, 0.26 m from the corner, is crossed in the course of a tick.
        let pushed = ticks(0.2);
        let begins = pushed.iter().position(|(.., pushed)| *pushed == [false, true]).unwrap();
        let ((promised, grown, _), (bound, error, _)) = (pushed[begins], pushed[begins + 1]);
        assert!(promised == free[0].0 && grown > promised, "kept so far: {pushed:?}");
        assert!(bound == error && error > promised, "anew after the push: {pushed:?}");
    }

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
