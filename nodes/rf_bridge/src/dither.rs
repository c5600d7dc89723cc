//! Wheel speeds below the motors' minimum, by turning part of the time (4.6.3 names the dead zone this removes).
//!
//! A wheel owes the distance between what was wanted and what was sent; a frame turns it or not, whichever brings the
//! debts nearer to zero. Both wheels are decided together, and a debt that turns the robot counts double: the heading is
//! kept first. The debt stays within about half of what a frame at minimum speed moves (0.3 mm at 30 Hz).

use crate::settings::slowest_speed;
use trench_core::Steady;

/// A frame is taken to last this long, s, until two have come.
const NOMINAL_FRAME: f64 = 1.0 / 30.0;

#[derive(Debug, Clone, Copy)]
struct Sent {
    at: Steady,
    wanted: [f64; 2],
    speeds: [f64; 2],
}

/// The debts of one robot's wheels.
#[derive(Debug, Clone, Default)]
pub(crate) struct Dither {
    debt: [f64; 2],
    sent: Option<Sent>,
}

impl Dither {
    /// The speeds to send at `now` so that in the mean the wheels turn at `wanted` (m/s, left and right). `obeyed`: how
    /// long a robot obeys a frame at most, s.
    pub(crate) fn choose(&mut self, now: Steady, wanted: [f64; 2], obeyed: f64) -> [f64; 2] {
        let frame = self.settle(now, wanted, obeyed);
        let [left, right] = [0, 1].map(|wheel| candidates(wanted[wheel], self.debt[wheel], frame));
        let debt_after = |wheel: usize, speed: f64| self.debt[wheel] + (wanted[wheel] - speed) * frame;
        let mut best = (f64::INFINITY, [0.0; 2]);
        for left in left {
            for right in right {
                let (left_debt, right_debt) = (debt_after(0, left), debt_after(1, right));
                let (along, across) = (left_debt + right_debt, 2.0 * (right_debt - left_debt));
                let cost = along * along + across * across;
                if cost < best.0 {
                    best = (cost, [left, right]);
                }
            }
        }
        self.sent = Some(Sent { at: now, wanted, speeds: best.1 });
        best.1
    }

    /// Forgets all debts: the robot was stopped.
    pub(crate) fn reset(&mut self) {
        *self = Self::default();
    }

    /// Books what the last frame did until now; gives how long the next is expected to last.
    fn settle(&mut self, now: Steady, wanted: [f64; 2], obeyed: f64) -> f64 {
        let Some(sent) = self.sent else { return NOMINAL_FRAME };
        let lasted = now.seconds_since(sent.at).min(obeyed);
        for (wheel, debt) in self.debt.iter_mut().enumerate() {
            let (wanted, before) = (wanted[wheel], sent.wanted[wheel]);
            // Speeds that the motor can do leave no debt, and one that changes its direction starts anew.
            let in_reach = wanted == 0.0 || wanted.abs() >= slowest_speed();
            if in_reach || wanted * before <= 0.0 {
                *debt = 0.0;
            } else {
                *debt += (before - sent.speeds[wheel]) * lasted;
            }
        }
        lasted.max(0.005)
    }
}

/// What a wheel could be sent: nothing, or the slowest speed, or what pays the debt at once.
fn candidates(wanted: f64, debt: f64, frame: f64) -> [f64; 2] {
    if wanted == 0.0 || wanted.abs() >= slowest_speed() {
        return [wanted, wanted];
    }
    let paying = wanted + debt / frame;
    [0.0, paying.abs().clamp(slowest_speed(), 2.0 * slowest_speed()).copysign(wanted)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Distances that both wheels went and should have gone, in m, and the largest difference between them on the way.
    fn run(wanted: [f64; 2], frames: u64, period_ms: impl Fn(u64) -> u64) -> ([f64; 2], [f64; 2]) {
        let (mut dither, mut now) = (Dither::default(), 0);
        let (mut difference, mut worst) = ([0.0; 2], [0.0_f64; 2]);
        for frame in 0..frames {
            let speeds = dither.choose(Steady(now * 1_000_000), wanted, 0.08);
            let period = period_ms(frame);
            now += period;
            for wheel in 0..2 {
                assert!(speeds[wheel] == 0.0 || speeds[wheel].abs() >= slowest_speed());
                difference[wheel] += (wanted[wheel] - speeds[wheel]) * period as f64 * 1e-3;
                worst[wheel] = worst[wheel].max(difference[wheel].abs());
            }
        }
        (difference, worst)
    }

    #[test]
    fn equal_wheels_turn_together() {
        let mut dither = Dither::default();
        for frame in 0..200 {
            let [left, right] = dither.choose(Steady(frame * 33_333_333), [0.006, 0.006], 0.08);
            assert_eq!(left, right);
        }
    }

    #[test]
    fn reachable_speeds_and_rest_pass_unchanged() {
        let mut dither = Dither::default();
        for (frame, wanted) in [[0.1, -0.2], [0.01, 0.01], [0.0, 0.0], [0.0, 0.05]].into_iter().enumerate() {
            let speeds = dither.choose(Steady(frame as u64 * 33_000_000), wanted, 0.08);
            if wanted[0] != 0.01 {
                assert_eq!(speeds, wanted);
            }
        }
    }

    proptest! {
        #[test]
        fn the_mean_is_right(left in -0.05..0.05f64, right in -0.05..0.05f64, jitter in 0..8u64) {
            let (_, worst) = run([left, right], 300, |frame| 30 + (frame * 7 + 3) % (jitter + 1));
            // A frame at twice the minimum speed moves 1.2 mm.
            prop_assert!(worst[0] < 0.0013 && worst[1] < 0.0013, "{:?}", worst);
        }
    }
}
