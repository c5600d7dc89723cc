//! The mapper's parameters.

use trench_config::{ConfigError, ParameterDescriptor as P, Parameters};
use trench_optics::Pose2;

/// What the mapper is told.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    /// Whose scans are heard.
    pub(crate) robots: Vec<String>,
    pub(crate) clearance: f64,
    /// Between two messages, s.
    pub(crate) period: f64,
    pub(crate) scans: ScanSettings,
    /// How many publishers of /obstacles must be heard, or robots rest.
    pub(crate) sources: usize,
    /// The longest silence of a publisher that counts as heard, s.
    pub(crate) source_age: f64,
    /// The longest silence of the laser of a robot that moves, s; 0: no silence is too long.
    pub(crate) scan_age: f64,
}

/// Lasers that turn slower than this, s, are none: a shorter silence is between two scans.
const SHORTEST_SILENCE: f64 = 0.1;

/// How scans become obstacles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ScanSettings {
    /// Of all robots, m.
    pub(crate) body_radius: f64,
    /// Of the laser on its robot.
    pub(crate) laser: Pose2,
    /// How far a measured point may be from what it belongs to, m.
    pub(crate) tolerance: f64,
    /// Points nearer than this are one boundary, m.
    pub(crate) gap: f64,
    /// A boundary longer than this is a wall, m.
    pub(crate) longest: f64,
    /// How long a point is kept after it was last seen, s.
    pub(crate) memory: f64,
}

pub(crate) fn descriptors() -> Vec<P> {
    vec![
        P::double("clearance", 0.2, "m, hulls nearer to each other than this are combined").range(0.0, 100.0),
        P::double("rate", 20.0, "1/s, at which /apparent_obstacles is sent").range(10.0, 100.0),
        P::string_list("robots", &[], "names of the robots whose lasers are heard, on <r>/scan").read_only(),
        P::double("body.radius", 0.08, "m, of the robots: what lasers see of them is no obstacle").range(0.0, 2.0),
        P::double_list("laser.pose", &[0.0, 0.0, 0.0], "m, m, rad: x, y and heading of the laser on its robot")
            .range(-10.0, 10.0),
        P::double(
            "scan.tolerance",
            0.05,
            "m, how far a measured point may be from the robot or obstacle it belongs to",
        )
        .range(0.0, 1.0),
        P::double("scan.gap", 0.15, "m, measured points nearer to each other than this are one boundary")
            .range(0.01, 10.0),
        P::double(
            "scan.longest",
            1.2,
            "m, a boundary longer than this is a wall: its pieces are not combined to one hull",
        )
        .range(0.1, 1000.0),
        P::double("scan.memory", 3.0, "s, how long what no laser sees any more is kept").range(0.1, 3600.0),
        P::integer(
            "sources",
            0,
            "publishers of /obstacles that must be heard, or nothing is published and robots rest",
        )
        .range(0.0, 100.0),
        P::double("age.sources", 0.5, "s, silence after which a publisher of /obstacles is not heard").range(0.1, 60.0),
        P::double("age.scan", 0.5, "s, silence of a moving robot's laser after which nothing is published; 0: never")
            .range(0.0, 60.0),
    ]
}

impl Settings {
    pub(crate) fn read(parameters: &Parameters) -> Result<Self, ConfigError> {
        let robots = parameters.names("robots")?.to_vec();
        let [x, y, theta] = parameters.f64_array("laser.pose")?;
        Ok(Self {
            robots,
            clearance: parameters.f64("clearance")?,
            period: 1.0 / parameters.f64("rate")?,
            scans: ScanSettings {
                body_radius: parameters.f64("body.radius")?,
                laser: Pose2 { x, y, theta },
                tolerance: parameters.f64("scan.tolerance")?,
                gap: parameters.f64("scan.gap")?,
                longest: parameters.f64("scan.longest")?,
                memory: parameters.f64("scan.memory")?,
            },
            sources: parameters.usize("sources")?,
            source_age: parameters.f64("age.sources")?,
            scan_age: scan_age(parameters)?,
        })
    }
}

/// Silence must be noticed while there still is what the laser saw.
fn scan_age(parameters: &Parameters) -> Result<f64, ConfigError> {
    let (age, memory) = (parameters.f64("age.scan")?, parameters.f64("scan.memory")?);
    if age > 0.0 && age < SHORTEST_SILENCE {
        let remedy = format!("write {SHORTEST_SILENCE} or more, or 0 for never");
        return Err(parameters.error("age.scan", "is shorter than from one scan to the next", remedy));
    }
    if age > memory {
        let problem = format!("is longer than scan.memory = {memory}: what a silent laser saw is forgotten before");
        return Err(parameters.error("age.scan", problem, format!("write at most {memory}")));
    }
    Ok(age)
}
