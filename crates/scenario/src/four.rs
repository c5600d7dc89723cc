//! What is kept of robots side by side from step to step.

use crate::course::{ALL, Courses, LANES, greater, less};
use crate::robots::Seen;
use crate::room::Rooms;
use crate::summary::LyapunovSummary;
use trench_formation::zoning::Radii;
use wide::f64x4;

/// Four robots of a team, or the last fewer. What changes seldom is beside: what every step needs of thousands is read in one go.
#[derive(Debug, Clone)]
pub(crate) struct Four {
    pub(crate) rooms: Rooms,
    courses: Courses,
    /// Least and greatest distance from the leader, m.
    leader_range: [f64x4; 2],
    /// Who follows a leader: the robot before it.
    led: u8,
    /// Who is away from what draws it, and whom something draws, now.
    away: u8,
    drawn: u8,
}

/// When a robot was last away from what draws it, and when something last drew it, before what it is now; s; negative: never.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Times {
    away: f64,
    drawn: f64,
}

/// What is the same for all robots of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Now {
    /// s.
    pub(crate) time: f64,
    /// When robots were looked at before, s.
    pub(crate) before: f64,
    /// s.
    pub(crate) step: f64,
    /// Within which robots conform, m.
    pub(crate) tolerance: f64,
    /// The neutral zone, m; all distances where there are no zones.
    pub(crate) neutral: [f64; 2],
}

/// Which of them are to be cared for: bits by lane.
pub(crate) struct Told {
    /// Who is not in the room that it had, and has to be looked at.
    pub(crate) astray: u32,
    /// Whether a leader is outside its follower's neutral zone.
    pub(crate) outside: bool,
}

impl Four {
    /// `led` has a bit for each that has a leader.
    pub(crate) fn new(led: u8) -> Self {
        let range = [f64x4::splat(f64::INFINITY), f64x4::splat(0.0)];
        Self { rooms: Rooms::none(), courses: Courses::new(), leader_range: range, led, away: 0, drawn: 0 }
    }

    /// Looks at them; `leader` is where the one before the first of them is, m.
    #[inline(always)]
    pub(crate) fn look(&mut self, seen: &Seen, leader: [f64; 2], now: &Now, times: &mut [Times]) -> Told {
        self.courses.take(seen.lyapunov, now.step);
        // What is no number is away, and drawn nowhere.
        let away = !seen.deviation.simd_le(f64x4::splat(now.tolerance)).to_bitmask() as u8 & ALL;
        let drawn = seen.deviation.abs().simd_lt(f64x4::splat(f64::INFINITY)).to_bitmask() as u8;
        if (away, drawn) != (self.away, self.drawn) {
            for (lane, times) in times.iter_mut().enumerate() {
                let ends = |before: u8, now: u8| before & !now & (1 << lane) != 0;
                times.away = if ends(self.away, away) { now.before } else { times.away };
                times.drawn = if ends(self.drawn, drawn) { now.before } else { times.drawn };
            }
            (self.away, self.drawn) = (away, drawn);
        }
        let after = |first: f64, of: &[f64; LANES]| f64x4::new([first, of[0], of[1], of[2]]);
        let ahead = (after(leader[0], seen.x.as_array()), after(leader[1], seen.y.as_array()));
        let (x, y) = (ahead.0 - seen.x, ahead.1 - seen.y);
        let distance = (x * x + y * y).sqrt();
        let [least, greatest] = self.leader_range;
        if (distance.simd_lt(least) | distance.simd_gt(greatest)).any() {
            self.leader_range = [less(distance, least), greater(distance, greatest)];
        }
        let [from, to] = now.neutral.map(f64x4::splat);
        let inside = (distance.simd_ge(from) & distance.simd_le(to)).to_bitmask() as u8;
        Told { astray: self.rooms.left(seen.x, seen.y), outside: self.led & !inside != 0 }
    }

    /// From now on V of the robot in a lane is another function.
    pub(crate) fn begin_anew(&mut self, lane: usize) {
        self.courses.begin_anew(lane);
    }

    /// See [`Courses::summary`].
    pub(crate) fn lyapunov(&self, lane: usize, last: f64, step: f64) -> LyapunovSummary {
        self.courses.summary(lane, last, step)
    }

    /// Least and greatest distance from its leader of the robot in a lane, m.
    pub(crate) fn leader_range(&self, lane: usize) -> [f64; 2] {
        self.leader_range.map(|range| range.as_array()[lane])
    }

    /// When the robot in a lane was last away from what draws it, and when something last drew it, at `time` (s); s; negative: never.
    pub(crate) fn last(&self, lane: usize, times: Times, time: f64) -> [f64; 2] {
        [(self.away, times.away), (self.drawn, times.drawn)]
            .map(|(still, last)| if still & (1 << lane) != 0 { time } else { last })
    }
}

impl Times {
    pub(crate) fn never() -> Self {
        Self { away: -1.0, drawn: -1.0 }
    }
}

impl Now {
    /// The neutral zone of radii, for [`Self::neutral`].
    pub(crate) fn neutral(radii: Option<&Radii>) -> [f64; 2] {
        radii.map_or([f64::NEG_INFINITY, f64::INFINITY], |radii| [radii.rho_hat, radii.rho])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::course::Moments;

    #[test]
    fn each_is_told_when_it_was_last_away_and_drawn_and_how_far_from_its_leader() {
        let (mut four, mut times) = (Four::new(0b1110), [Times::never(); LANES]);
        let lyapunov = Moments { values: [f64x4::splat(0.0); 3], told: 0, drawn: 0 };
        let mut look = |time: f64, x: [f64; 4], deviation: [f64; 4]| {
            let (x, y, deviation) = (f64x4::new(x), f64x4::splat(0.0), f64x4::new(deviation));
            let now = Now { time, before: time - 1.0, step: 1.0, tolerance: 0.1, neutral: [0.5, 2.0] };
            four.look(&Seen { x, y, deviation, lyapunov }, [9.0; 2], &now, &mut times).outside
        };
        assert!(!look(0.0, [9.0, 8.0, 7.0, 6.0], [0.0, 1.0, 1.0, f64::INFINITY]));
        assert!(look(1.0, [9.0, 8.0, 5.5, 4.5], [0.0, 1.0, 0.0, f64::INFINITY]));
        assert!(!look(2.0, [9.0, 7.0, 5.0, 4.5], [0.0, 0.1, f64::NAN, f64::INFINITY]));
        let last = [0, 1, 2, 3].map(|lane| four.last(lane, times[lane], 2.0));
        assert_eq!(last, [[-1.0, 2.0], [1.0, 2.0], [2.0, 1.0], [2.0, -1.0]]);
        let ranges = [1, 2, 3].map(|lane| four.leader_range(lane));
        assert_eq!(ranges, [[1.0, 2.0], [1.0, 2.5], [0.5, 1.0]]);
    }
}
