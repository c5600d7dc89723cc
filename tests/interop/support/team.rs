//! Reading messages that rclpy has decoded.

use serde_json::Value;

/// Wheel to the middle of the axle, m: turns a turning speed into that of a wheel.
const HALF_AXLE: f64 = 0.06;

/// A number at a path such as `/pose/pose/position/x`.
pub(crate) fn number(message: &Value, path: &str) -> f64 {
    let value = message.pointer(path).unwrap_or_else(|| panic!("no {path} in {message}"));
    value.as_f64().unwrap_or_else(|| panic!("{path} is {value}, no finite number"))
}

/// What a TeamState says.
#[derive(Debug)]
pub(crate) struct Moment {
    /// Exposure, ROS time in seconds.
    pub(crate) time: f64,
    /// x and y of each robot, m.
    pub(crate) places: Vec<[f64; 2]>,
    /// The speed of each robot's faster wheel, m/s.
    pub(crate) speeds: Vec<f64>,
}

impl Moment {
    pub(crate) fn of(team_state: &Value) -> Self {
        let robots = team_state["robots"].as_array().unwrap();
        let speed = |robot: &Value| number(robot, "/v").abs() + HALF_AXLE * number(robot, "/omega").abs();
        Self {
            time: stamp(team_state),
            places: robots.iter().map(|robot| [number(robot, "/x"), number(robot, "/y")]).collect(),
            speeds: robots.iter().map(speed).collect(),
        }
    }

    /// The speed of the fastest wheel of all, m/s.
    pub(crate) fn fastest(&self) -> f64 {
        self.speeds.iter().copied().fold(0.0, f64::max)
    }

    /// The speed of the slowest robot's faster wheel, m/s.
    pub(crate) fn slowest(&self) -> f64 {
        self.speeds.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// How far the robot that went furthest is from where it was `before`, m.
    pub(crate) fn moved_since(&self, before: &Self) -> f64 {
        let pairs = self.places.iter().zip(&before.places);
        pairs.map(|(now, then)| libm::hypot(now[0] - then[0], now[1] - then[1])).fold(0.0, f64::max)
    }
}

/// The stamp of a message's header, s.
pub(crate) fn stamp(message: &Value) -> f64 {
    number(message, "/header/stamp/sec") + 1e-9 * number(message, "/header/stamp/nanosec")
}
