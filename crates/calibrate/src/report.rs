//! What people read: numbers as text, residuals as a picture.

use crate::{Field, FittedLens, KnownPoint, LensModel};
use std::fmt::Write as _;

/// Residuals are drawn so many times as long as they are.
const LARGER: f64 = 100.0;

/// A lens in words: what was found, how well, and which picture fits worst.
#[must_use]
pub fn lens_text(fitted: &FittedLens, names: &[String], model: LensModel) -> String {
    let lens = fitted.lens;
    let d = lens.distortion;
    let values = [
        ("fx", lens.fx),
        ("fy", lens.fy),
        ("cx", lens.cx),
        ("cy", lens.cy),
        ("k1", d.k1),
        ("k2", d.k2),
        ("p1", d.p1),
        ("p2", d.p2),
        ("k3", d.k3),
    ];
    let mut text = format!("residual {:.3} px over {} pictures\n", fitted.rms, fitted.residuals.len());
    let count = if model == LensModel::TwoRadial { 8 } else { 9 };
    for ((name, value), deviation) in values.into_iter().zip(fitted.deviations).take(count) {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:>4} {value:>12.5} +- {deviation:.5}");
    }
    for (name, residuals) in names.iter().zip(&fitted.residuals) {
        let _ = writeln!(text, "{:8.3} px  {name}", rms(residuals));
    }
    text
}

/// Every corner of all pictures with its residual, a hundred times as long.
#[must_use]
pub fn lens_picture(fitted: &FittedLens, pictures: &[Vec<[f64; 2]>]) -> String {
    let mut svg = Svg::new(f64::from(fitted.lens.width), f64::from(fitted.lens.height));
    for (corners, residuals) in pictures.iter().zip(&fitted.residuals) {
        for ([u, v], [du, dv]) in corners.iter().zip(residuals) {
            svg.arrow([*u, *v], [LARGER * du, LARGER * dv], "#2166ac");
        }
    }
    svg.end(&format!("residuals, {LARGER} times as long; {:.3} px", fitted.rms))
}

/// The camera's place in words, each point with its misfit, and the one that is wrong.
#[must_use]
pub fn field_text(field: &Field) -> String {
    let mount = field.mount;
    let mut text = format!("residual {:.1} mm over {} points\n", 1e3 * field.rms, field.points.len());
    let values = [
        ("x", mount.x, "m"),
        ("y", mount.y, "m"),
        ("height", mount.height, "m"),
        ("roll", mount.roll, "rad"),
        ("pitch", mount.pitch, "rad"),
        ("yaw", mount.yaw, "rad"),
    ];
    for ((name, value, unit), deviation) in values.into_iter().zip(field.deviations) {
        let _ = writeln!(text, "{name:>10} {value:>9.5} +- {deviation:.5} {unit}");
    }
    if let Some(height) = field.pad_height {
        let _ = writeln!(text, "pad height {height:>9.5} +- {:.5} m", field.deviations[6]);
    }
    text.push_str("left out   fitted  point\n");
    for point in &field.points {
        let _ = writeln!(text, "{:5.1} mm {:5.1} mm  {}", 1e3 * point.left_out, 1e3 * point.fitted, point.name);
    }
    match &field.bad {
        Some(name) => {
            let _ = writeln!(text, "{name} does not agree with the others: measure it again, or leave it out");
        }
        None => text.push_str("all points agree\n"),
    }
    text
}

/// Each point where it is seen, a ring as wide as its misfit is large (a millimetre is 4 pixels); the wrong one red.
#[must_use]
pub fn field_picture(field: &Field, points: &[KnownPoint], [width, height]: [u32; 2]) -> String {
    let mut svg = Svg::new(f64::from(width), f64::from(height));
    for (point, misfit) in points.iter().zip(&field.points) {
        let colour = if field.bad.as_ref() == Some(&point.name) { "#b2182b" } else { "#2166ac" };
        svg.ring([point.pixel.u, point.pixel.v], 4e3 * misfit.left_out, colour, &point.name);
    }
    svg.end(&format!("misfits of points left out, 4 px a mm; {:.1} mm over all", 1e3 * field.rms))
}

fn rms(residuals: &[[f64; 2]]) -> f64 {
    let total: f64 = residuals.iter().map(|[u, v]| u * u + v * v).sum();
    libm::sqrt(total / residuals.len().max(1) as f64)
}

struct Svg {
    text: String,
    height: f64,
}

impl Svg {
    fn new(width: f64, height: f64) -> Self {
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{}\" font-family=\"sans-serif\" \
             font-size=\"13\">\n<rect width=\"{width}\" height=\"{}\" fill=\"white\"/>\n<rect width=\"{width}\" \
             height=\"{height}\" fill=\"#f4f4f4\"/>\n",
            height + 24.0,
            height + 24.0
        );
        Self { text, height }
    }

    fn arrow(&mut self, [u, v]: [f64; 2], [du, dv]: [f64; 2], colour: &str) {
        let _ = writeln!(
            self.text,
            "<circle cx=\"{u:.2}\" cy=\"{v:.2}\" r=\"1.2\" fill=\"{colour}\"/><path d=\"M {u:.2} {v:.2} l {du:.2} {dv:.2}\" \
             stroke=\"{colour}\"/>"
        );
    }

    fn ring(&mut self, [u, v]: [f64; 2], radius: f64, colour: &str, name: &str) {
        let escaped = name.replace('&', "&amp;").replace('<', "&lt;");
        let _ = writeln!(
            self.text,
            "<circle cx=\"{u:.2}\" cy=\"{v:.2}\" r=\"2\" fill=\"{colour}\"/><circle cx=\"{u:.2}\" cy=\"{v:.2}\" \
             r=\"{radius:.2}\" fill=\"none\" stroke=\"{colour}\"/><text x=\"{:.1}\" y=\"{:.1}\">{escaped}</text>",
            u + 6.0,
            v - 6.0
        );
    }

    fn end(mut self, caption: &str) -> String {
        let _ = write!(self.text, "<text x=\"6\" y=\"{}\">{caption}</text>\n</svg>\n", self.height + 17.0);
        self.text
    }
}
