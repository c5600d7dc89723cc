//! Diagrams over one horizontal axis, one below the other.

use super::axes::{Curve, TimeAxes};
use super::style::{LEGEND, Picture, UNIT, legend, picture};

/// Height of one diagram, units.
const HEIGHT: u32 = 260 * UNIT;

/// A quantity with its unit, and its curves.
pub(in crate::command) type Diagram = (String, Vec<Vec<(f64, f64)>>);

/// Draws diagrams, their curves in the colours of the legend's names.
pub(super) fn draw(names: &[String], notes: &str, horizontal: &str, diagrams: &[Diagram]) -> Picture {
    let height = LEGEND.unsigned_abs() + HEIGHT * diagrams.len() as u32;
    picture((900 * UNIT, height), |area| {
        let (top, mut rest) = area.split_vertically(LEGEND);
        legend(&top, names.iter(), notes)?;
        for (index, (quantity, curves)) in diagrams.iter().enumerate() {
            let (upper, lower) = rest.split_vertically(HEIGHT);
            let curves: Vec<Curve> =
                curves.iter().enumerate().map(|(place, points)| (Some(place), points.clone())).collect();
            let horizontal = (index + 1 == diagrams.len()).then_some(horizontal);
            let axes = TimeAxes { quantity, span: span(&curves), from_zero: false, horizontal, least_margin: 0.0 };
            axes.draw(&upper, &curves, &[])?;
            rest = lower;
        }
        Ok(())
    })
}

/// From the first point to the last, never empty.
fn span(curves: &[Curve]) -> (f64, f64) {
    let times = curves.iter().flat_map(|(_, points)| points.iter().map(|point| point.0));
    let (first, last) = times.fold((f64::MAX, f64::MIN), |(first, last), time| (first.min(time), last.max(time)));
    if first < last { (first, last) } else { (0.0, 1.0) }
}
