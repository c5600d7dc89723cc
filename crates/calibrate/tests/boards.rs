//! Lenses from rendered boards, held as a person holds them.

#![expect(clippy::unwrap_used, reason = "a test may panic, its helpers too")]

use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};
use trench_calibrate::{Board, CornerError, LensError, LensModel, Picture, find_corners, fit_lens};
use trench_optics::{Lens, Pixel, PlumbBob};
use trench_sim::Random;
use trench_sim::camera::{HeldBoard, render_board};

const BOARD: Board = Board { columns: 9, rows: 6, square: 0.06 };

fn lens() -> Lens {
    let distortion = PlumbBob { k1: -0.12, k2: 0.02, p1: 5e-4, p2: -4e-4, k3: 0.0 };
    Lens { cx: 380.1, cy: 290.7, distortion, ..Lens::nominal() }
}

/// A board somewhere in the picture, tilted by up to `tilt` (rad) about both axes.
fn held(random: &mut Random, tilt: f64) -> Isometry3<f64> {
    let turn = Rotation3::from_euler_angles(
        random.between(-tilt, tilt),
        random.between(-tilt, tilt),
        random.between(-0.5, 0.5),
    );
    let place = Vector3::new(random.between(-0.22, 0.22), random.between(-0.15, 0.15), random.between(0.9, 1.4));
    let middle = Vector3::new(3.5 * BOARD.square, 2.5 * BOARD.square, 0.0);
    let turn = UnitQuaternion::from_rotation_matrix(&turn);
    Isometry3::from_parts(Translation3::from(place - turn * middle), turn)
}

fn picture(lens: &Lens, camera_from_board: Isometry3<f64>, noise: f64, seed: u64) -> Picture {
    let Board { columns, rows, square } = BOARD;
    let pixels = render_board(lens, &HeldBoard { columns, rows, square, camera_from_board }, noise, seed);
    Picture::new(lens.width as usize, lens.height as usize, pixels).unwrap()
}

/// The corners of boards that are seen whole.
fn pictures(lens: &Lens, tilt: f64, count: usize, seed: u64) -> Vec<Vec<[f64; 2]>> {
    let mut random = Random::new(seed, 7);
    let mut found = Vec::new();
    while found.len() < count {
        let pose = held(&mut random, tilt);
        let margin = |corner: [f64; 2]| {
            let point = pose * nalgebra::Point3::new(corner[0], corner[1], 0.0);
            lens.pixel(nalgebra::Point2::new(point.x / point.z, point.y / point.z)).unwrap()
        };
        if BOARD.corners().into_iter().map(margin).all(|pixel| lens.contains(pixel, 15.0)) {
            found.push(find_corners(&picture(lens, pose, 3.0, found.len() as u64), &BOARD).unwrap());
        }
    }
    found
}

#[test]
fn a_lens_is_found_to_a_fifth_of_a_pixel() {
    let lens = lens();
    let fitted =
        fit_lens(&BOARD, [lens.width, lens.height], &pictures(&lens, 0.6, 14, 1), LensModel::TwoRadial).unwrap();
    println!("residual {:.4} px, {:?}", fitted.rms, fitted.lens);
    assert!(fitted.rms < 0.2, "{}", fitted.rms);
    // What counts is where pixels look: all over the picture, 3 m away, in the middle of what scatters.
    for (u, v) in [(20.0, 20.0), (384.0, 288.0), (740.0, 30.0), (30.0, 550.0), (740.0, 550.0)] {
        let (found, truth) = (fitted.lens.ray(Pixel { u, v }).unwrap(), lens.ray(Pixel { u, v }).unwrap());
        let off = lens.fx * (found - truth).norm();
        assert!(off < 1.5, "({u}, {v}): {off} px");
    }
    for (value, truth, deviation) in [
        (fitted.lens.fx, lens.fx, fitted.deviations[0]),
        (fitted.lens.fy, lens.fy, fitted.deviations[1]),
        (fitted.lens.cx, lens.cx, fitted.deviations[2]),
        (fitted.lens.distortion.k1, lens.distortion.k1, fitted.deviations[4]),
    ] {
        assert!((value - truth).abs() < 8.0 * deviation, "{value} instead of {truth} +- {deviation}");
    }
}

#[test]
fn corners_are_where_they_are() {
    let lens = lens();
    let mut random = Random::new(5, 7);
    let (mut sum2, mut count) = (0.0, 0.0);
    for seed in 0..6 {
        let pose = held(&mut random, 0.3);
        let Ok(found) = find_corners(&picture(&lens, pose, 3.0, seed), &BOARD) else { continue };
        let truth: Vec<[f64; 2]> = BOARD
            .corners()
            .into_iter()
            .map(|corner| {
                let point = pose * nalgebra::Point3::new(corner[0], corner[1], 0.0);
                let pixel = lens.pixel(nalgebra::Point2::new(point.x / point.z, point.y / point.z)).unwrap();
                [pixel.u, pixel.v]
            })
            .collect();
        // A board looks the same turned by half a circle but for its colours.
        let off = |turned: bool| {
            let order: Vec<&[f64; 2]> = if turned { found.iter().rev().collect() } else { found.iter().collect() };
            order.iter().zip(&truth).map(|(a, b)| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sum::<f64>()
        };
        (sum2, count) = (sum2 + off(false).min(off(true)), count + truth.len() as f64);
    }
    let rms = (sum2 / f64::max(count, 1.0)).sqrt();
    println!("{count} corners: {rms:.4} px");
    assert!(count >= 120.0 && rms < 0.15, "{count} corners: {rms} px");
}

#[test]
fn what_is_no_board_is_told() {
    let grey = Picture::new(768, 576, vec![128; 768 * 576]).unwrap();
    assert_eq!(find_corners(&grey, &BOARD), Err(CornerError::Few { found: 0, expected: 40 }));
    let mut random = Random::new(1, 7);
    let seen = picture(&lens(), held(&mut random, 0.2), 3.0, 1);
    let other = Board { columns: 8, rows: 6, ..BOARD };
    assert_eq!(find_corners(&seen, &other), Err(CornerError::Other([7, 5])));
    assert_eq!(Picture::new(768, 576, vec![0; 10]), None);
    let corners = pictures(&lens(), 0.6, 2, 3);
    assert_eq!(fit_lens(&BOARD, [768, 576], &corners, LensModel::TwoRadial), Err(LensError::Few(2)));
}
