//! Curves over time.

use super::style::{Area, FAINT, REFERENCE, UNIT, colour, font, line, text};
use super::ticks::Ticks;
use plotters::prelude::*;

/// What [`TimeAxes::horizontal`] says of time.
pub(super) const TIME: &str = "t (s)";
/// [`TimeAxes::least_margin`] of distances, speeds and angles, in their units.
pub(super) const LEAST_MARGIN: f64 = 1e-3;

/// Marks of the horizontal and the vertical axis, at most.
const MARKS: [usize; 2] = [10, 6];

/// A diagram of one quantity over time, or over another one.
pub(super) struct TimeAxes<'a> {
    /// What the vertical axis shows, with its unit.
    pub(super) quantity: &'a str,
    /// The times shown, s.
    pub(super) span: (f64, f64),
    /// Whether zero belongs to the vertical axis.
    pub(super) from_zero: bool,
    /// What the horizontal axis shows: the lowest diagram of a picture names it.
    pub(super) horizontal: Option<&'a str>,
    /// The least that is shown above and below the values: noise should not look like much.
    pub(super) least_margin: f64,
}

/// A curve: the place of its robot in the order of names (nothing for the whole team) and its points.
pub(super) type Curve = (Option<usize>, Vec<(f64, f64)>);

impl TimeAxes<'_> {
    /// Draws the curves, and vertical lines at `marks` (s).
    pub(super) fn draw(&self, area: &Area<'_>, curves: &[Curve], marks: &[f64]) -> Result<(), String> {
        let (low, high) = self.range(curves);
        let mut chart = ChartBuilder::on(area)
            .margin_right(18 * UNIT)
            .margin_left(10 * UNIT)
            .margin_top(8 * UNIT)
            .x_label_area_size(UNIT * if self.horizontal.is_some() { 42 } else { 22 })
            .y_label_area_size(62 * UNIT)
            .build_cartesian_2d(self.span.0..self.span.1, low..high)
            .map_err(text)?;
        let mut mesh = chart.configure_mesh();
        mesh.bold_line_style(line(FAINT, 1)).light_line_style(TRANSPARENT).axis_style(line(BLACK.mix(0.6), 1));
        mesh.set_all_tick_mark_size(4 * UNIT)
            .label_style(font(12))
            .axis_desc_style(font(13))
            .y_desc(self.quantity)
            .y_labels(MARKS[1])
            .x_labels(MARKS[0]);
        let (across, up) = (Ticks::of(self.span, MARKS[0]), Ticks::of((low, high), MARKS[1]));
        let (horizontal, vertical) = (|value: &f64| across.label(*value), |value: &f64| up.label(*value));
        mesh.x_label_formatter(&horizontal).y_label_formatter(&vertical);
        if let Some(horizontal) = self.horizontal {
            mesh.x_desc(horizontal);
        }
        mesh.draw().map_err(text)?;
        for &mark in marks.iter().filter(|&&mark| mark > self.span.0 && mark < self.span.1) {
            let dashes = DashedLineSeries::new([(mark, low), (mark, high)], 4 * UNIT, 4 * UNIT, line(REFERENCE, 1));
            chart.draw_series(dashes).map_err(text)?;
        }
        for (robot, points) in curves {
            let style = line(robot.map_or(BLACK, colour), 2);
            chart.draw_series(LineSeries::new(thinned(points), style)).map_err(text)?;
        }
        Ok(())
    }

    fn range(&self, curves: &[Curve]) -> (f64, f64) {
        let values = curves.iter().flat_map(|(_, points)| points.iter().map(|point| point.1));
        let (mut low, mut high) = values.fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        if self.from_zero {
            (low, high) = (low.min(0.0), high.max(0.0));
        }
        let margin = ((high - low) * 0.06).max(self.least_margin).max(high.abs().max(low.abs()) * 1e-12);
        (if self.from_zero && low == 0.0 { 0.0 } else { low - margin }, high + margin)
    }
}

/// At most about two thousand points: more than a picture has columns.
fn thinned(points: &[(f64, f64)]) -> impl Iterator<Item = (f64, f64)> {
    points.iter().copied().step_by(points.len().div_ceil(2000).max(1))
}
