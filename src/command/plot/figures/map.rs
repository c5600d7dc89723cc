//! The field with segment, obstacles, paths and robots.

use super::super::clip::clip;
use super::super::extensions::draw_extensions;
use super::super::style::{Area, FAINT, REFERENCE, UNIT, font, line, text};
use super::super::ticks::Ticks;
use super::arrow::arrow;
use super::obstacles;
use super::select::{Selection, Shown};
use plotters::chart::ChartContext;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use trench_formation::Vector2;
use trench_formation::curve::Curve;
use trench_scenario::{Scenario, Task};

/// A chart in the map, m.
pub(super) type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Room for the numbers and names of the axes, units.
const LABELS: [u32; 2] = [58 * UNIT, 42 * UNIT];
const MARGIN: u32 = 12 * UNIT;
/// The last number of the horizontal axis is half beside it.
const RIGHT: u32 = 24 * UNIT;
/// Marks of an axis, at most.
const MARKS: usize = 9;
/// The square at the end of a path, about it, and a robot's name, from it, units.
const END: [(i32, i32); 2] = [(-3 * UNIT as i32, -3 * UNIT as i32), (3 * UNIT as i32, 3 * UNIT as i32)];
const NAME: (i32, i32) = (3 * UNIT as i32, -14 * UNIT as i32);

/// The part of the map that is shown.
#[derive(Clone, Copy)]
pub(super) struct Field([f64; 4]);

impl Field {
    /// A window, or all that a selection does until `until` (s), with segment, goal and obstacles.
    pub(super) fn of(window: Option<[f64; 4]>, scenario: &Scenario, selection: &Selection<'_>, until: f64) -> Self {
        if let Some(window) = window {
            return Self(window);
        }
        let paths =
            selection.robots.iter().flat_map(|robot| path(robot, 0.0, until).into_iter().chain(goals(robot, until)));
        let mut points: Vec<(f64, f64)> = paths.collect();
        points.extend(team_goal(scenario));
        let is_chain = scenario.zoning().is_some() || matches!(scenario.task, Task::Queue(_));
        if is_chain && selection.robots.len() > 1 {
            points.extend(segment(scenario));
        }
        points.extend(obstacles::extent(scenario));
        let bounds = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)))
        };
        let (left, right) = bounds(&mut points.iter().map(|point| point.0));
        let (bottom, top) = bounds(&mut points.iter().map(|point| point.1));
        if left > right {
            return Self([0.0, 1.0, 0.0, 1.0]);
        }
        let size = (right - left).max(top - bottom).max(1e-3);
        // Neither a stripe nor a tower.
        let grow = |low: f64, high: f64, least: f64| {
            let more = (0.5 * (least - (high - low))).max(0.0) + 0.04 * size;
            (low - more, high + more)
        };
        let ((left, right), (bottom, top)) = (grow(left, right, 0.8 * size), grow(bottom, top, 0.22 * size));
        Self([left, right, bottom, top])
    }

    /// The height, in units, of a map of this width with equal scales.
    pub(super) fn height(self, width: u32) -> u32 {
        let [left, right, bottom, top] = self.0;
        let plot_width = f64::from(width - LABELS[0] - MARGIN - RIGHT);
        (plot_width * (top - bottom) / (right - left)).round() as u32 + LABELS[1] + 2 * MARGIN
    }

    /// How wide it is, m.
    pub(super) fn width(self) -> f64 {
        self.0[1] - self.0[0]
    }

    /// Draws everything until `until` (s); with `arrows` robots where they are then, and the way of so many seconds at their velocities.
    pub(super) fn draw(
        self,
        area: &Area<'_>,
        scenario: &Scenario,
        selection: &Selection<'_>,
        (until, arrows): (f64, Option<f64>),
    ) -> Result<(), String> {
        let (window @ [left, right, bottom, top], bodies) = (self.0, arrows.is_some());
        let mut chart = ChartBuilder::on(area)
            .margin(MARGIN)
            .margin_right(RIGHT)
            .y_label_area_size(LABELS[0])
            .x_label_area_size(LABELS[1])
            .build_cartesian_2d(left..right, bottom..top)
            .map_err(text)?;
        let mut mesh = chart.configure_mesh();
        mesh.bold_line_style(line(FAINT, 1)).light_line_style(TRANSPARENT).axis_style(line(BLACK.mix(0.6), 1));
        mesh.set_all_tick_mark_size(4 * UNIT)
            .label_style(font(12))
            .axis_desc_style(font(13))
            .x_labels(MARKS)
            .y_labels(MARKS);
        let (across, up) = (Ticks::of((left, right), MARKS), Ticks::of((bottom, top), MARKS));
        let (horizontal, vertical) = (|value: &f64| across.label(*value), |value: &f64| up.label(*value));
        mesh.x_label_formatter(&horizontal).y_label_formatter(&vertical);
        mesh.x_desc("x (m)").y_desc("y (m)").draw().map_err(text)?;
        for part in clip(&segment(scenario), window) {
            let dashes = DashedLineSeries::new(part, 6 * UNIT, 4 * UNIT, line(REFERENCE, 1));
            chart.draw_series(dashes).map_err(text)?;
        }
        if let Some(curve) = curve(scenario) {
            draw_extensions(&mut chart, curve, window)?;
        }
        obstacles::draw(&mut chart, scenario, window, until)?;
        // Those named first are drawn last: where paths are the same, they are seen.
        for robot in selection.robots.iter().rev() {
            if matches!(scenario.task, Task::GoalTracking(_)) && !bodies {
                for part in clip(&goals(robot, until), window) {
                    chart.draw_series(LineSeries::new(part, line(REFERENCE, 1))).map_err(text)?;
                }
            }
            for part in clip(&path(robot, 0.0, until), window) {
                let step = part.len().div_ceil(3000).max(1);
                chart
                    .draw_series(LineSeries::new(
                        part.into_iter().step_by(step),
                        line(robot.colour, if bodies { 1 } else { 2 }),
                    ))
                    .map_err(text)?;
            }
        }
        let inside = |point: &(f64, f64)| point.0 >= left && point.0 <= right && point.1 >= bottom && point.1 <= top;
        let cross = team_goal(scenario).filter(inside);
        chart.draw_series(cross.map(|point| Cross::new(point, 6 * UNIT, line(BLACK, 2)))).map_err(text)?;
        for robot in selection.robots.iter().rev() {
            let last = path(robot, 0.0, until).pop().filter(|point| !bodies && inside(point));
            let end = |point| EmptyElement::at(point) + Rectangle::new(END, robot.colour.filled());
            chart.draw_series(last.map(end)).map_err(text)?;
            let at = if bodies { until } else { 0.0 };
            let Some(pose) = robot.track.pose_at(at).filter(|pose| inside(&(pose.x, pose.y))) else { continue };
            let size = if bodies { 4 } else { 3 };
            chart.draw_series([Circle::new((pose.x, pose.y), size * UNIT, robot.colour.filled())]).map_err(text)?;
            if bodies {
                let beside =
                    |name: &String| EmptyElement::at((pose.x, pose.y)) + Text::new(name.clone(), NAME, font(9));
                chart.draw_series(robot.name.as_ref().map(beside)).map_err(text)?;
            }
            for part in
                arrows.into_iter().flat_map(|long| arrow((pose.x, pose.y), (pose.v, pose.theta), long, self.width()))
            {
                for part in clip(&part, window) {
                    chart.draw_series([PathElement::new(part, line(BLACK.mix(0.8), 1))]).map_err(text)?;
                }
            }
            let goal = robot.track.goal_at(at).map(|[x, y]| (x, y)).filter(inside);
            let goal = goal.filter(|_| bodies && matches!(scenario.task, Task::GoalTracking(_)));
            chart.draw_series(goal.map(|goal| Circle::new(goal, 5 * UNIT, line(robot.colour, 1)))).map_err(text)?;
        }
        chart.draw_series([Rectangle::new([(left, bottom), (right, top)], line(BLACK.mix(0.4), 1))]).map_err(text)?;
        Ok(())
    }
}

fn path(robot: &Shown<'_>, from: f64, until: f64) -> Vec<(f64, f64)> {
    let poses = robot.track.poses.iter().filter(|pose| pose.time >= from && pose.time <= until + 1e-9);
    poses.map(|pose| (pose.x, pose.y)).collect()
}

fn goals(robot: &Shown<'_>, until: f64) -> Vec<(f64, f64)> {
    let goals = robot.track.goals.iter().filter(|goal| goal.time <= until + 1e-9);
    goals.map(|goal| (goal.position[0], goal.position[1])).collect()
}

fn team_goal(scenario: &Scenario) -> impl Iterator<Item = (f64, f64)> {
    let goal = match &scenario.task {
        Task::Regulating(task) => Some(task.goal),
        Task::Directed(task) => Some(task.chain.team_goal),
        Task::Nearest(chain, _) => chain.team_goal,
        Task::Queue(task) => Some(task.queue.target),
        Task::GoalTracking(_) | Task::Launch(_) => None,
    };
    goal.into_iter().map(|goal: Vector2<f64>| (goal.x, goal.y))
}

/// The segment along which robots stand, where it may be open.
pub(super) fn curve(scenario: &Scenario) -> Option<&Curve> {
    match &scenario.task {
        Task::Directed(task) => Some(&task.curve),
        Task::Nearest(chain, _) => Some(&chain.segment),
        Task::Queue(task) => Some(&task.queue.segment),
        _ => None,
    }
}

fn segment(scenario: &Scenario) -> Vec<(f64, f64)> {
    let points = match &scenario.task {
        Task::Directed(task) => match &task.segment {
            trench_formation::curve::CurveShape::Line(from, to) => vec![*from, *to],
            _ => Vec::new(),
        },
        Task::Nearest(chain, shape) => trench_plan::sampled(shape, &chain.segment, 0.0),
        Task::Queue(task) => trench_plan::sampled(&task.segment, &task.queue.segment, 0.0),
        _ => Vec::new(),
    };
    points.into_iter().map(|point| (point.x, point.y)).collect()
}
