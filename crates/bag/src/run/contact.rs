//! Contacts of bodies: what the test bed tells on /ground_truth/contacts.

use serde::Serialize;
use std::fmt::{self, Display};
use trench_msgs::diagnostic_msgs::DiagnosticStatus;

/// A robot's body began to touch something.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContactSample {
    /// s.
    pub time: f64,
    /// Its name.
    pub robot: String,
    /// What it touched: a robot's name, `obstacle 3`, `west edge`.
    pub thing: String,
    /// Where the robot was, m.
    pub position: [f64; 2],
}

impl ContactSample {
    /// Reads what the test bed says of one contact; the time is the array's. Nothing where something is missing.
    pub(super) fn read(status: &DiagnosticStatus) -> Option<Self> {
        let value = |key: &str| status.values.iter().find(|entry| entry.key == key).map(|entry| entry.value.as_str());
        let number = |key: &str| value(key)?.parse::<f64>().ok().filter(|number| number.is_finite());
        let position = [number("x")?, number("y")?];
        Some(Self { time: 0.0, robot: status.hardware_id.clone(), thing: value("thing")?.to_owned(), position })
    }
}

impl Display for ContactSample {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, robot, thing, position: [x, y] } = self;
        write!(out, "t = {time:.2} s: {robot} touched {thing} at ({x:.3}, {y:.3})")
    }
}
