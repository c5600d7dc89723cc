//! Where the robots went, with their bodies and headings at the snapshots.

use super::field::{View, draw_reference, draw_robot, notes};
use super::style::{LEGEND, Picture, UNIT, colour, legend, line, picture, text};
use plotters::prelude::*;
use trench_bag::run::Run;

const WIDTH: u32 = 900 * UNIT;

/// The whole field.
pub(super) fn draw(run: &Run, span: (f64, f64), times: &[f64]) -> Picture {
    let view = View::of(run);
    picture((WIDTH, view.height(WIDTH) + LEGEND as u32), |area| {
        let (top, field) = area.split_vertically(LEGEND);
        legend(&top, run.robots.keys(), &notes(run))?;
        let mut chart = view.chart(&field)?;
        draw_reference(&mut chart, run)?;
        for (index, track) in run.robots.values().enumerate() {
            let path = track.poses.iter().filter(|pose| pose.time >= span.0).map(|pose| (pose.x, pose.y));
            chart.draw_series(LineSeries::new(path, line(colour(index), 2))).map_err(text)?;
            for pose in times.iter().filter_map(|&time| track.pose_at(time)) {
                draw_robot(&mut chart, &pose, colour(index))?;
            }
        }
        Ok(())
    })
}
