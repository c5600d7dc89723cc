//! What all pictures share: colours, fonts, the legend.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use resvg::usvg;

/// A part of a picture.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// A picture or what went wrong.
pub(super) type Picture = Result<String, String>;

/// The colours of Okabe and Ito, which people with any colour vision tell apart, darkest contrasts first.
pub(super) const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];
/// Of lines that are not data.
pub(super) const FAINT: RGBColor = RGBColor(225, 225, 225);
/// Of what robots should do: segments, vertices.
pub(super) const REFERENCE: RGBColor = RGBColor(110, 110, 110);
/// Plotters rounds to whole units: they are made this small, quarters of what a picture's size is given in.
pub(super) const UNIT: u32 = 4;
/// The height of the legend, units.
pub(super) const LEGEND: i32 = 30 * UNIT as i32;

/// The colour of the robot with this place in the order of names.
pub(super) fn colour(robot: usize) -> RGBColor {
    COLOURS.get(robot % COLOURS.len()).copied().unwrap_or(BLACK)
}

/// A line of this width.
pub(super) fn line(colour: impl Color, width: u32) -> ShapeStyle {
    colour.stroke_width(width * UNIT)
}

/// Text of this size.
pub(super) fn font(size: u32) -> TextStyle<'static> {
    ("DejaVu Sans, Verdana, sans-serif", size * UNIT).into_font().color(&RGBColor(40, 40, 40))
}

/// Text of this size, centred at its position.
pub(super) fn centred(size: u32) -> TextStyle<'static> {
    font(size).pos(Pos::new(HPos::Center, VPos::Center))
}

/// Draws a white picture of this size in units.
pub(super) fn picture(size: (u32, u32), draw: impl FnOnce(&Area<'_>) -> Result<(), String>) -> Picture {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE).map_err(text)?;
        draw(&area)?;
        area.present().map_err(text)?;
    }
    // Shown at the size that was meant, whatever the units.
    let in_units = format!(r#"width="{}" height="{}""#, size.0, size.1);
    let shown = format!(r#"width="{}" height="{}""#, size.0 / UNIT, size.1 / UNIT);
    Ok(svg.replacen(&in_units, &shown, 1))
}

/// Puts a title above a picture.
pub(super) fn titled(title: &str, svg: &str) -> Picture {
    const HEIGHT: f32 = 34.0;
    let size = usvg::Tree::from_str(svg, &usvg::Options::default()).map_err(text)?.size();
    let (width, height) = (size.width(), size.height() + HEIGHT);
    let title = title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    Ok(format!(
        r##"<svg width="{width}" height="{height}" viewBox="0 0 {width} {height}" xmlns="http://www.w3.org/2000/svg">
<rect width="{width}" height="{height}" fill="#FFFFFF"/>
<text x="{}" y="22" text-anchor="middle" font-family="DejaVu Sans, Verdana, sans-serif" font-size="15" fill="#282828">{title}</text>
<g transform="translate(0 {HEIGHT})">
{svg}</g>
</svg>
"##,
        0.5 * width
    ))
}

/// Draws one entry a robot, from left to right, then `notes` on what else is drawn.
pub(super) fn legend<'a>(area: &Area<'_>, robots: impl Iterator<Item = &'a String>, notes: &str) -> Result<(), String> {
    const SCALE: i32 = UNIT as i32;
    let middle = LEGEND / 2;
    let style = font(13).pos(Pos::new(HPos::Left, VPos::Center));
    let mut left = 20 * SCALE;
    for (index, name) in robots.enumerate() {
        let sample = PathElement::new([(left, middle), (left + 22 * SCALE, middle)], line(colour(index), 3));
        area.draw(&sample).map_err(text)?;
        area.draw(&Text::new(name.clone(), (left + 28 * SCALE, middle), style.clone())).map_err(text)?;
        left += (28 + 8 * name.chars().count() as i32 + 22) * SCALE;
    }
    area.draw(&Text::new(notes.to_owned(), (left, middle), style)).map_err(text)
}

/// An error as text, for `map_err`.
pub(super) fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}
