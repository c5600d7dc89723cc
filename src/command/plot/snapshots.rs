//! The team at chosen times (Figures 4.36 and 4.42): bodies, goal points and the paths that led there.

use super::axes::short;
use super::field::{NOTES, View, draw_reference, draw_robot};
use super::style::{LEGEND, Picture, UNIT, centred, colour, legend, line, picture, text};
use plotters::prelude::*;
use trench_bag::run::Run;

const COLUMNS: usize = 3;
const WIDTH: u32 = 340 * UNIT;
const TITLE: i32 = 24 * UNIT as i32;

/// One small field a time, row by row.
pub(super) fn draw(run: &Run, times: &[f64]) -> Picture {
    let view = View::of(run);
    let cell = (WIDTH as i32, view.height(WIDTH, false) as i32 + TITLE);
    let columns = times.len().clamp(1, COLUMNS);
    let rows = times.len().div_ceil(columns);
    picture((WIDTH * columns as u32, (rows as i32 * cell.1 + LEGEND) as u32), |area| {
        let (top, grid) = area.split_vertically(LEGEND);
        legend(&top, run.robots.keys(), &format!("{NOTES},  ● goal point"))?;
        let cells = grid.split_evenly((rows, columns));
        for (cell, &time) in cells.iter().zip(times) {
            let (title, field) = cell.split_vertically(TITLE);
            let name = format!("t = {} s", short((time * 10.0).round() / 10.0));
            title.draw(&Text::new(name, (WIDTH as i32 / 2, TITLE * 3 / 5), centred(14))).map_err(text)?;
            let mut chart = view.chart(&field, false)?;
            draw_reference(&mut chart, run)?;
            for (index, track) in run.robots.values().enumerate() {
                let path = track.poses.iter().filter(|pose| pose.time >= 0.0 && pose.time <= time);
                let points = path.map(|pose| (pose.x, pose.y));
                chart.draw_series(LineSeries::new(points, line(colour(index), 1))).map_err(text)?;
                if let Some([x, y]) = track.goal_at(time) {
                    chart.draw_series([Circle::new((x, y), 3 * UNIT, colour(index).filled())]).map_err(text)?;
                }
                if let Some(pose) = track.pose_at(time) {
                    draw_robot(&mut chart, &pose, colour(index))?;
                }
            }
        }
        Ok(())
    })
}
