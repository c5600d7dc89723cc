//! A lens from pictures of a board (Z. Zhang, "A flexible new technique for camera calibration", 2000).
//!
//! The focal length comes from the boards' homographies, with square pixels and the principal point in the middle; from there
//! all is refined together: focal lengths, principal point, distortion, and where each board was.

use crate::least_squares::{Model, solve};
use crate::{Board, homography, rotation};
use nalgebra::{Matrix3, Point2, Vector3};
use trench_optics::{Lens, PlumbBob};

/// What is fitted of the distortion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LensModel {
    /// k1, k2, p1, p2: what most lenses need.
    TwoRadial,
    /// k3 too: for wide lenses, with boards up to the corners.
    ThreeRadial,
}

/// A lens, and how well it explains the pictures.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedLens {
    /// The lens.
    pub lens: Lens,
    /// Standard deviations of fx, fy, cx, cy (pixels), k1, k2, p1, p2, k3 by the scatter of the residuals; 0 where not fitted.
    pub deviations: [f64; 9],
    /// Root mean square of what is left, pixels, over all corners.
    pub rms: f64,
    /// Of each picture what is left of each corner, pixels, along columns and rows.
    pub residuals: Vec<Vec<[f64; 2]>>,
}

/// Why there is no lens.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LensError {
    /// Too few pictures.
    #[error("{0} pictures show the board: take ten or more, tilted in all directions, all over the picture")]
    Few(usize),
    /// All boards lie parallel to the picture.
    #[error("the pictures do not tell the focal length: tilt the board by 20 to 40 degrees in different directions")]
    Flat,
    /// The refinement did not end at a lens.
    #[error("no lens explains the pictures: is the board flat, and are `--columns`, `--rows` and `--square` its own?")]
    NoFit,
}

/// Fewer pictures leave too much open.
const FEWEST: usize = 3;

/// The lens of a camera with `size` pixels from the corners of `board` in several pictures.
///
/// # Errors
/// When the pictures do not tell it.
pub fn fit_lens(
    board: &Board,
    size: [u32; 2],
    pictures: &[Vec<[f64; 2]>],
    model: LensModel,
) -> Result<FittedLens, LensError> {
    if pictures.len() < FEWEST {
        return Err(LensError::Few(pictures.len()));
    }
    let plane = board.corners();
    let centre = [0.5 * f64::from(size[0]) - 0.5, 0.5 * f64::from(size[1]) - 0.5];
    let maps: Vec<Matrix3<f64>> = pictures
        .iter()
        .map(|corners| {
            let centred: Vec<[f64; 2]> = corners.iter().map(|[u, v]| [u - centre[0], v - centre[1]]).collect();
            homography::fit(&plane, &centred).ok_or(LensError::NoFit)
        })
        .collect::<Result<_, _>>()?;
    let focal = focal_length(&maps).ok_or(LensError::Flat)?;
    let mut start = vec![focal, focal, centre[0], centre[1], 0.0, 0.0, 0.0, 0.0];
    start.extend((model == LensModel::ThreeRadial).then_some(0.0));
    let shared = start.len();
    for map in &maps {
        start.extend(placed(map, focal));
    }
    let problem = Boards { plane: &plane, pictures, shared };
    let solution = solve(&problem, start).ok_or(LensError::NoFit)?;
    let lens = Lens { width: size[0], height: size[1], ..lens_of(&solution.parameters[..shared]) };
    lens.validate().map_err(|_| LensError::NoFit)?;
    let mut deviations = [0.0; 9];
    deviations[..shared].copy_from_slice(&solution.deviations);
    let pairs: Vec<[f64; 2]> = solution.residuals.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    let total: f64 = pairs.iter().map(|[u, v]| u * u + v * v).sum();
    let residuals = pairs.chunks(plane.len()).map(<[_]>::to_vec).collect();
    Ok(FittedLens { lens, deviations, rms: libm::sqrt(total / pairs.len() as f64), residuals })
}

/// What the squares of the tilts' sines must be on average to tell the focal length: 6 degrees.
const TILTED: f64 = 0.01;

/// The focal length, pixels, that makes the boards' axes perpendicular and equally long; None where nothing is tilted.
fn focal_length(maps: &[Matrix3<f64>]) -> Option<f64> {
    let (mut top, mut bottom) = (0.0, 0.0);
    for map in maps {
        let map = map / map.column(0).norm();
        let (h1, h2) = (map.column(0), map.column(1));
        // a / f^2 + b = 0, twice.
        let perpendicular = (h1.x * h2.x + h1.y * h2.y, h1.z * h2.z);
        let equal = (h1.x * h1.x + h1.y * h1.y - h2.x * h2.x - h2.y * h2.y, h1.z * h1.z - h2.z * h2.z);
        for (a, b) in [perpendicular, equal] {
            (top, bottom) = (top - a * b, bottom + a * a);
        }
    }
    let inverse = top / bottom;
    // Boards that all face the camera leave both equations empty: a is the square of a tilt's sine.
    let is_tilted = bottom > TILTED * TILTED * maps.len() as f64;
    (inverse > 0.0 && is_tilted).then(|| libm::sqrt(1.0 / inverse)).filter(|focal| focal.is_finite())
}

/// Rotation and position of a board in the camera's frame, from its homography.
fn placed(map: &Matrix3<f64>, focal: f64) -> [f64; 6] {
    let ray = |column: usize| Vector3::new(map[(0, column)] / focal, map[(1, column)] / focal, map[(2, column)]);
    let (first, second, origin) = (ray(0), ray(1), ray(2));
    let scale = 0.5 * (first.norm() + second.norm());
    // The board is in front of the camera.
    let scale = if origin.z < 0.0 { -scale } else { scale };
    let [rx, ry, rz] = rotation::vector(first / scale, second / scale);
    let place = origin / scale;
    [rx, ry, rz, place.x, place.y, place.z]
}

fn lens_of(shared: &[f64]) -> Lens {
    let distortion = PlumbBob {
        k1: shared[4],
        k2: shared[5],
        p1: shared[6],
        p2: shared[7],
        k3: shared.get(8).copied().unwrap_or(0.0),
    };
    Lens { width: 1, height: 1, fx: shared[0], fy: shared[1], cx: shared[2], cy: shared[3], distortion }
}

struct Boards<'a> {
    plane: &'a [[f64; 2]],
    pictures: &'a [Vec<[f64; 2]>],
    shared: usize,
}

impl Model for Boards<'_> {
    fn parts(&self) -> usize {
        self.pictures.len()
    }

    fn shared(&self) -> usize {
        self.shared
    }

    fn own(&self) -> usize {
        6
    }

    fn residuals_of(&self, part: usize) -> usize {
        2 * self.pictures[part].len()
    }

    fn residuals(&self, part: usize, shared: &[f64], own: &[f64], into: &mut [f64]) -> bool {
        let lens = lens_of(shared);
        let turn = rotation::matrix([own[0], own[1], own[2]]);
        let place = Vector3::new(own[3], own[4], own[5]);
        let corners = self.plane.iter().zip(&self.pictures[part]);
        for ((corner, seen), residual) in corners.zip(into.chunks_exact_mut(2)) {
            let point = turn * Vector3::new(corner[0], corner[1], 0.0) + place;
            // Not `Lens::pixel`: on the way lenses may fold where no board is.
            let ray = lens.distortion.distort(Point2::new(point.x / point.z, point.y / point.z));
            residual[0] = lens.fx * ray.x + lens.cx - seen[0];
            residual[1] = lens.fy * ray.y + lens.cy - seen[1];
        }
        into.iter().all(|residual| residual.is_finite())
    }
}
