//! The team at chosen times (Figures 4.36 and 4.42): bodies, goal points and the paths that led there.

use super::field::{View, draw_reference, draw_robot, notes};
use super::style::{LEGEND, Picture, UNIT, centred, colour, legend, line, picture, text};
use super::ticks::short;
use plotters::prelude::*;
use trench_bag::run::{Run, distance};

const COLUMNS: usize = 3;
const WIDTH: u32 = 340 * UNIT;
const TITLE: i32 = 24 * UNIT as i32;

/// Times between which the team goes equally far, so that pictures differ; evenly spaced where nobody moves.
pub(super) fn telling_times(run: &Run, (first, last): (f64, f64), count: u32) -> Vec<f64> {
    let gone = |share: f64| first + (last - first) * share;
    let places = |time: f64| -> Vec<[f64; 2]> {
        run.robots.values().filter_map(|track| Some(track.pose_at(time)?.position())).collect()
    };
    let mut lengths = vec![(first, 0.0)];
    let (mut before, mut length) = (places(first), 0.0);
    for step in 1..=500 {
        let time = gone(f64::from(step) / 500.0);
        let now = places(time);
        length += before.iter().zip(&now).map(|(from, to)| distance(*from, *to)).sum::<f64>();
        lengths.push((time, length));
        before = now;
    }
    let at = |index: u32| {
        let share = f64::from(index) / f64::from(count - 1);
        let reached = lengths.iter().find(|(_, gone)| length > 0.0 && *gone >= share * length * (1.0 - 1e-9));
        reached.map_or(gone(share), |(time, _)| *time)
    };
    (0..count).map(|index| if index + 1 == count { last } else { at(index) }).collect()
}

/// One small field a time, row by row.
pub(super) fn draw(run: &Run, times: &[f64]) -> Picture {
    let view = View::of(run);
    let cell = (WIDTH as i32, view.height(WIDTH) as i32 + TITLE);
    let columns = times.len().clamp(1, COLUMNS);
    let rows = times.len().div_ceil(columns);
    picture((WIDTH * columns as u32, (rows as i32 * cell.1 + LEGEND) as u32), |area| {
        let (top, grid) = area.split_vertically(LEGEND);
        legend(&top, run.robots.keys(), &format!("{},  ● goal point", notes(run)))?;
        let cells = grid.split_evenly((rows, columns));
        for (cell, &time) in cells.iter().zip(times) {
            let (title, field) = cell.split_vertically(TITLE);
            let name = format!("t = {} s", short((time * 10.0).round() / 10.0));
            title.draw(&Text::new(name, (WIDTH as i32 / 2, TITLE * 3 / 5), centred(14))).map_err(text)?;
            let mut chart = view.chart(&field)?;
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
