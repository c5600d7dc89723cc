//! Diagrams of one quantity over another.

use super::super::clip::clip;
use super::super::style::{Area, FAINT, REFERENCE, UNIT, font, line, text};
use super::super::ticks::Ticks;
use plotters::prelude::*;

/// Marks of the horizontal and the vertical axis, at most.
const MARKS: [usize; 2] = [11, 8];

/// A diagram's axes.
pub(super) struct Diagram<'a> {
    /// Names with units.
    pub(super) names: [&'a str; 2],
    /// `[left, right, bottom, top]`; what the curves need without it.
    pub(super) window: Option<[f64; 4]>,
    /// Dashed horizontal lines.
    pub(super) levels: &'a [f64],
    /// Corners of what is filled behind the curves, inside the window; none where nothing is.
    pub(super) filled: &'a [(f64, f64)],
}

impl Diagram<'_> {
    /// Draws the curves.
    pub(super) fn draw(&self, area: &Area<'_>, curves: &[(RGBColor, Vec<(f64, f64)>)]) -> Result<(), String> {
        let window @ [left, right, bottom, top] = self.window.unwrap_or_else(|| self.around(curves));
        let mut chart = ChartBuilder::on(area)
            .margin_right(18 * UNIT)
            .margin_left(10 * UNIT)
            .margin_top(8 * UNIT)
            .x_label_area_size(42 * UNIT)
            .y_label_area_size(62 * UNIT)
            .build_cartesian_2d(left..right, bottom..top)
            .map_err(text)?;
        let mut mesh = chart.configure_mesh();
        mesh.bold_line_style(line(FAINT, 1)).light_line_style(TRANSPARENT).axis_style(line(BLACK.mix(0.6), 1));
        mesh.set_all_tick_mark_size(4 * UNIT)
            .label_style(font(12))
            .axis_desc_style(font(13))
            .x_desc(self.names[0])
            .y_desc(self.names[1])
            .x_labels(MARKS[0])
            .y_labels(MARKS[1]);
        let (across, up) = (Ticks::of((left, right), MARKS[0]), Ticks::of((bottom, top), MARKS[1]));
        let (horizontal, vertical) = (|value: &f64| across.label(*value), |value: &f64| up.label(*value));
        mesh.x_label_formatter(&horizontal).y_label_formatter(&vertical);
        mesh.draw().map_err(text)?;
        if !self.filled.is_empty() {
            chart.draw_series([Polygon::new(self.filled.to_vec(), REFERENCE.mix(0.15))]).map_err(text)?;
        }
        for &level in self.levels.iter().filter(|&&level| level > bottom && level < top) {
            let dashes = DashedLineSeries::new([(left, level), (right, level)], 5 * UNIT, 4 * UNIT, line(REFERENCE, 1));
            chart.draw_series(dashes).map_err(text)?;
        }
        for (colour, points) in curves {
            for part in clip(points, window) {
                let step = part.len().div_ceil(3000).max(1);
                chart.draw_series(LineSeries::new(part.into_iter().step_by(step), line(colour, 2))).map_err(text)?;
            }
        }
        Ok(())
    }

    fn around(&self, curves: &[(RGBColor, Vec<(f64, f64)>)]) -> [f64; 4] {
        let points = || curves.iter().flat_map(|(_, points)| points).filter(|(x, y)| x.is_finite() && y.is_finite());
        let bounds = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)))
        };
        let (left, right) = bounds(&mut points().map(|point| point.0));
        let (bottom, top) = bounds(&mut points().map(|point| point.1).chain(self.levels.iter().copied()));
        if left >= right || bottom > top {
            return [0.0, 1.0, 0.0, 1.0];
        }
        let margin = (0.06 * (top - bottom)).max(1e-3);
        [left, right, if bottom >= 0.0 { 0.0 } else { bottom - margin }, top + margin]
    }
}
