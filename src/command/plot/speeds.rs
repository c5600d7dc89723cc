//! Forward speed, turning speed and heading of each robot over time (Figures 4.32 to 4.35).

use super::axes::{LEAST_MARGIN, TIME, TimeAxes};
use super::style::{LEGEND, Picture, UNIT, legend, picture};
use trench_bag::run::{Pose, Run};

/// Three diagrams, one below the other.
pub(super) fn draw(run: &Run, span: (f64, f64)) -> Picture {
    picture((900 * UNIT, 780 * UNIT), |area| {
        let (top, diagrams) = area.split_vertically(LEGEND);
        legend(&top, run.robots.keys(), "")?;
        let (upper, rest) = diagrams.split_vertically(243 * UNIT);
        let (middle, lower) = rest.split_vertically(243 * UNIT);
        let axes =
            |quantity, horizontal| TimeAxes { quantity, span, from_zero: true, horizontal, least_margin: LEAST_MARGIN };
        axes("forward speed (m/s)", None).draw(&upper, &curves(run, span, |pose| pose.v), &[])?;
        axes("turning speed (rad/s)", None).draw(&middle, &curves(run, span, |pose| pose.omega), &[])?;
        axes("heading (rad)", Some(TIME)).draw(&lower, &headings(run, span), &[])
    })
}

fn curves(run: &Run, span: (f64, f64), value: impl Fn(&Pose) -> f64) -> Vec<super::axes::Curve> {
    let points = |poses: &[Pose]| {
        poses.iter().filter(|pose| pose.time >= span.0 && pose.time <= span.1).map(|p| (p.time, value(p))).collect()
    };
    run.robots.values().enumerate().map(|(index, track)| (Some(index), points(&track.poses))).collect()
}

/// Headings without the jump at a half turn.
fn headings(run: &Run, span: (f64, f64)) -> Vec<super::axes::Curve> {
    let mut curves = curves(run, span, |pose| pose.theta);
    for (_, points) in &mut curves {
        let mut last = None;
        for (_, heading) in points {
            if let Some(last) = last {
                let turns: f64 = (*heading - last) / std::f64::consts::TAU;
                *heading -= turns.round() * std::f64::consts::TAU;
            }
            last = Some(*heading);
        }
    }
    curves
}
