//! Curves over time.

use super::style::{Area, FAINT, REFERENCE, UNIT, colour, font, line, text};
use plotters::prelude::*;

/// A diagram of one quantity over time.
pub(super) struct TimeAxes {
    /// What the vertical axis shows, with its unit.
    pub(super) quantity: &'static str,
    /// The times shown, s.
    pub(super) span: (f64, f64),
    /// Whether zero belongs to the vertical axis.
    pub(super) from_zero: bool,
    /// Whether this is the lowest diagram of a picture, the one that names the time.
    pub(super) names_time: bool,
}

/// A curve: the place of its robot in the order of names (nothing for the whole team) and its points.
pub(super) type Curve = (Option<usize>, Vec<(f64, f64)>);

impl TimeAxes {
    /// Draws the curves, and vertical lines at `marks` (s).
    pub(super) fn draw(&self, area: &Area<'_>, curves: &[Curve], marks: &[f64]) -> Result<(), String> {
        let (low, high) = self.range(curves);
        let mut chart = ChartBuilder::on(area)
            .margin_right(18 * UNIT)
            .margin_left(10 * UNIT)
            .margin_top(8 * UNIT)
            .x_label_area_size(UNIT * if self.names_time { 42 } else { 22 })
            .y_label_area_size(62 * UNIT)
            .build_cartesian_2d(self.span.0..self.span.1, low..high)
            .map_err(text)?;
        let mut mesh = chart.configure_mesh();
        mesh.bold_line_style(line(FAINT, 1)).light_line_style(TRANSPARENT).axis_style(line(BLACK.mix(0.6), 1));
        mesh.set_all_tick_mark_size(4 * UNIT)
            .label_style(font(12))
            .axis_desc_style(font(13))
            .y_desc(self.quantity)
            .y_labels(6)
            .x_labels(10);
        mesh.y_label_formatter(&|value| short(*value)).x_label_formatter(&|value| short(*value));
        if self.names_time {
            mesh.x_desc("t (s)");
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
        let margin = ((high - low) * 0.06).max(1e-3);
        (if self.from_zero && low == 0.0 { 0.0 } else { low - margin }, high + margin)
    }
}

/// At most about two thousand points: more than a picture has columns.
fn thinned(points: &[(f64, f64)]) -> impl Iterator<Item = (f64, f64)> {
    points.iter().copied().step_by(points.len().div_ceil(2000).max(1))
}

/// A number without trailing zeros and without a negative zero.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}
