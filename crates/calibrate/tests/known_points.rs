//! The camera's place from known points, and the point that is wrong.

#![expect(clippy::unwrap_used, reason = "a test may panic, its helpers too")]

use nalgebra::Point3;
use trench_calibrate::{FieldError, KnownPoint, field_picture, field_text, fit_field, read_points};
use trench_optics::{Camera, CameraInfo, Lens, Mount, Pixel};
use trench_sim::Random;

const TRUTH: Mount = Mount { x: 1.25, y: 0.90, height: 2.96, roll: 0.021, pitch: -0.017, yaw: 0.012 };

fn lens() -> Lens {
    CameraInfo::parse("overhead.yaml", include_str!("../../../config/cameras/overhead.yaml")).unwrap().lens
}

/// Points all over the field, seen with errors of 0.2 pixel and put down with errors of 0.5 mm.
fn points(count: usize, seed: u64, height: impl Fn(usize) -> Option<f64>) -> Vec<KnownPoint> {
    let camera = Camera::new(lens(), TRUTH).unwrap();
    let mut random = Random::new(seed, 3);
    let mut normal = |sigma: f64| sigma * ((0..12).map(|_| random.between(0.0, 1.0)).sum::<f64>() - 6.0);
    (0..count)
        .map(|index| {
            let (column, row) = ((index % 3) as f64, (index / 3) as f64);
            let (x, y) = (0.25 + column + normal(0.05), 0.25 + 0.45 * row + normal(0.05));
            let seen = camera.project(Point3::new(x, y, height(index).unwrap_or(0.1))).unwrap();
            let pixel = Pixel { u: seen.u + normal(0.2), v: seen.v + normal(0.2) };
            let name = format!("point {}", index + 1);
            KnownPoint { name, pixel, x: x + normal(5e-4), y: y + normal(5e-4), height: height(index) }
        })
        .collect()
}

#[test]
fn the_cameras_place_and_tilt_are_found() {
    let field = fit_field(&lens(), &points(12, 1, |_| Some(0.0)), &Mount::nominal()).unwrap();
    let off = [field.mount.x - TRUTH.x, field.mount.y - TRUTH.y, field.mount.height - TRUTH.height];
    assert!(off.iter().all(|off| off.abs() < 0.01), "{:?}", field.mount);
    assert!((field.mount.roll - TRUTH.roll).abs() < 3e-3 && (field.mount.yaw - TRUTH.yaw).abs() < 2e-3);
    assert!(field.rms < 2e-3 && field.bad.is_none(), "{}", field_text(&field));
}

#[test]
fn the_height_of_pads_is_found_from_robots_at_known_places() {
    let on_pads = |index: usize| if index < 6 { Some(0.0) } else { None };
    let field = fit_field(&lens(), &points(12, 2, on_pads), &Mount::nominal()).unwrap();
    let height = field.pad_height.unwrap();
    assert!((height - 0.1).abs() < 0.01, "{height}");
}

#[test]
fn a_point_that_is_off_by_thirty_millimetres_is_named_a_hundred_times_of_a_hundred() {
    let (mut named, mut quiet) = (0, 0);
    for seed in 0..100 {
        let good = points(9, seed, |_| Some(0.0));
        quiet += usize::from(fit_field(&lens(), &good, &Mount::nominal()).unwrap().bad.is_none());
        let mut bad = good;
        let index = (seed % 9) as usize;
        let (sin, cos) = (0.7 * seed as f64).sin_cos();
        (bad[index].x, bad[index].y) = (bad[index].x + 0.03 * cos, bad[index].y + 0.03 * sin);
        let field = fit_field(&lens(), &bad, &Mount::nominal()).unwrap();
        named += usize::from(field.bad.as_deref() == Some(bad[index].name.as_str()));
    }
    assert_eq!((named, quiet), (100, 100));
}

#[test]
fn the_report_names_it_in_words_and_in_the_picture() {
    let mut bad = points(9, 4, |_| Some(0.0));
    bad[4].x += 0.03;
    let field = fit_field(&lens(), &bad, &Mount::nominal()).unwrap();
    assert!(field_text(&field).contains("point 5 does not agree with the others"), "{}", field_text(&field));
    assert_eq!(field_picture(&field, &bad, [768, 576]).matches("#b2182b").count(), 2);
}

#[test]
fn bad_points_are_refused_with_the_reason() {
    let good = points(9, 5, |_| Some(0.0));
    let check = |change: &dyn Fn(&mut Vec<KnownPoint>), expected: FieldError| {
        let mut points = good.clone();
        change(&mut points);
        assert_eq!(fit_field(&lens(), &points, &Mount::nominal()), Err(expected));
    };
    check(&|points| points.truncate(3), FieldError::Few { given: 3, needed: 4 });
    check(&|points| points.retain(|point| point.y < 0.5), FieldError::Few { given: 3, needed: 4 });
    check(&|points| points.iter_mut().for_each(|point| point.y = 0.5 * point.x), FieldError::Collinear);
    check(&|points| points[2].pixel.u = f64::NAN, FieldError::Outside("point 3".to_owned()));
    check(&|points| points[2].pixel.u = 900.0, FieldError::Outside("point 3".to_owned()));
    check(&|points| points[2].x = f64::INFINITY, FieldError::Outside("point 3".to_owned()));
}

#[test]
fn files_of_points_are_read_and_errors_name_the_line() {
    let text = "points:\n- {name: corner, pixel: [31.5, 540.2], map: [0.1, 0.1]}\n- {pixel: [1, 2], map: [1.2, 0.9], pad: true}\n";
    let points = read_points("points.yaml", text).unwrap();
    assert_eq!((points[0].name.as_str(), points[0].height), ("corner", Some(0.0)));
    assert_eq!((points[1].name.as_str(), points[1].height), ("point 2", None));
    let error = read_points("points.yaml", &text.replace("[1, 2]", "[1]")).unwrap_err().to_string();
    assert!(error.starts_with("points.yaml:3: points[1].pixel"), "{error}");
}
