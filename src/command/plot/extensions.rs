//! What lies beyond the open ends of a curve: straight along the tangents there, without end (2.1), and dotted in pictures.

use super::clip::clip;
use super::field::FieldChart;
use super::style::{REFERENCE, UNIT, line, text};
use plotters::prelude::*;
use trench_formation::Vector2;
use trench_formation::curve::Curve;

/// What a legend says of those of some curves, behind its word for the segment.
pub(super) fn note<'a>(mut curves: impl Iterator<Item = &'a Curve>) -> &'static str {
    let is_open = |curve: &Curve| curve.domain() != (0.0, curve.length());
    if curves.any(is_open) { ",  · · · its open end" } else { "" }
}

/// Draws them within `[left, right, bottom, top]` (m).
pub(super) fn draw_extensions(
    chart: &mut FieldChart<'_, '_>,
    curve: &Curve,
    window @ [left, right, bottom, top]: [f64; 4],
) -> Result<(), String> {
    let ((from, to), middle) = (curve.domain(), 0.5 * Vector2::new(left + right, bottom + top));
    for (domain, end, outward) in [(from, 0.0, -1.0), (to, curve.length(), 1.0)] {
        if domain.is_finite() {
            continue;
        }
        // To whatever of the window is farthest.
        let far = (curve.at(end).point - middle).norm() + (right - left) + (top - bottom);
        let extension = [end, end + outward * far].map(|at| curve.at(at).point).map(|point| (point.x, point.y));
        for part in clip(&extension, window) {
            let dots = DashedLineSeries::new(part, 2 * UNIT, 5 * UNIT, line(REFERENCE.mix(0.7), 1));
            chart.draw_series(dots).map_err(text)?;
        }
    }
    Ok(())
}
