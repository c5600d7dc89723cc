//! Errors over time: each robot's distance to its goal point, and the shape error of the team.

use super::axes::{LEAST_MARGIN, TIME, TimeAxes};
use super::style::{LEGEND, Picture, UNIT, legend, picture};
use trench_bag::run::{Run, Track, distance};

/// Two diagrams, one below the other; dashed lines where the goal points begin and end to move.
pub(super) fn draw(run: &Run, span: (f64, f64)) -> Picture {
    picture((900 * UNIT, 620 * UNIT), |area| {
        let (top, diagrams) = area.split_vertically(LEGEND);
        legend(&top, run.robots.keys(), "- - -  goal points begin and end to move")?;
        let (upper, lower) = diagrams.split_vertically(285 * UNIT);
        let marks = run.motion().map_or(Vec::new(), |(first, last)| vec![first, last]);
        let distances: Vec<_> =
            run.robots.values().enumerate().map(|(index, track)| (Some(index), goal_distance(track, span))).collect();
        let axes = TimeAxes {
            quantity: "distance to goal point (m)",
            span,
            from_zero: true,
            horizontal: None,
            least_margin: LEAST_MARGIN,
        };
        axes.draw(&upper, &distances, &marks)?;
        let times = run.times(span.0, span.1);
        let shape = times.into_iter().filter_map(|time| Some((time, run.shape_error(time)?))).collect();
        let axes = TimeAxes {
            quantity: "shape error (m)",
            span,
            from_zero: true,
            horizontal: Some(TIME),
            least_margin: LEAST_MARGIN,
        };
        axes.draw(&lower, &[(None, shape)], &marks)
    })
}

fn goal_distance(track: &Track, span: (f64, f64)) -> Vec<(f64, f64)> {
    let poses = track.poses.iter().filter(|pose| pose.time >= span.0 && pose.time <= span.1);
    poses.filter_map(|pose| Some((pose.time, distance(pose.position(), track.goal_at(pose.time)?)))).collect()
}
