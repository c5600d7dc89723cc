//! One scan: is it one, and where are the points that it measured?

use crate::settings::ScanSettings;
use crate::sources::Known;
use std::f64::consts::TAU;
use trench_formation::Vector2;
use trench_msgs::sensor_msgs::LaserScan;
use trench_optics::Pose2;

/// More rays than any scanner has.
const MOST_RAYS: usize = 20_000;

/// Checks what a scan says of itself.
///
/// # Errors
/// With what is wrong.
pub(crate) fn check(scan: &LaserScan) -> Result<(), String> {
    let LaserScan { angle_min, angle_increment, range_min, range_max, ranges, .. } = scan;
    if ranges.len() > MOST_RAYS {
        return Err(format!("it has {} rays, at most {MOST_RAYS} are taken", ranges.len()));
    }
    if !(angle_min.is_finite() && angle_increment.is_finite()) {
        return Err(format!("its angles begin at {angle_min} and grow by {angle_increment}"));
    }
    let span = f64::from(angle_increment.abs()) * ranges.len().saturating_sub(1) as f64;
    if span > TAU * 1.01 || (*angle_increment == 0.0 && ranges.len() > 1) {
        return Err(format!("its {} rays are {angle_increment} rad apart", ranges.len()));
    }
    if !(range_min.is_finite() && range_max.is_finite() && (0.0..*range_max).contains(range_min)) {
        return Err(format!("its limits are {range_min} m and {range_max} m"));
    }
    Ok(())
}

/// The rays of a scan, where they were.
#[derive(Debug, Clone)]
pub(crate) struct Beams {
    origin: Vector2<f64>,
    /// Of the first ray, in the map, rad.
    first: f64,
    increment: f64,
    /// How far each ray went without meeting anything, m; 0 where it says nothing.
    free: Vec<f64>,
}

impl Beams {
    /// Whether rays passed through `point` and well beyond, on both sides of it.
    pub(crate) fn pass(&self, point: Vector2<f64>, beyond: f64) -> bool {
        let offset = point - self.origin;
        let needed = offset.norm() + beyond;
        let turn = libm::atan2(offset.y, offset.x) - self.first;
        // Rays are counted the way they turn, from the first one.
        let turn = if self.increment < 0.0 { -turn } else { turn };
        let place = (turn - TAU * (turn / TAU).floor()) / self.increment.abs();
        let ray = place as usize;
        let goes_on = |ray: usize| self.free.get(ray).is_some_and(|free| *free > needed);
        // A whole circle goes on at its beginning.
        let next = if ray + 1 == self.free.len() && self.free.len() as f64 * self.increment.abs() > 0.99 * TAU {
            0
        } else {
            ray + 1
        };
        goes_on(ray) && goes_on(next)
    }
}

/// The points that a scan measured, in the map, but those on robots' `bodies` and on obstacles that are `known` anyway,
/// put into `points`; and the way its rays were free. `robot` is where the laser's robot was.
pub(crate) fn locate(
    scan: &LaserScan,
    robot: Pose2,
    bodies: &[Pose2],
    known: &[Known],
    settings: &ScanSettings,
    points: &mut Vec<Vector2<f64>>,
) -> Beams {
    let (sin, cos) = libm::sincos(robot.theta);
    let laser = settings.laser;
    let origin = Vector2::new(robot.x + cos * laser.x - sin * laser.y, robot.y + sin * laser.x + cos * laser.y);
    let (first, increment) = (robot.theta + laser.theta + f64::from(scan.angle_min), f64::from(scan.angle_increment));
    let (least, most) = (f64::from(scan.range_min), f64::from(scan.range_max));
    let body = settings.body_radius + settings.tolerance;
    let reach = |centre: Vector2<f64>, radius: f64| (centre - origin).norm() < most + radius;
    let bodies: Vec<Vector2<f64>> =
        bodies.iter().map(|pose| Vector2::new(pose.x, pose.y)).filter(|centre| reach(*centre, body)).collect();
    let known: Vec<Explained<'_>> = known
        .iter()
        .map(|known| Explained::new(known, settings.tolerance))
        .filter(|explained| reach(explained.centre, explained.radius))
        .collect();
    points.clear();
    let mut free = Vec::with_capacity(scan.ranges.len());
    for (ray, range) in scan.ranges.iter().enumerate() {
        let range = f64::from(*range);
        free.push(match range {
            // REP 117: nothing there.
            nothing if nothing == f64::INFINITY => most,
            measured if measured >= least => measured.min(most),
            _ => 0.0,
        });
        if !(range >= least && range <= most) {
            continue;
        }
        let (sin, cos) = libm::sincos(first + increment * ray as f64);
        let point = origin + range * Vector2::new(cos, sin);
        let on_body = bodies.iter().any(|centre| (centre - point).norm_squared() < body * body);
        if !on_body && !known.iter().any(|explained| explained.holds(point)) {
            points.push(point);
        }
    }
    Beams { origin, first, increment, free }
}

/// A known obstacle, with a circle around it: most points are far from most obstacles.
struct Explained<'a> {
    known: &'a Known,
    centre: Vector2<f64>,
    radius: f64,
    tolerance: f64,
}

impl<'a> Explained<'a> {
    fn new(known: &'a Known, tolerance: f64) -> Self {
        let outline = known.shape.outline();
        let centre = outline.points.iter().sum::<Vector2<f64>>() / outline.points.len().max(1) as f64;
        let reach = outline.points.iter().map(|point| (point - centre).norm()).fold(0.0, f64::max);
        Self { known, centre, radius: reach + outline.radius + tolerance, tolerance }
    }

    fn holds(&self, point: Vector2<f64>) -> bool {
        (point - self.centre).norm_squared() < self.radius * self.radius
            && self.known.shape.outline().approach(point).gap < self.tolerance
    }
}

#[cfg(test)]
mod tests;
