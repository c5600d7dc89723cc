//! Ways out of local minima (7.6, 7.7), as the running controller takes them.

use crate::bench::{Bench, formation, make};
use trench_formation::Vector2;
use trench_formation::hull::Outline;
use trench_formation::kinematics::Pose;
use trench_msgs::msg::{ApparentObstacle, ApparentObstacleArray, Obstacle, Point2};

/// m, from the segment: the law brings the steered point there, 0.05 m in front of the axle.
const SETTLED: f64 = 0.06;

fn corners(points: &[[f64; 2]]) -> Vec<Point2> {
    points.iter().map(|[x, y]| Point2 { x: *x, y: *y }).collect()
}

fn bench(overrides: &[(&str, &str)], pose: Pose, obstacles: ApparentObstacleArray) -> Bench {
    let all = [&[("law", "nearest"), ("team", "[robot1, robot2]")], overrides].concat();
    let mut bench = Bench::of(make(&all).unwrap());
    formation(&mut bench);
    (bench.pose, bench.obstacles) = (pose, obstacles);
    bench
}

/// A wall between the robot and its segment y = 0.9, parallel to it: the nearest point moves along with the robot.
pub(crate) fn wall() -> ApparentObstacleArray {
    let hull = [[0.7, 1.2], [1.3, 1.2], [1.3, 1.3], [0.7, 1.3]];
    ApparentObstacleArray {
        obstacles: vec![ApparentObstacle { id: 3, hull: corners(&hull), members: vec![3], ..Default::default() }],
        members: vec![Obstacle { id: 3, polygon: corners(&hull), ..Default::default() }],
        ..Default::default()
    }
}

#[test]
fn a_guard_leads_round_a_wall_that_catches_robots() {
    let ends_at = |remedies: &str| {
        let alone = [("safety.enabled", "false"), ("remedies.enabled", remedies), ("remedies.sidesteps", "false")];
        let mut bench = bench(&alone, Pose::new(0.95, 1.6, -1.57), wall());
        bench.drive(1500);
        bench.pose.y
    };
    let caught = ends_at("false");
    assert!(caught > 1.4, "{caught}");
    let free = ends_at("true");
    assert!((free - 0.9).abs() < SETTLED, "{free}");
}

/// Two walls whose hull has closed around the robot.
#[test]
fn a_robot_in_a_combined_hull_is_led_out_between_its_members() {
    let walls = [[[0.6, 1.25], [1.2, 1.25]], [[0.6, 1.7], [1.2, 1.7]]];
    let hull = [walls[0][0], walls[0][1], walls[1][1], walls[1][0]];
    let member =
        |(id, wall): (u32, &[[f64; 2]; 2])| Obstacle { id, polygon: corners(wall), radius: 0.02, ..Default::default() };
    let apparent =
        ApparentObstacle { id: 1, hull: corners(&hull), radius: 0.02, members: vec![1, 2], ..Default::default() };
    let obstacles = ApparentObstacleArray {
        obstacles: vec![apparent],
        members: (1..).zip(&walls).map(member).collect(),
        ..Default::default()
    };
    let mut bench = bench(&[], Pose::new(0.85, 1.475, 0.0), obstacles);
    let mut least = f64::INFINITY;
    for _ in 0..1500 {
        bench.drive(1);
        for wall in walls {
            let points = wall.map(Vector2::from);
            least = least.min(Outline { points: &points, radius: 0.02 }.approach(bench.pose.position()).gap);
        }
    }
    assert!((bench.pose.y - 0.9).abs() < SETTLED, "{:?}", bench.pose);
    assert!(least > 0.08, "the body touched a wall: {least}");
}
