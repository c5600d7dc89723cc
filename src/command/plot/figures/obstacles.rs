//! Obstacles on the map.

use super::super::clip::clip;
use super::super::style::{UNIT, line, text};
use super::map::Chart;
use crate::command::rounded::rounded;
use plotters::prelude::*;
use trench_formation::Vector2;
use trench_formation::hull::{Obstacle, Outline};
use trench_scenario::{Scenario, Task};

const COLOUR: RGBColor = RGBColor(150, 60, 40);

/// How a boundary is drawn.
#[derive(Clone, Copy, PartialEq)]
enum Stroke {
    Bold,
    Thin,
    Dashed,
}

/// What is said of them beside the map; nothing where there are none.
pub(super) fn notes(scenario: &Scenario) -> String {
    let Task::Nearest(chain, _) = &scenario.task else { return String::new() };
    if chain.obstacles.is_empty() {
        return String::new();
    }
    let pole = if chain.potential.pole() > 0.0 { "thin: the pole of their repulsion,  " } else { "" };
    format!("brown: obstacles,  {pole}dashed: where repulsion begins, and combined hulls")
}

/// Draws them where they are at `time` (s), with the pole of their repulsion and where it begins, and combined hulls.
pub(super) fn draw(chart: &mut Chart<'_, '_>, scenario: &Scenario, window: [f64; 4], time: f64) -> Result<(), String> {
    let Task::Nearest(chain, _) = &scenario.task else { return Ok(()) };
    let velocities = chain.options.obstacle_velocities.iter().copied().chain(std::iter::repeat(Vector2::zeros()));
    let moved = |(obstacle, velocity): (&Obstacle, Vector2<f64>)| {
        Ok(Obstacle { id: obstacle.id, shape: obstacle.shape.moved(time * velocity).map_err(text)? })
    };
    let obstacles: Vec<Obstacle> = chain.obstacles.iter().zip(velocities).map(moved).collect::<Result<_, String>>()?;
    let mut outline = |outline: &Outline<'_>, grown: f64, stroke: Stroke| {
        for part in clip(&boundary(outline, grown), window) {
            let drawn = match stroke {
                Stroke::Bold => chart.draw_series(LineSeries::new(part, line(COLOUR, 2))).map(drop),
                Stroke::Thin => chart.draw_series(LineSeries::new(part, line(COLOUR.mix(0.8), 1))).map(drop),
                Stroke::Dashed => {
                    let style = line(COLOUR.mix(0.6), 1);
                    chart.draw_series(DashedLineSeries::new(part, 3 * UNIT, 3 * UNIT, style)).map(drop)
                }
            };
            drawn.map_err(text)?;
        }
        Ok::<_, String>(())
    };
    for obstacle in &obstacles {
        outline(&obstacle.shape.outline(), 0.0, Stroke::Bold)?;
    }
    for apparent in chain.combined(&obstacles).map_err(text)? {
        outline(&apparent.shape.outline(), chain.potential.cut(), Stroke::Dashed)?;
        if chain.potential.pole() > 0.0 {
            outline(&apparent.shape.outline(), chain.potential.pole(), Stroke::Thin)?;
        }
        if apparent.members.len() > 1 {
            outline(&apparent.shape.outline(), 0.0, Stroke::Dashed)?;
        }
    }
    Ok(())
}

/// Points around the obstacles and their repulsive zones at the start.
pub(super) fn extent(scenario: &Scenario) -> Vec<(f64, f64)> {
    let Task::Nearest(chain, _) = &scenario.task else { return Vec::new() };
    let cut = chain.potential.cut();
    chain.obstacles.iter().flat_map(|obstacle| boundary(&obstacle.shape.outline(), cut)).collect()
}

fn boundary(outline: &Outline<'_>, grown: f64) -> Vec<(f64, f64)> {
    rounded(outline.points, outline.radius + grown).into_iter().map(|point| (point.x, point.y)).collect()
}
