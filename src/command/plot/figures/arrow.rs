//! Velocities as arrows, all of one figure to one scale.

use super::select::Selection;

/// The longest arrow of a figure, as a part of its width.
const LONGEST: f64 = 0.09;
/// The head of an arrow, as a part of the width of the map, and of the arrow where that is short.
const HEAD: [f64; 2] = [0.012, 0.4];
/// Between the shaft and either side of the head, rad.
const SPREAD: f64 = 0.45;
/// m/s; a robot that is slower has no arrow.
const STANDS: f64 = 1e-3;

/// The time of whose way arrows are as long, s: the fastest robot at these times has the longest, and the number is round.
pub(super) fn seconds(selection: &Selection<'_>, times: &[f64], width: f64) -> f64 {
    let speeds = times
        .iter()
        .flat_map(|&time| selection.robots.iter().filter_map(move |robot| Some(robot.track.pose_at(time)?.v.abs())));
    let fastest = speeds.fold(0.0, f64::max);
    if fastest < STANDS { 1.0 } else { rounded(LONGEST * width / fastest) }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a positive number.
fn rounded(number: f64) -> f64 {
    let power = 10.0_f64.powf(number.log10().floor());
    [5.0, 2.0].into_iter().map(|digit| digit * power).find(|round| *round <= number).unwrap_or(power)
}

/// Shaft and head of the arrow of a robot at `from` (m) with `speed` (m/s) in the direction `theta` (rad), for a map so wide (m).
pub(super) fn arrow(from: (f64, f64), (speed, theta): (f64, f64), seconds: f64, width: f64) -> Vec<Vec<(f64, f64)>> {
    if speed.abs() < STANDS {
        return Vec::new();
    }
    let along =
        |from: (f64, f64), length: f64, angle: f64| (from.0 + length * angle.cos(), from.1 + length * angle.sin());
    let length = speed * seconds;
    let tip = along(from, length, theta);
    let head = (HEAD[0] * width).min(HEAD[1] * length.abs()) * -length.signum();
    vec![vec![from, tip], vec![along(tip, head, theta - SPREAD), tip, along(tip, head, theta + SPREAD)]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(parts: &[Vec<(f64, f64)>]) -> f64 {
        let (from, to) = (parts[0][0], parts[0][1]);
        (to.0 - from.0).hypot(to.1 - from.1)
    }

    #[test]
    fn arrows_are_as_long_as_robots_are_fast() {
        let of = |speed| arrow((1.0, 2.0), (speed, 0.3), 5.0, 100.0);
        assert!((length(&of(0.8)) - 4.0).abs() < 1e-12 && (length(&of(0.2)) - 1.0).abs() < 1e-12);
        assert_eq!(of(0.8)[1][1], of(0.8)[0][1], "the head is at the tip");
        assert!(of(-0.8)[0][1].0 < 1.0, "backwards");
        assert!(of(0.0).is_empty());
    }

    #[test]
    fn scales_are_round() {
        for (number, round) in [(6.3, 5.0), (1.0, 1.0), (0.49, 0.2), (47.0, 20.0), (0.011, 0.01)] {
            assert!((rounded(number) / round - 1.0).abs() < 1e-12, "{number}: {}", rounded(number));
        }
    }
}
