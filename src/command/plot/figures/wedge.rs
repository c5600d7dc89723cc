//! Figure 4.8: the stable wedge among the gains K1, K2 and K3 themselves, seen aslant.

use super::super::style::{Area, Picture, REFERENCE, UNIT, centred, colour, font, line, text};
use super::framed;
use plotters::chart::ChartContext;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use trench_formation::stability::{C1, C2};
use trench_scenario::Figure;

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// K1 and K2 up to which it is drawn, 1/s.
const MOST: [f64; 2] = [6.0, 2.0];
const HEIGHT: u32 = 560 * UNIT;
const NOTES: &str = "c1 = 2.3017, c2 = -0.5;  stable between the edges;  against K3 = K1, phi falls faster above it (orange) and more slowly below it (blue)\n\
K1 > 0 and K2 > 0, in 1/s, seen aslant: the slice in front is that of K1 = 6";

/// Between its edges, halved by the plane K3 = K1; dotted the plane in the middle that guideline (2) of 4.3.2 recommends.
pub(super) fn draw(figure: &Figure) -> Picture {
    let edge = |name: &str, colour| (name.to_owned(), colour);
    let legend = [
        edge("K3 = K1 + 2 c1 K2", colour(1)),
        edge("K3 = K1 + 2 c2 K2", colour(0)),
        edge("K3 = K1", BLACK),
        edge("the middle of both", colour(2)),
    ];
    framed(figure, (&legend, NOTES), HEIGHT, wedge)
}

fn wedge(area: &Area<'_>) -> Result<(), String> {
    let mut chart =
        ChartBuilder::on(area).margin(10 * UNIT).build_cartesian_2d(-6.5..13.0, -5.0..14.5).map_err(text)?;
    axes(&mut chart)?;
    let [most, widest] = MOST;
    let [above, below] = [colour(1), colour(0)];
    // From the back to the front, all translucent.
    for (k1, share) in [(0.0, 0.14), (most, 0.4)] {
        for (slope, colour) in [(2.0 * C1, above), (2.0 * C2, below)] {
            let corners = [0.0, slope].map(|slope| on(slope, k1, widest));
            let slice = Polygon::new(vec![on(0.0, k1, 0.0), corners[0], corners[1]], colour.mix(share));
            chart.draw_series([slice]).map_err(text)?;
        }
    }
    for (slope, colour, filled) in
        [(2.0 * C2, colour(0), 0.08), (0.0, BLACK, 0.10), (C1 + C2, colour(2), 0.0), (2.0 * C1, colour(1), 0.08)]
    {
        let corners = [(0.0, 0.0), (0.0, widest), (most, widest), (most, 0.0), (0.0, 0.0)];
        let corners: Vec<(f64, f64)> = corners.into_iter().map(|(k1, k2)| on(slope, k1, k2)).collect();
        chart.draw_series([Polygon::new(corners.clone(), colour.mix(filled))]).map_err(text)?;
        if filled > 0.0 {
            chart.draw_series([PathElement::new(corners, line(colour, 2))]).map_err(text)?;
        } else {
            let dashes = DashedLineSeries::new(corners, 3 * UNIT, 3 * UNIT, line(colour, 2));
            chart.draw_series(dashes).map_err(text)?;
        }
    }
    Ok(())
}

/// The point of the plane K3 = K1 + slope K2 with these gains, as it is seen.
fn on(slope: f64, k1: f64, k2: f64) -> (f64, f64) {
    seen([k1, k2, k1 + slope * k2])
}

/// K2 to the right, K3 upwards, K1 towards the reader.
fn seen([k1, k2, k3]: [f64; 3]) -> (f64, f64) {
    (5.0 * k2 - 0.8 * k1, k3 - 0.55 * k1)
}

fn axes(chart: &mut Chart<'_, '_>) -> Result<(), String> {
    for (axis, name, end, ticks) in
        [(0, "K1", 7.2, &[2.0, 4.0, 6.0][..]), (1, "K2", 2.35, &[1.0, 2.0]), (2, "K3", 13.0, &[5.0, 10.0])]
    {
        let at = |value: f64| {
            let mut gains = [0.0; 3];
            gains[axis] = value;
            seen(gains)
        };
        chart.draw_series([PathElement::new([at(0.0), at(end)], line(REFERENCE, 1))]).map_err(text)?;
        let (x, y) = at(1.05 * end);
        chart.draw_series([Text::new(name, (x, y), centred(14))]).map_err(text)?;
        for &tick in ticks {
            let beside = [(-18, -10), (-4, 8), (-22, -6)][axis];
            let beside = (beside.0 * UNIT as i32, beside.1 * UNIT as i32);
            let label = EmptyElement::at(at(tick))
                + Circle::new((0, 0), 2 * UNIT, REFERENCE.filled())
                + Text::new(format!("{tick}"), beside, font(12));
            chart.draw_series([label]).map_err(text)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gains of 4.4.3 and 4.4.4: inside, and on either side.
    #[test]
    fn the_wedge_is_that_of_the_experiments() {
        let inside = |k3: f64| (20.0 + 2.0 * C2..20.0 + 2.0 * C1).contains(&k3);
        assert!([19.2, 20.0, 21.8, 22.3].into_iter().all(inside));
        assert!(![18.8, 24.8].into_iter().any(inside));
        // Its upper face lies above its lower one wherever one looks.
        assert!(on(2.0 * C1, 3.0, 1.0).1 > on(0.0, 3.0, 1.0).1 && on(0.0, 3.0, 1.0).1 > on(2.0 * C2, 3.0, 1.0).1);
    }
}
