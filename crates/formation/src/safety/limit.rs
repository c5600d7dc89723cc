//! The rule: closing speed v satisfies v T + v^2/(2 a) <= gap/2, for a robot that may turn while it moves.
//!
//! A robot that stops by braking both wheels at a goes on for v^2/(2a) + (l omega)^2/(2a) while |l omega| <= |v| (both
//! wheels roll one way; l is half the axle), for |v| l |omega|/a otherwise. Both are at most v^2/(2a) + |v| l |omega|/a,
//! which is what is used: the second term acts as an additional delay of l |omega|/a. The travel is along headings
//! swept by the turn, so its closing part is at most the travel times the greatest cosine of the sweep.
use super::SafetyParameters;
use super::scene::{Barrier, Constraint, Scene};
use crate::kinematics::{Pose, Twist};
use nalgebra::Vector2;

/// Largest part of the twist's speed that every barrier admits, at an unchanged turn rate, and the barrier that decided.
pub(super) fn limit(
    parameters: &SafetyParameters,
    scene: &Scene<'_>,
    pose: Pose,
    now: Twist,
    wish: Twist,
) -> (Twist, Option<Constraint>) {
    let stopping_time = parameters.loop_delay() + now.v.abs().max(wish.v.abs()) / parameters.braking;
    let sweep = Sweep::of(parameters, pose, now, wish);
    let (mut speed, mut decisive) = (wish.v.abs(), None);
    let (mut coasting, mut braking_for) = (now.v.abs(), None);
    for barrier in scene.barriers(pose.position(), parameters, stopping_time) {
        let admitted = admitted_speed(parameters, &barrier, &sweep, now, wish);
        if admitted < speed {
            (speed, decisive) = (admitted, Some(barrier.constraint));
        }
        let admitted = admitted_speed(parameters, &barrier, &sweep, now, Twist { v: now.v, ..wish });
        if admitted < coasting {
            (coasting, braking_for) = (admitted, Some(barrier.constraint));
        }
    }
    let v = if decisive.is_some() { speed.copysign(wish.v) } else { wish.v };
    let omega = if braking_for.is_some() { braking_turn_rate(parameters, coasting, now, wish) } else { wish.omega };
    let changed = v != wish.v || omega != wish.omega;
    (Twist { v, omega }, decisive.or(braking_for).filter(|_| changed))
}

/// Turn rate nearest to the wish that leaves the wheels' deceleration to braking down to speed `target`: a wheel that
/// speeds up for a turn does not brake.
fn braking_turn_rate(parameters: &SafetyParameters, target: f64, now: Twist, wish: Twist) -> f64 {
    let spare = parameters.braking * parameters.loop_delay() - (now.v.abs() - target);
    let change = spare.max(0.0) / parameters.half_axle;
    wish.omega.clamp(now.omega - change, now.omega + change)
}

fn admitted_speed(parameters: &SafetyParameters, barrier: &Barrier, sweep: &Sweep, now: Twist, wish: Twist) -> f64 {
    let closing = sweep.most_cosine(barrier.towards * wish.v.signum());
    if closing <= 0.0 {
        return f64::INFINITY;
    }
    let turning = parameters.half_axle * wish.omega.abs() / parameters.braking;
    let by_rule = speed_for(barrier.budget / closing, parameters.loop_delay() + turning, parameters.braking);
    // What earlier commands still do before this one acts is known: the present speed for the time of the delay.
    let committed = sweep.most_cosine(barrier.towards * now.v.signum()).max(0.0) * now.v.abs() * parameters.delay;
    let left = (barrier.budget - committed) / closing;
    by_rule.min(speed_for(left, parameters.period + turning, parameters.braking))
}

/// Largest v with v `time` + v^2/(2 `braking`) <= `travel`; 0 if there is none.
fn speed_for(travel: f64, time: f64, braking: f64) -> f64 {
    if travel <= 0.0 {
        return 0.0;
    }
    let delayed = braking * time;
    // The root in the form that does not cancel.
    2.0 * braking * travel / (delayed + (delayed * delayed + 2.0 * braking * travel).sqrt())
}

/// Headings that a robot may take until it has stopped.
struct Sweep {
    middle: Vector2<f64>,
    cosine: f64,
    sine: f64,
}

impl Sweep {
    fn of(parameters: &SafetyParameters, pose: Pose, now: Twist, wish: Twist) -> Self {
        let committed = now.omega * parameters.delay;
        let after = |twist: Twist| {
            let turn = twist.omega.abs() * parameters.period + braking_turn(parameters, twist);
            committed + turn.copysign(twist.omega)
        };
        let (present, commanded) = (after(now), after(wish));
        let low = commanded.min(present).min(committed).min(0.0);
        let high = commanded.max(present).max(committed).max(0.0);
        let half = (0.5 * (high - low)).min(core::f64::consts::PI);
        let (sine, cosine) = libm::sincos(half);
        let (middle_sine, middle_cosine) = libm::sincos(pose.theta + 0.5 * (low + high));
        Self { middle: Vector2::new(middle_cosine, middle_sine), cosine, sine }
    }

    /// Greatest cosine of the angle between a swept heading and `direction`.
    fn most_cosine(&self, direction: Vector2<f64>) -> f64 {
        let cosine = self.middle.dot(&direction);
        if cosine >= self.cosine {
            return 1.0;
        }
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        cosine * self.cosine + sine * self.sine
    }
}

/// Angle by which the heading goes on while both wheels brake: |v| |omega|/a while both roll one way, else
/// (v^2 + l^2 omega^2)/(2 a l).
fn braking_turn(parameters: &SafetyParameters, twist: Twist) -> f64 {
    let rolling = parameters.half_axle * twist.omega.abs();
    if rolling <= twist.v.abs() {
        twist.v.abs() * twist.omega.abs() / parameters.braking
    } else {
        (twist.v * twist.v + rolling * rolling) / (2.0 * parameters.braking * parameters.half_axle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_met_with_equality() {
        for (travel, time, braking) in [(0.1, 0.1, 0.5), (1e-9, 0.2, 0.3), (3.0, 0.05, 1.0)] {
            let v = speed_for(travel, time, braking);
            assert!((v * time + v * v / (2.0 * braking) - travel).abs() < 1e-12 * travel);
        }
        assert_eq!(speed_for(-1.0, 0.1, 0.5), 0.0);
    }

    #[test]
    fn the_sweep_finds_the_worst_heading() {
        let sweep = |half: f64| {
            let (sine, cosine) = libm::sincos(half);
            Sweep { middle: Vector2::x(), cosine, sine }
        };
        let at = |angle: f64| Vector2::new(angle.cos(), angle.sin());
        assert_eq!(sweep(0.5).most_cosine(at(0.4)), 1.0);
        assert!((sweep(0.5).most_cosine(at(-1.2)) - 0.7_f64.cos()).abs() < 1e-12);
        assert!((sweep(0.0).most_cosine(at(2.0)) - 2.0_f64.cos()).abs() < 1e-12);
        assert_eq!(sweep(core::f64::consts::PI).most_cosine(at(3.0)), 1.0);
    }
}
