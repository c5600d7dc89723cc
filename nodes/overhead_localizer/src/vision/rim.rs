//! The centre of a disc that is partly hidden, from the part of its rim that is seen.
//!
//! A cable or a finger over a disc moves its centre of area, and cuts the runs that find its size. The rim that is left lies on
//! the ellipse that the whole disc would have: from all sides one looks inwards for it, and what does not lie on one ellipse
//! with the others, because it is the edge of what hides the disc, is left out.

use super::blob::Tracer;
use nalgebra::{Matrix3, Vector3};
use trench_optics::Pixel;

/// Directions from which the rim is looked for.
const DIRECTIONS: usize = 32;
/// Where looks begin and end, in radii.
const REACH: [f64; 2] = [1.35, 0.55];
/// So many of them must find the rim of one ellipse.
const FEWEST: usize = 15;
/// A place is on the ellipse within this, in radii: less than a pixel of the test bed's discs.
pub(super) const ON_RIM: f64 = 0.07;
/// The whole is so large, in expected radii.
const SIZE: [f64; 2] = [0.85, 1.15];
/// Of the disc at least this part is seen.
const SEEN: f64 = 0.45;

/// A disc found by its rim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rim {
    pub(super) centre: Pixel,
    /// Of the expected radius.
    pub(super) size: f64,
    /// The part of the disc that is seen, 0..1.
    pub(super) seen: f64,
}

/// The disc with about these half axes (pixels) that the pixel at column `u` and row `v` belongs to.
pub(super) fn find<const RED: usize>(tracer: &Tracer<'_, RED>, [u, v]: [usize; 2], half: [f64; 2]) -> Option<Rim> {
    let (centre, level) = settle(tracer, [u as f64, v as f64], half, tracer.level(u, v) / 2)?;
    let (places, found) = rim(tracer, centre, half, level);
    let fitted = fit(&places[..found])?;
    let size = fitted.z;
    let centre = [centre[0] + half[0] * fitted.x, centre[1] + half[1] * fitted.y];
    let seen = cover(tracer, centre, half.map(|axis| 0.85 * size * axis), level);
    let fits = (SIZE[0]..SIZE[1]).contains(&size) && seen >= SEEN;
    fits.then_some(Rim { centre: Pixel { u: centre[0], v: centre[1] }, size, seen })
}

/// The mean place of the disc's pixels from a place in it on, and half their mean chroma; `level` is about that.
pub(super) fn settle<const RED: usize>(
    tracer: &Tracer<'_, RED>,
    mut centre: [f64; 2],
    half: [f64; 2],
    mut level: i32,
) -> Option<([f64; 2], i32)> {
    for _ in 0..5 {
        // Where the disc's own level is known, half of it is its edge.
        (centre, level) = middle(tracer, centre, half, level)?;
    }
    Some((centre, level))
}

/// The mean place of the disc's pixels around a place, and half their mean chroma.
fn middle<const RED: usize>(
    tracer: &Tracer<'_, RED>,
    centre: [f64; 2],
    half: [f64; 2],
    level: i32,
) -> Option<([f64; 2], i32)> {
    let (mut count, mut sum, mut chroma) = (0_i32, [0_usize; 2], 0);
    for_ellipse(centre, half, |u, v| {
        let here = tracer.chroma(u, v);
        if here >= level {
            (count, chroma) = (count + 1, chroma + here);
            sum = [sum[0] + u, sum[1] + v];
        }
    });
    (count > 0).then(|| (sum.map(|total| total as f64 / f64::from(count)), chroma / count / 2))
}

/// The part of an ellipse that has the disc's colour.
pub(super) fn cover<const RED: usize>(tracer: &Tracer<'_, RED>, centre: [f64; 2], half: [f64; 2], level: i32) -> f64 {
    let (mut inside, mut all) = (0_u32, 0_u32);
    for_ellipse(centre, half, |u, v| {
        all += 1;
        inside += u32::from(tracer.chroma(u, v) >= level);
    });
    f64::from(inside) / f64::from(all.max(1))
}

pub(super) fn for_ellipse(centre: [f64; 2], half: [f64; 2], mut visit: impl FnMut(usize, usize)) {
    let range =
        |axis: usize| (centre[axis] - half[axis]).max(0.0) as usize..(centre[axis] + half[axis]).max(0.0) as usize + 2;
    for v in range(1) {
        for u in range(0) {
            let (across, down) = ((u as f64 - centre[0]) / half[0], (v as f64 - centre[1]) / half[1]);
            if across * across + down * down <= 1.0 {
                visit(u, v);
            }
        }
    }
}

/// Places on the rim, in radii from the centre.
pub(super) fn rim<const RED: usize>(
    tracer: &Tracer<'_, RED>,
    centre: [f64; 2],
    half: [f64; 2],
    level: i32,
) -> ([[f64; 2]; DIRECTIONS], usize) {
    let (mut places, mut found) = ([[0.0; 2]; DIRECTIONS], 0);
    for direction in 0..DIRECTIONS {
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * direction as f64 / DIRECTIONS as f64);
        let at = |radius: f64| {
            let place = [centre[0] + half[0] * radius * cosine, centre[1] + half[1] * radius * sine];
            between(place, |u, v| f64::from(tracer.chroma(u, v)))
        };
        let step = 0.5 / half[0].max(half[1]);
        let mut radius = REACH[0];
        let mut outer = at(radius);
        while outer < f64::from(level) && radius > REACH[1] {
            let inner = at(radius - step);
            if inner >= f64::from(level) {
                let edge = radius - step * (f64::from(level) - outer) / (inner - outer);
                places[found] = [edge * cosine, edge * sine];
                found += 1;
                break;
            }
            (radius, outer) = (radius - step, inner);
        }
    }
    (places, found)
}

/// A value between four pixels; places left of or above the image count as its edge.
pub(super) fn between([u, v]: [f64; 2], at: impl Fn(usize, usize) -> f64) -> f64 {
    let (column, row) = (u.max(0.0), v.max(0.0));
    let (first, top) = (column as usize, row as usize);
    let (right, down) = (column - first as f64, row - top as f64);
    let upper = at(first, top) * (1.0 - right) + at(first + 1, top) * right;
    let lower = at(first, top + 1) * (1.0 - right) + at(first + 1, top + 1) * right;
    upper * (1.0 - down) + lower * down
}

/// Centre and radius of the circle that most places lie on, in radii; None if there are too few of them.
///
/// Places off the circle lose their weight from round to round (J. Tukey's biweight, its limit drawn in).
pub(super) fn fit(places: &[[f64; 2]]) -> Option<Vector3<f64>> {
    let mut circle = Vector3::new(0.0, 0.0, 1.0);
    for limit in [0.5, 0.35, 0.25, 0.17, 0.12, 2.0 * ON_RIM, 2.0 * ON_RIM, 2.0 * ON_RIM] {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for place in places {
            let (dx, dy) = (place[0] - circle.x, place[1] - circle.y);
            let distance = libm::hypot(dx, dy).max(1e-6);
            let off = distance - circle.z;
            let part = (off / limit).abs();
            if part < 1.0 {
                let weight = (1.0 - part * part) * (1.0 - part * part);
                let slope = Vector3::new(dx / distance, dy / distance, 1.0);
                normal += weight * slope * slope.transpose();
                right += weight * off * slope;
            }
        }
        circle += normal.try_inverse()? * right;
    }
    let on_rim = |place: &&[f64; 2]| (libm::hypot(place[0] - circle.x, place[1] - circle.y) - circle.z).abs() < ON_RIM;
    (places.iter().filter(on_rim).count() >= FEWEST).then_some(circle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_of_the_rim_may_lie() {
        let place = |k: usize| {
            let (sine, cosine) = (std::f64::consts::TAU * k as f64 / 32.0).sin_cos();
            // A chord cuts off the right.
            let (x, y) = (0.1 + 0.97 * cosine, -0.05 + 0.97 * sine);
            [x.min(0.6), y]
        };
        let places: Vec<[f64; 2]> = (0..32).map(place).collect();
        let circle = fit(&places).unwrap();
        // 0.015 radii are 0.5 mm.
        assert!((circle - Vector3::new(0.1, -0.05, 0.97)).norm() < 0.015, "{circle}");
        // A straight edge, and a corner, are no circle.
        let edge: Vec<[f64; 2]> = (0..32).map(|k| [0.3, -1.0 + k as f64 / 16.0]).collect();
        assert_eq!(fit(&edge), None);
        let square: Vec<[f64; 2]> = (0..32).map(place).map(|[x, y]| [x.clamp(-0.6, 0.6), y.clamp(-0.6, 0.6)]).collect();
        assert!(fit(&square).is_none_or(|circle| circle.z < SIZE[0]));
    }
}
