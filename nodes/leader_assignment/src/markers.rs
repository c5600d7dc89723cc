//! The formation as RViz2 and Foxglove draw it: segments, vertices, goal points, an arrow from each robot to the one ahead
//! of it in the chain.

use crate::Carrier;
use trench_formation::Vector2;
use trench_msgs::builtin_interfaces::Time;
use trench_msgs::geometry_msgs::{Point, Vector3};
use trench_msgs::msg::{Assignment, Goals, TeamState};
use trench_msgs::std_msgs::ColorRGBA;
use trench_msgs::visualization_msgs::Marker;
use trench_plan::{Plan, sampled};

/// What a viewer shows of a node that has ended goes away after this, s.
const LIFETIME: f64 = 1.0;
/// How far the open end of a queue is drawn, m.
const EXTENSION: f64 = 0.5;
/// Thickness of drawn lines, m.
const LINE: f64 = 0.01;
/// Diameter of a drawn point, m.
const POINT: f64 = 0.03;

const GREY: ColorRGBA = ColorRGBA { r: 0.45, g: 0.45, b: 0.5, a: 0.9 };
const DARK: ColorRGBA = ColorRGBA { r: 0.15, g: 0.15, b: 0.2, a: 0.9 };
const BLUE: ColorRGBA = ColorRGBA { r: 0.1, g: 0.45, b: 0.8, a: 0.9 };
const ORANGE: ColorRGBA = ColorRGBA { r: 0.85, g: 0.5, b: 0.1, a: 0.8 };

/// Balls of the size of a drawn point.
const BALL: Vector3 = Vector3 { x: POINT, y: POINT, z: POINT };
/// Of a line only the width counts.
const WIDTH: Vector3 = Vector3 { x: LINE, y: 0.0, z: 0.0 };
/// Of an arrow: shaft, head's width, head's length.
const ARROW: Vector3 = Vector3 { x: LINE, y: 4.0 * LINE, z: 5.0 * LINE };

/// The segments and vertices of `plan`, whose frame is where `carrier` says.
pub(crate) fn of_plan(stamp: Time, plan: &Plan, carrier: &Carrier) -> Vec<Marker> {
    let carried = |points: &[Vector2<f64>]| points.iter().map(|point| level(carrier.to_map(*point))).collect();
    let both = plan.queues.iter().enumerate().flat_map(|(index, queue)| {
        let segment = carried(&sampled(&queue.shape, &queue.curve, EXTENSION));
        [
            marker(stamp, "segments", index, (Marker::LINE_STRIP, WIDTH, GREY), segment),
            marker(stamp, "vertices", index, (Marker::SPHERE_LIST, BALL, DARK), carried(&queue.vertices)),
        ]
    });
    both.collect()
}

/// The goal points, in the map.
pub(crate) fn of_goals(stamp: Time, goals: &Goals) -> Marker {
    let points = goals.goals.iter().map(|goal| level(Vector2::new(goal.position.x, goal.position.y)));
    marker(stamp, "goals", 0, (Marker::SPHERE_LIST, BALL, BLUE), points.collect())
}

/// An arrow from each follower to its leader.
pub(crate) fn of_chains(stamp: Time, team: &TeamState, assignment: &Assignment) -> Vec<Marker> {
    let place = |name: &str| {
        let robot = team.robots.iter().find(|robot| robot.name == name)?;
        Some(level(Vector2::new(robot.x, robot.y)))
    };
    let pairs =
        assignment.members.iter().filter_map(|member| Some(vec![place(&member.robot)?, place(&member.leader)?]));
    pairs
        .enumerate()
        .map(|(index, ends)| marker(stamp, "leaders", index, (Marker::ARROW, ARROW, ORANGE), ends))
        .collect()
}

fn marker(stamp: Time, part: &str, id: usize, look: (i32, Vector3, ColorRGBA), points: Vec<Point>) -> Marker {
    let (kind, scale, color) = look;
    let begun = trench_core::marker(stamp, format!("formation/{part}"), id as i32, kind, color, LIFETIME);
    Marker { scale, points, ..begun }
}

fn level(point: Vector2<f64>) -> Point {
    Point { x: point.x, y: point.y, z: 0.0 }
}
