//! How far robots chatter about a trench with a kink at its bottom, where its pull turns round at once.
//!
//! What a step makes of it (h its length, P = Phi'(0+), v the speed at the bottom): in the step that crosses the bottom the pull has the wrong sign
//! for a part of the step, and gives the robot up to c h P v of energy: c = 1 under semi-implicit Euler, 2 where the acceleration is held, 2/3 under
//! Runge-Kutta, whose stages lie on both sides. On its way out to A and back damping takes 2 int_0^A k(x) sqrt(2 (Phi(A) - Phi(x))) dx, which
//! is (2/3) k v^3/P of a cone. Both are the same at A = 3 c h P/(4 k): farther out robots come nearer, within they may stay, locked to the steps. One
//! step's own way, h^2 P, is beside that, and h^2 P/(2 - h k) under semi-implicit Euler, whose robots go to and fro from step to step.

use trench_formation::laws::Capability;
use trench_formation::simulate::Integration;
use trench_formation::trench::Trench;

/// Parts of the way out at which damping is summed, and halvings by which the way is found.
const PARTS: u32 = 64;
const HALVINGS: u32 = 60;

/// A trench with a kink, and what brakes robots in it.
pub(crate) struct Kinked<'a> {
    trench: &'a dyn Trench,
    /// k, 1/s, of the distance (m).
    damping: &'a dyn Fn(f64) -> f64,
    /// Pull beside the bottom, m/s^2.
    pub(crate) pull: f64,
    /// Of Phi, by which it pulls: 1, or more along a direction, or less within limits.
    factor: f64,
    /// Of damping, what takes energy out.
    share: f64,
}

impl<'a> Kinked<'a> {
    /// A trench that pulls across the sine of an angle; none where it has no kink.
    ///
    /// Within limits damping gives way first: on the way out, where it adds to the pull, there may be nothing left of it.
    pub(crate) fn new(
        trench: &'a dyn Trench,
        damping: &'a dyn Fn(f64) -> f64,
        sine: f64,
        limits: Option<&Capability>,
    ) -> Option<Self> {
        let bottom = trench.slopes(0.0);
        let full = bottom.right.max(-bottom.left) / sine;
        let pull = limits.map_or(full, |limits| full.min(limits.acceleration));
        let share = if limits.is_some() { 0.5 } else { 1.0 };
        (bottom.left != bottom.right).then_some(Self { trench, damping, pull, factor: pull / (full * sine), share })
    }

    /// What robots may stay away from the bottom in steps of `step` (s), m.
    pub(crate) fn amplitude(&self, step: f64, method: Integration) -> f64 {
        let gain = step
            * self.pull
            * match method {
                Integration::SemiImplicitEuler => 1.0,
                Integration::Exact => 2.0,
                Integration::RungeKutta => 2.0 / 3.0,
            };
        let (mut within, mut beyond) = (0.0, crate::scenario::RANGE);
        if self.taken(beyond) < gain {
            return f64::INFINITY;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (within + beyond);
            if self.taken(middle) < gain { within = middle } else { beyond = middle }
        }
        let one_step = step * step * self.pull;
        beyond
            + match method {
                Integration::SemiImplicitEuler => {
                    one_step / (2.0 - step * (self.damping)(beyond)).max(f64::MIN_POSITIVE)
                }
                Integration::Exact | Integration::RungeKutta => one_step,
            }
    }

    /// What damping takes on the way out to a distance (m) and back, over the speed at the bottom: m/s.
    fn taken(&self, out: f64) -> f64 {
        let potential = |x: f64| self.factor * (self.trench.value(x) - self.trench.value(0.0));
        let whole = potential(out);
        let part = |index: u32| {
            let x = out * (f64::from(index) + 0.5) / f64::from(PARTS);
            self.share * (self.damping)(x) * libm::sqrt((1.0 - potential(x) / whole).max(0.0))
        };
        2.0 * out / f64::from(PARTS) * (0..PARTS).map(part).sum::<f64>()
    }

    /// The longest step (s) with which robots stay within a distance (m), where a step is too long.
    pub(crate) fn step_within(&self, distance: f64, (too_long, method): (f64, Integration)) -> f64 {
        let (mut short, mut long) = (0.0, too_long);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (short + long);
            if self.amplitude(middle, method) <= distance { short = middle } else { long = middle }
        }
        short
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_formation::Vector2;
    use trench_formation::kinematics::PointState;
    use trench_formation::laws::{GoalMotion, GoalTracking};
    use trench_formation::simulate::GoalTeam;
    use trench_formation::trench::{Conic, ConstantDamping, Damping, HyperbolicDamping, SlopeTable};

    const METHODS: [Integration; 3] = [Integration::SemiImplicitEuler, Integration::Exact, Integration::RungeKutta];

    /// How far robots from 150 starts on a line, up to twice as far as they should end, and as fast, are from the bottom for good.
    fn simulated<T: Trench + Clone, D: Damping + Clone>(
        law: &GoalTracking<T, D>,
        expected: f64,
        run: (f64, Integration),
    ) -> f64 {
        let (step, method) = run;
        let pull = law.trench.slopes(0.0).right;
        let start = |index: u32| {
            // Spread over the rectangle of positions and speeds by the golden ratio.
            let (row, column) = (f64::from(index) / 150.0, (0.618_033_988_75 * f64::from(index)).fract());
            let (x, v) =
                (2.0 * expected * (2.0 * row - 1.0), 2.0 * (2.0 * pull * expected).sqrt() * (2.0 * column - 1.0));
            PointState { position: Vector2::new(x, 0.0), velocity: Vector2::new(v, 0.0) }
        };
        let mut team = GoalTeam::new((0..150).map(start).collect(), method, step);
        let resting =
            GoalMotion { position: Vector2::zeros(), velocity: Vector2::zeros(), acceleration: Vector2::zeros() };
        let mut farthest = 0.0_f64;
        for index in 0..4500 {
            team.step(|_, _| resting, |robot, goal| law.steer(robot, goal));
            if index > 4000 {
                farthest = team.robots().iter().map(|robot| robot.position.norm()).fold(farthest, f64::max);
            }
        }
        farthest
    }

    fn check<T: Trench + Clone, D: Damping + Clone>(law: GoalTracking<T, D>, run: (f64, Integration), least: f64) {
        let damping = |x: f64| law.damping.coefficient(x);
        let expected = Kinked::new(&law.trench, &damping, 1.0, None).unwrap().amplitude(run.0, run.1);
        let found = simulated(&law, expected, run);
        assert!(found <= expected && found >= least * expected, "{run:?}: {found} of {expected}");
    }

    #[test]
    fn robots_chatter_as_far_as_is_said() {
        for method in METHODS {
            for (step, damping) in [(0.01, 2.0), (0.01, 10.0), (0.1, 5.0), (0.1, 10.0), (0.1, 16.0)] {
                let law =
                    || GoalTracking { trench: Conic { alpha: 8.0 }, damping: ConstantDamping { coefficient: damping } };
                // Slow robots lock to steps up to where nothing is left for them; faster damping leaves a step's own way.
                let least = if step * damping < 0.3 { 0.3 } else { 0.15 };
                check(law(), (step, method), least);
            }
            // No damping at the bottom; a slope that rises beside its kink.
            let fading = HyperbolicDamping { alpha: 5.0, a: 0.3 };
            check(GoalTracking { trench: Conic { alpha: 8.0 }, damping: fading }, (0.02, method), 0.3);
            let rising = SlopeTable::new(vec![(0.0, 1.0), (0.5, 4.0), (2.0, 5.0)]).unwrap();
            check(GoalTracking { trench: rising, damping: ConstantDamping { coefficient: 3.0 } }, (0.02, method), 0.2);
        }
    }

    /// 3 h P/(4 k) + h^2 P/(2 - h k).
    #[test]
    fn of_a_cone() {
        let damping = |_: f64| 5.0;
        let cone = Kinked::new(&Conic { alpha: 8.0 }, &damping, 1.0, None).unwrap();
        let amplitude = cone.amplitude(0.1, Integration::SemiImplicitEuler);
        assert!((amplitude - 0.12 - 0.08 / 1.5).abs() < 1e-4, "{amplitude}");
        let step = cone.step_within(0.05, (0.1, Integration::SemiImplicitEuler));
        assert!((cone.amplitude(step, Integration::SemiImplicitEuler) - 0.05).abs() < 1e-9, "{step}");
        // Limits that leave nothing of damping on the way out.
        let limits = Capability { speed: 1.0, acceleration: 8.0 };
        let bounded = Kinked::new(&Conic { alpha: 8.0 }, &damping, 1.0, Some(&limits)).unwrap();
        assert!((bounded.amplitude(0.1, Integration::SemiImplicitEuler) - 0.24 - 0.08 / 1.5).abs() < 1e-4);
        assert!(
            Kinked::new(&trench_formation::trench::Hyperbolic { alpha: 8.0, a: 0.1 }, &damping, 1.0, None).is_none()
        );
    }
}
