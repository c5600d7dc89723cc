//! The target's way, where the operator leads it: a smooth curve through waypoints.

use trench_config::{ConfigError, Parameters};
use trench_core::RosTime;
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape};
use trench_msgs::nav_msgs::Odometry;

/// A way, and how fast it is gone: speed rises and falls by a bounded acceleration at its ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// None for a target that stays at its one waypoint.
    curve: Option<Curve>,
    start: Vector2<f64>,
    heading: f64,
    speed: f64,
    acceleration: f64,
}

impl Route {
    /// The way of the parameters `target.*`; none without waypoints.
    ///
    /// # Errors
    /// Coordinates that are no pairs, or waypoints no curve goes through.
    pub(crate) fn read(parameters: &Parameters) -> Result<Option<Self>, ConfigError> {
        let numbers = parameters.f64_list("target.waypoints")?;
        let error = |problem: String| {
            let remedy = "write x and y (m) of each waypoint in turn: [0.6, 1.4, 3.2, 1.4]";
            parameters.error("target.waypoints", problem, remedy)
        };
        if numbers.len() % 2 != 0 {
            return Err(error(format!("has {} numbers", numbers.len())));
        }
        let points: Vec<Vector2<f64>> = numbers.chunks_exact(2).map(|pair| Vector2::new(pair[0], pair[1])).collect();
        let shape = match points.as_slice() {
            [] | [_] => None,
            &[from, to] => Some(CurveShape::Line(from, to)),
            _ => Some(CurveShape::Spline(points.clone())),
        };
        let curve = shape.map(|shape| Curve::new(&shape, false, false)).transpose();
        let curve = curve.map_err(|problem| error(problem.to_string()))?;
        let Some(&start) = points.first() else { return Ok(None) };
        Ok(Some(Self {
            curve,
            start,
            heading: parameters.f64("target.heading")?,
            speed: parameters.f64("target.speed")?,
            acceleration: parameters.f64("target.acceleration")?,
        }))
    }

    /// Seconds from setting out to the end.
    #[must_use]
    pub fn duration(&self) -> f64 {
        let length = self.curve.as_ref().map_or(0.0, Curve::length);
        let ramp = self.speed * self.speed / self.acceleration;
        if length < ramp {
            2.0 * (length / self.acceleration).sqrt()
        } else {
            (length - ramp) / self.speed + 2.0 * self.speed / self.acceleration
        }
    }

    /// Way (m) and speed (m/s) `elapsed` seconds after setting out.
    fn progress(&self, elapsed: f64) -> (f64, f64) {
        let length = self.curve.as_ref().map_or(0.0, Curve::length);
        let duration = self.duration();
        let time = elapsed.clamp(0.0, duration);
        let top = self.speed.min((self.acceleration * length).sqrt());
        let ramp = top / self.acceleration;
        let left = duration - time;
        if time < ramp {
            (0.5 * self.acceleration * time * time, self.acceleration * time)
        } else if left < ramp {
            (length - 0.5 * self.acceleration * left * left, self.acceleration * left)
        } else {
            (top * (time - 0.5 * ramp), top)
        }
    }

    /// The target `elapsed` seconds after it set out, as it is told of at `stamp`.
    #[must_use]
    pub fn odometry(&self, elapsed: f64, stamp: RosTime) -> Odometry {
        let (way, speed) = self.progress(elapsed);
        let (point, heading, turn_rate) = match &self.curve {
            Some(curve) => {
                let foot = curve.at(way);
                (foot.point, libm::atan2(foot.tangent.y, foot.tangent.x), speed * foot.curvature)
            }
            None => (self.start, self.heading, 0.0),
        };
        let mut odometry = Odometry { child_frame_id: "target".to_owned(), ..Odometry::default() };
        odometry.header.stamp = stamp.into();
        odometry.header.frame_id = "map".to_owned();
        (odometry.pose.pose.position.x, odometry.pose.pose.position.y) = (point.x, point.y);
        let (sin, cos) = libm::sincos(0.5 * heading);
        (odometry.pose.pose.orientation.z, odometry.pose.pose.orientation.w) = (sin, cos);
        (odometry.twist.twist.linear.x, odometry.twist.twist.angular.z) = (speed, turn_rate);
        odometry
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_config::params::{Source, resolve};

    fn route(waypoints: &str) -> Result<Option<Route>, String> {
        let sources = [("target.waypoints", waypoints), ("robots", "[robot1]")];
        let sources = sources.map(|(name, value)| Source::Override { node: None, name, value });
        let parameters = resolve(&sources, "/", "operator", &crate::settings::descriptors()).unwrap();
        Route::read(&parameters).map_err(|error| error.to_string())
    }

    #[test]
    fn moves_as_its_positions_say_and_rests_at_the_end() {
        let route = route("[0.0, 0.0, 1.0, 0.2, 2.0, 0.0]").unwrap().unwrap();
        let at = |time: f64| {
            let odometry = route.odometry(time, RosTime(0));
            let position = odometry.pose.pose.position;
            (Vector2::new(position.x, position.y), odometry.twist.twist.linear.x, odometry)
        };
        for tenth in 1..(10.0 * route.duration()) as u32 {
            let (time, step) = (0.1 * f64::from(tenth), 1e-4);
            let speed = (at(time + step).0 - at(time - step).0).norm() / (2.0 * step);
            assert!((speed - at(time).1).abs() < 1e-3, "at {time}: {speed}");
        }
        let (end, speed, odometry) = at(route.duration() + 5.0);
        assert!((end - Vector2::new(2.0, 0.0)).norm() < 1e-6 && speed == 0.0);
        assert!(odometry.pose.pose.orientation.z < 0.0, "it looks along its way");
    }

    #[test]
    fn waypoints_that_are_no_way() {
        assert_eq!(route("[]").unwrap(), None);
        assert!(route("[1.0, 2.0, 3.0]").unwrap_err().contains("has 3 numbers"));
        assert!(route("[1.0, 1.0, 1.0, 1.0]").is_err());
        assert_eq!(route("[1.0, 2.0]").unwrap().unwrap().duration(), 0.0);
    }
}
