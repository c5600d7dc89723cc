//! The field seen from above: x to the right and y upwards at the same scale.

use super::extensions::{self, draw_extensions};
use super::style::{Area, FAINT, REFERENCE, UNIT, font, line, text};
use super::ticks::Ticks;
use plotters::chart::ChartContext;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::f64::consts::TAU;
use std::ops::Range;
use trench_bag::run::{Pose, Run};
use trench_formation::curve::Curve;
use trench_msgs::msg::Segment;
use trench_plan::curve_from_message;

/// A chart in the map, m.
pub(super) type FieldChart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A robot's body, m.
const BODY_RADIUS: f64 = 0.08;
/// The view of the overhead camera, m.
const CAMERA_VIEW: [f64; 2] = [2.48, 1.83];
/// Room for the numbers and names of the axes, units.
const LABELS: [u32; 2] = [54 * UNIT, 42 * UNIT];
const MARGIN: u32 = 10 * UNIT;
/// The last number of the horizontal axis is half beside it.
const RIGHT: u32 = 24 * UNIT;
/// Marks of the horizontal and the vertical axis, at most.
const MARKS: [usize; 2] = [12, 9];
/// What a legend says of things that are not robots: a table knows no segments, and the goal points' ways stand for them.
pub(super) fn notes(run: &Run) -> String {
    let Some(formation) = &run.formation else { return "× end of the goal point's way (grey)".to_owned() };
    let curves = formation.queues.iter().filter_map(|queue| curve_from_message(&queue.segment).ok());
    let curves: Vec<Curve> = curves.collect();
    format!("× vertex,  - - - segment{}", extensions::note(curves.iter()))
}

/// The part of the map that a picture shows.
#[derive(Clone)]
pub(super) struct View {
    x: Range<f64>,
    y: Range<f64>,
}

impl View {
    /// All of the run; all of the camera's view where the run stays inside it.
    pub(super) fn of(run: &Run) -> Self {
        let poses = run.robots.values().flat_map(|track| track.poses.iter().map(Pose::position));
        let vertices = run.robots.keys().filter_map(|name| run.vertex(name));
        let [mut low, mut high] = [[0.0; 2], CAMERA_VIEW];
        let mut inside = true;
        for point in poses.chain(vertices) {
            for axis in 0..2 {
                inside &= point[axis] > -BODY_RADIUS && point[axis] < CAMERA_VIEW[axis] + BODY_RADIUS;
                low[axis] = low[axis].min(point[axis] - BODY_RADIUS);
                high[axis] = high[axis].max(point[axis] + BODY_RADIUS);
            }
        }
        if inside {
            [low, high] = [[0.0; 2], CAMERA_VIEW];
        }
        Self { x: low[0]..high[0], y: low[1]..high[1] }
    }

    /// The height, in units, of a chart of this width whose two axes have the same scale.
    pub(super) fn height(&self, width: u32) -> u32 {
        let plot_width = f64::from(width - LABELS[0] - MARGIN - RIGHT);
        let ratio = (self.y.end - self.y.start) / (self.x.end - self.x.start);
        (plot_width * ratio).round() as u32 + LABELS[1] + 2 * MARGIN
    }

    /// A chart that fills `area`, which has the size that [`View::height`] asks for.
    pub(super) fn chart<'a, 'b>(&self, area: &'a Area<'b>) -> Result<FieldChart<'a, 'b>, String> {
        let mut chart = ChartBuilder::on(area)
            .margin(MARGIN)
            .margin_right(RIGHT)
            .y_label_area_size(LABELS[0])
            .x_label_area_size(LABELS[1])
            .build_cartesian_2d(self.x.clone(), self.y.clone())
            .map_err(text)?;
        let mut mesh = chart.configure_mesh();
        mesh.bold_line_style(line(FAINT, 1)).light_line_style(TRANSPARENT).axis_style(line(BLACK.mix(0.6), 1));
        mesh.set_all_tick_mark_size(4 * UNIT)
            .label_style(font(12))
            .axis_desc_style(font(13))
            .x_labels(MARKS[0])
            .y_labels(MARKS[1]);
        let (across, up) =
            (Ticks::of((self.x.start, self.x.end), MARKS[0]), Ticks::of((self.y.start, self.y.end), MARKS[1]));
        let (horizontal, vertical) = (|value: &f64| across.label(*value), |value: &f64| up.label(*value));
        mesh.x_label_formatter(&horizontal).y_label_formatter(&vertical);
        mesh.x_desc("x (m)").y_desc("y (m)").draw().map_err(text)?;
        let frame = [(self.x.start, self.y.start), (self.x.end, self.y.end)];
        chart.draw_series([Rectangle::new(frame, line(BLACK.mix(0.4), 1))]).map_err(text)?;
        Ok(chart)
    }
}

/// Draws segments (dashed), or where they are not known the goal points' ways, and the vertices that the robots make for (crosses).
pub(super) fn draw_reference(chart: &mut FieldChart<'_, '_>, run: &Run) -> Result<(), String> {
    let (x, y) = (chart.x_range(), chart.y_range());
    let window = [x.start, x.end, y.start, y.end];
    let formation = run.formation.iter().filter(|formation| formation.header.frame_id != "target");
    for queue in formation.flat_map(|formation| &formation.queues) {
        let series = DashedLineSeries::new(points_of(&queue.segment), 5 * UNIT, 4 * UNIT, line(REFERENCE, 1));
        chart.draw_series(series).map_err(text)?;
        if let Ok(curve) = curve_from_message(&queue.segment) {
            draw_extensions(chart, &curve, window)?;
        }
    }
    for track in run.robots.values().filter(|_| run.formation.is_none()) {
        let way = track.goals.iter().map(|goal| (goal.position[0], goal.position[1]));
        chart.draw_series(LineSeries::new(way, line(REFERENCE.mix(0.6), 1))).map_err(text)?;
    }
    let vertices = run.robots.keys().filter_map(|name| run.vertex(name));
    chart.draw_series(vertices.map(|[x, y]| Cross::new((x, y), 5 * UNIT, line(BLACK, 2)))).map_err(text)?;
    Ok(())
}

/// Draws a body with a line from its centre to its front.
pub(super) fn draw_robot(chart: &mut FieldChart<'_, '_>, pose: &Pose, colour: RGBColor) -> Result<(), String> {
    let at = |angle: f64| (pose.x + BODY_RADIUS * angle.cos(), pose.y + BODY_RADIUS * angle.sin());
    let outline: Vec<_> = (0..=36).map(|step| at(f64::from(step) / 36.0 * TAU)).collect();
    chart.draw_series([Polygon::new(outline.clone(), colour.mix(0.15))]).map_err(text)?;
    chart.draw_series([PathElement::new(outline, line(colour, 1))]).map_err(text)?;
    let front = vec![(pose.x, pose.y), at(pose.theta)];
    chart.draw_series([PathElement::new(front, line(BLACK.mix(0.75), 2))]).map_err(text)?;
    Ok(())
}

/// A segment as a chain of straight pieces.
fn points_of(segment: &Segment) -> Vec<(f64, f64)> {
    let corners = segment.points.iter().map(|point| (point.x, point.y));
    match (segment.kind, segment.points.first(), segment.values.as_slice()) {
        (Segment::KIND_ARC, Some(centre), &[radius, start, sweep, ..]) => (0..=60)
            .map(|step| start + sweep * f64::from(step) / 60.0)
            .map(|angle| (centre.x + radius * angle.cos(), centre.y + radius * angle.sin()))
            .collect(),
        _ => corners.collect(),
    }
}
