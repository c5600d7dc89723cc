//! Figures 4.1 to 4.8, which need no run.

use super::super::style::{Picture, REFERENCE, colour};
use super::super::ticks::short;
use super::diagram::Diagram;
use super::{SMALL, framed};
use plotters::style::RGBColor;
use std::f64::consts::PI;
use trench_formation::kinematics::Polar;
use trench_formation::stability::{C1, C2, ClosedForm, TwoGainLaw, sine_integral};
use trench_scenario::Figure;

/// Points of a curve over (-pi, pi].
const POINTS: i32 = 400;

type Curve = (String, RGBColor, Vec<(f64, f64)>);

/// Fig. 4.1.
pub(super) fn sine_integrals(figure: &Figure) -> Picture {
    let curves = vec![
        curve("Si(x)", colour(0), sine_integral),
        curve("Si(2x)/2", colour(1), |x| 0.5 * sine_integral(2.0 * x)),
        curve("F(x) = Si(x) - Si(2x)/2", colour(2), |x| sine_integral(x) - 0.5 * sine_integral(2.0 * x)),
    ];
    diagram(figure, ["x (rad)", "integral"], &curves)
}

/// Fig. 4.2 and 4.3: S1 and S2, which have the sign of the curvature's derivative.
pub(super) fn curvature_trends(figure: &Figure, law: TwoGainLaw) -> Picture {
    let trend = |(index, lambda): (usize, f64)| {
        // lambda = 0 is a robot that turns on the spot: its limit is drawn.
        let start = Polar { distance: 1.0, misalignment: 1.0 };
        let form = ClosedForm { law, k1: lambda.max(1e-9), k2: 1.0, start };
        curve(&format!("lambda = {lambda}"), colour(index), |a| form.curvature_trend(a))
    };
    let curves: Vec<Curve> = [0.0, 1.0, 2.0, 3.0, 4.0].into_iter().enumerate().map(trend).collect();
    let name = match law {
        TwoGainLaw::Direct => "S1(A)",
        TwoGainLaw::Nominal => "S2(A)",
    };
    diagram(figure, ["A (rad)", name], &curves)
}

/// Fig. 4.4 and 4.5: where phi meets -k sin 2 phi, k = K4/K2. Below c1 and above c2 that is at 0 alone.
pub(super) fn solutions(figure: &Figure, critical: f64) -> Picture {
    let side = |(index, share): (usize, f64)| {
        let ratio = share * critical;
        curve(&format!("k = {}", short(ratio)), colour(index), move |phi| -ratio * (2.0 * phi).sin())
    };
    let mut curves = vec![curve("phi", REFERENCE, |phi| phi)];
    curves.extend([0.5, 1.0, 2.0].into_iter().enumerate().map(side));
    for (_, _, points) in &mut curves {
        points.retain(|(phi, _)| *phi >= 0.0);
    }
    diagram(figure, ["phi (rad)", "-k sin(2 phi) for k = K4/K2"], &curves)
}

/// Fig. 4.6 to 4.8: between its edges, K4 = (K3 - K1)/2 against K2; filled where it is stable, for K2 > 0.
pub(super) fn wedge(figure: &Figure, most: f64) -> Picture {
    let edge = |name: String, colour, slope: f64| (name, colour, vec![(0.0, 0.0), (most, most * slope)]);
    let curves = [
        edge(format!("K4 = {C1:.4} K2"), colour(1), C1),
        edge(format!("K4 = {C2} K2"), colour(0), C2),
        edge("K3 = K1".to_owned(), REFERENCE, 0.0),
    ];
    let corners = [(0.0, 0.0), (most, most * C1), (most, most * C2)];
    filled(figure, ["K2 (1/s)", "K4 = (K3 - K1)/2 (1/s)"], &curves, if most > 0.0 { &corners } else { &[] })
}

fn curve(name: &str, colour: RGBColor, function: impl Fn(f64) -> f64) -> Curve {
    let points = (-POINTS / 2..=POINTS / 2).map(|step| 2.0 * PI * f64::from(step) / f64::from(POINTS));
    (name.to_owned(), colour, points.map(|x| (x, function(x))).collect())
}

fn diagram(figure: &Figure, names: [&str; 2], curves: &[Curve]) -> Picture {
    filled(figure, names, curves, &[])
}

fn filled(figure: &Figure, names: [&str; 2], curves: &[Curve], filled: &[(f64, f64)]) -> Picture {
    let legend: Vec<(String, RGBColor)> = curves.iter().map(|(name, colour, _)| (name.clone(), *colour)).collect();
    let lines: Vec<(RGBColor, Vec<(f64, f64)>)> =
        curves.iter().map(|(_, colour, points)| (*colour, points.clone())).collect();
    framed(figure, (&legend, ""), SMALL, |area| {
        Diagram { names, window: figure.window, levels: &[0.0], filled }.draw(area, &lines)
    })
}
