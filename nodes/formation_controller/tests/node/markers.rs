//! What the controller draws of its own (Figures 7.4 to 7.14): where it is, in scenes in which it matters.

use crate::bench::{Bench, formation, leader, make};
use crate::remedies::wall;
use trench_formation::Vector2;
use trench_formation::hull::Outline;
use trench_formation::kinematics::Pose;
use trench_msgs::geometry_msgs::Point;
use trench_msgs::visualization_msgs::{Marker, MarkerArray};

/// The body of a robot, and how far the obstacles of these tests repel, m.
const BODY: f64 = 0.08;
const CUT: f64 = 0.26;

fn bench(law: &str, pose: Pose) -> Bench {
    // A remedy by itself, as in the tests of remedies: the filter would lead the robot round before it is caught.
    let alone = [("safety.enabled", "false"), ("remedies.sidesteps", "false")];
    let overrides = [&[("law", law), ("team", "[robot1, robot2]"), ("encroaching", "robots")], &alone[..]].concat();
    let mut bench = Bench::of(make(&overrides).unwrap());
    formation(&mut bench);
    bench.pose = pose;
    bench
}

/// The newest picture's markers of a namespace.
fn drawn(bench: &Bench, part: &str) -> Vec<Marker> {
    let picture: MarkerArray = bench.out.last(bench.port("/markers")).unwrap();
    let namespace = format!("controller/{part}");
    picture.markers.into_iter().filter(|marker| marker.ns == namespace).collect()
}

fn extent(points: &[Point], axis: fn(&Point) -> f64) -> [f64; 2] {
    points.iter().map(axis).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
}

fn is_near(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6
}

/// Figs. 7.4 to 7.6: the leader stands on the segment at x = 1.4 and takes its body and the reach of its repulsion to both sides.
#[test]
fn the_robot_ahead_is_drawn_with_what_it_takes_of_the_segment() {
    let mut bench = bench("chain", Pose::new(0.8, 0.9, 0.0));
    leader(&mut bench);
    bench.drive(1);
    let hulls = drawn(&bench, "hulls");
    assert_eq!(hulls.len(), 1, "{hulls:?}");
    let radius = |point: &Point| libm::hypot(point.x - 1.4, point.y - 0.9);
    assert!(hulls[0].points.len() > 20 && hulls[0].points.iter().all(|point| (radius(point) - BODY).abs() < 1e-9));
    let encroached = drawn(&bench, "encroached");
    assert_eq!(encroached.len(), 1, "{encroached:?}");
    assert!(encroached[0].points.iter().all(|point| (point.y - 0.9).abs() < 1e-9));
    let taken = extent(&encroached[0].points, |point| point.x);
    assert!(is_near(taken, [1.4 - BODY - CUT, 1.4 + BODY + CUT]), "{taken:?}");
    let left: Vec<[f64; 2]> =
        drawn(&bench, "fragments").iter().map(|one| extent(&one.points, |point| point.x)).collect();
    assert!(left.len() == 2 && is_near(left[0], [0.0, taken[0]]) && is_near(left[1], [taken[1], 3.0]), "{left:?}");
    let nearest = &drawn(&bench, "nearest")[0].points;
    assert!(
        (nearest[0].x - 0.85).abs() < 1e-6 && nearest[1].y == 0.9,
        "from the steered point to the segment: {nearest:?}"
    );
}

/// Fig. 7.9, where obstacles repel and nowhere else: rectangles before the faces of the wall, sectors at its corners.
#[test]
fn the_repulsive_areas_are_drawn_of_what_repels() {
    let mut far = bench("nearest", Pose::new(1.0, 1.7, -1.57));
    far.obstacles = wall();
    far.drive(1);
    assert_eq!(drawn(&far, "sectors"), []);
    let mut near = bench("nearest", Pose::new(1.0, 1.5, -1.57));
    near.obstacles = wall();
    near.drive(1);
    let sectors = drawn(&near, "sectors");
    assert_eq!((sectors.len(), sectors[0].r#type), (1, Marker::LINE_LIST));
    let points = &sectors[0].points;
    let hull = [[0.7, 1.2], [1.3, 1.2], [1.3, 1.3], [0.7, 1.3]].map(Vector2::from);
    let outline = Outline { points: &hull, radius: 0.0 };
    let gap = |point: &Point| outline.approach(Vector2::new(point.x, point.y)).gap;
    assert!(points.iter().all(|point| (-1e-9..CUT + 1e-9).contains(&gap(point))), "{points:?}");
    let reach = [extent(points, |point| point.x), extent(points, |point| point.y)];
    assert!(is_near(reach[0], [0.7 - CUT, 1.3 + CUT]) && is_near(reach[1], [1.2 - CUT, 1.3 + CUT]), "{reach:?}");
    let piece = |a: [f64; 2], b: [f64; 2]| {
        let at = |point: &Point, place: [f64; 2]| is_near([point.x, point.y], place);
        points.chunks(2).any(|pair| (at(&pair[0], a) && at(&pair[1], b)) || (at(&pair[0], b) && at(&pair[1], a)))
    };
    assert!(piece([0.7, 1.3], [0.7, 1.3 + CUT]) && piece([1.3, 1.3], [1.3 + CUT, 1.3]), "between face and corner");
    assert!(piece([0.7, 1.3 + CUT], [1.3, 1.3 + CUT]), "across the face");
}

/// Fig. 7.11: a robot that a wall has caught raises a guard, which bulges towards it before the wall.
#[test]
fn the_guard_of_a_robot_that_is_caught_is_drawn() {
    let mut bench = bench("nearest", Pose::new(0.95, 1.6, -1.57));
    bench.obstacles = wall();
    bench.drive(10);
    assert_eq!(drawn(&bench, "remedy"), [], "it is not caught yet");
    let guard = (0..60).find_map(|_| {
        bench.drive(10);
        drawn(&bench, "remedy").pop()
    });
    let guard = guard.unwrap();
    assert_eq!(guard.r#type, Marker::LINE_STRIP);
    let ([left, right], [low, high]) = (extent(&guard.points, |point| point.x), extent(&guard.points, |point| point.y));
    assert!(right - left > 0.8 * 0.6 && (left + right - 2.0).abs() < 0.1, "before the wall: {left} to {right}");
    assert!(low > 1.2 && high > 1.3, "on the robot's side: {low} to {high}");
}
