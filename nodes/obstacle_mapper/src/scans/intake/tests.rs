use super::*;
use trench_formation::hull::Shape;

fn settings() -> ScanSettings {
    ScanSettings { body_radius: 0.08, laser: Pose2::default(), tolerance: 0.05, gap: 0.15, longest: 1.2, memory: 1.0 }
}

fn scan(ranges: &[f32]) -> LaserScan {
    LaserScan {
        angle_min: -(TAU as f32) / 4.0,
        angle_increment: TAU as f32 / 4.0,
        range_min: 0.1,
        range_max: 3.0,
        ranges: ranges.to_vec(),
        ..LaserScan::default()
    }
}

#[test]
fn points_are_where_rays_end_but_for_bodies_and_what_is_known() {
    let robot = Pose2 { x: 1.0, y: 1.0, theta: TAU / 4.0 };
    let measured = scan(&[0.5, 1.0, 2.0, f32::INFINITY]);
    let check = |bodies: &[Pose2], known: &[Known], expected: &[[f64; 2]]| {
        let mut points = Vec::new();
        locate(&measured, robot, bodies, known, &settings(), &mut points);
        assert_eq!(points.len(), expected.len(), "{points:?}");
        for (point, [x, y]) in points.iter().zip(expected) {
            assert!((point - Vector2::new(*x, *y)).norm() < 1e-6, "{points:?}");
        }
    };
    check(&[robot], &[], &[[1.5, 1.0], [1.0, 2.0], [-1.0, 1.0]]);
    let other = Pose2 { x: 1.0, y: 2.1, theta: 0.0 };
    check(&[robot, other], &[], &[[1.5, 1.0], [-1.0, 1.0]]);
    let shape = Shape::enclosing(&[Vector2::new(1.6, 1.0)], 0.06).unwrap();
    let known = Known { id: 1, shape, velocity: Vector2::zeros() };
    check(&[robot, other], &[known], &[[-1.0, 1.0]]);
}

#[test]
fn rays_say_what_is_free() {
    let rays: Vec<f32> = (0..8).map(|ray| if ray == 7 { 0.5 } else { f32::INFINITY }).collect();
    let mut circle = scan(&rays);
    circle.angle_increment = TAU as f32 / 8.0;
    let check = |scan: &LaserScan, expected: [bool; 4]| {
        let beams = locate(scan, Pose2::default(), &[], &[], &settings(), &mut Vec::new());
        // Angles between rays 0 and 1, 2 and 3, 6 and 7, 7 and 0; the first ray is that to the right.
        let free = [0.5, 2.5, 6.5, 7.5].map(|ray: f64| {
            let (sin, cos) = libm::sincos(-TAU / 4.0 + ray * TAU / 8.0);
            beams.pass(2.0 * Vector2::new(cos, sin), 0.1)
        });
        assert_eq!(free, expected);
        assert!(!beams.pass(Vector2::new(5.0, 0.0), 0.1), "farther than rays reach");
    };
    check(&circle, [true, true, false, false]);
    // The other way round: the same direction is that of ray 5.
    let mut clockwise = circle.clone();
    clockwise.angle_min = TAU as f32 / 4.0;
    clockwise.angle_increment *= -1.0;
    clockwise.ranges.swap(5, 7);
    check(&clockwise, [true, true, false, false]);
}

#[test]
fn senseless_scans_are_refused_and_senseless_ranges_passed_over() {
    let refused = |change: fn(&mut LaserScan)| {
        let mut scan = scan(&[1.0; 4]);
        change(&mut scan);
        check(&scan).is_err()
    };
    assert!(!refused(|_| ()));
    assert!(refused(|scan| scan.angle_min = f32::NAN));
    assert!(refused(|scan| scan.angle_increment = f32::INFINITY));
    assert!(refused(|scan| scan.angle_increment = 0.0));
    assert!(refused(|scan| scan.angle_increment = 3.0));
    assert!(refused(|scan| scan.range_min = -1.0));
    assert!(refused(|scan| scan.range_max = 0.05));
    assert!(refused(|scan| scan.range_max = f32::NAN));
    assert!(refused(|scan| scan.ranges = vec![1.0; 30_000]));
    let mut points = Vec::new();
    let odd = scan(&[f32::NAN, f32::NEG_INFINITY, -1.0, 50.0]);
    let beams = locate(&odd, Pose2::default(), &[], &[], &settings(), &mut points);
    assert_eq!((points.len(), &beams.free[..]), (0, &[0.0, 0.0, 0.0, 3.0][..]));
}
