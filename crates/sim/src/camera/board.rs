//! A chessboard held before a camera: what lens calibration is tested with.

use super::noise::SplitMix;
use nalgebra::{Isometry3, Vector3};
use trench_optics::{Lens, Pixel};

/// A board of `columns` times `rows` squares whose inner corners lie at `camera_from_board` times (i, j, 0) squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldBoard {
    /// Squares along the board's x.
    pub columns: usize,
    /// Squares along its y.
    pub rows: usize,
    /// Side of a square, m.
    pub square: f64,
    /// From the board's plane, its origin in the first inner corner, to the camera's frame.
    pub camera_from_board: Isometry3<f64>,
}

/// Rays a pixel along each axis.
const RAYS: usize = 4;
/// White around the board, in squares.
const BORDER: f64 = 1.0;

/// A grey picture of the board before a grey wall, with noise of `sigma` (of 255).
#[must_use]
pub fn render_board(lens: &Lens, board: &HeldBoard, sigma: f64, seed: u64) -> Vec<u8> {
    let mut random = SplitMix(seed);
    let board_from_camera = board.camera_from_board.inverse();
    let mut pixels = Vec::with_capacity(lens.width as usize * lens.height as usize);
    for v in 0..lens.height {
        for u in 0..lens.width {
            let at = |across: f64, down: f64| {
                let pixel = Pixel { u: f64::from(u) + across, v: f64::from(v) + down };
                shade(lens, board, &board_from_camera, pixel)
            };
            let corners = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)].map(|(across, down)| at(across, down));
            let within = |index: usize| (index as f64 + 0.5) / RAYS as f64 - 0.5;
            // Only pixels with an edge in them need many rays.
            let mean = if corners.iter().all(|corner| *corner == corners[0]) {
                corners[0]
            } else {
                (0..RAYS * RAYS).map(|ray| at(within(ray % RAYS), within(ray / RAYS))).sum::<f64>()
                    / (RAYS * RAYS) as f64
            };
            // Twelve uniform numbers have nearly a normal sum.
            let noise: f64 = (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
            pixels.push((mean + sigma * noise + 0.5) as u8);
        }
    }
    pixels
}

fn shade(lens: &Lens, board: &HeldBoard, board_from_camera: &Isometry3<f64>, pixel: Pixel) -> f64 {
    const WALL: f64 = 110.0;
    let Some(ray) = lens.ray(pixel) else { return WALL };
    let origin = board_from_camera.translation.vector;
    let along = board_from_camera.rotation * Vector3::new(ray.x, ray.y, 1.0);
    let reach = -origin.z / along.z;
    if !reach.is_finite() || reach <= 0.0 {
        return WALL;
    }
    // In squares from the board's own corner.
    let place = |axis: usize| (origin[axis] + reach * along[axis]) / board.square + 1.0;
    let (x, y) = (place(0), place(1));
    let inside = |value: f64, size: usize, border: f64| (-border..size as f64 + border).contains(&value);
    match () {
        () if inside(x, board.columns, 0.0) && inside(y, board.rows, 0.0) => {
            if (x as usize + y as usize).is_multiple_of(2) { 25.0 } else { 215.0 }
        }
        () if inside(x, board.columns, BORDER) && inside(y, board.rows, BORDER) => 215.0,
        () => WALL,
    }
}
