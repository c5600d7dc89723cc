//! The bridge's parameters.

use trench_config::{ConfigError, ParameterDescriptor as P, Parameters};
use trench_core::Files;
use trench_radio::{Key, MAX_RANGES, MAX_ROBOTS, WheelTimer};

/// What the bridge is told once.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    /// Names and radio ids.
    pub(crate) robots: Vec<(String, u8)>,
    pub(crate) port: String,
    pub(crate) baud: u32,
    pub(crate) key: Option<Key>,
    pub(crate) stamped: bool,
    pub(crate) ranges: usize,
    pub(crate) tuning: Tuning,
}

/// What may change while it runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tuning {
    pub(crate) half_axle: f64,
    pub(crate) max_wheel_speed: f64,
    pub(crate) max_v: f64,
    pub(crate) max_omega: f64,
    pub(crate) dither: bool,
    pub(crate) gather: f64,
    pub(crate) command_age: f64,
    pub(crate) frame_age: f64,
    pub(crate) information_age: f64,
    pub(crate) unstamped_age: f64,
    pub(crate) radio_delay: f64,
    pub(crate) heartbeat: f64,
    pub(crate) silence: f64,
    pub(crate) relays: bool,
    pub(crate) needs_run_state: bool,
}

pub(crate) fn descriptors() -> Vec<P> {
    vec![
        P::string_list("robots", &[], "the robots' names").read_only(),
        P::integer_list("ids", &[], "their radio ids in the same order; empty: 1, 2, 3 and so on")
            .range(0.0, MAX_ROBOTS as f64 - 1.0)
            .read_only(),
        P::string("serial.port", "", "device of the base station").read_only(),
        P::integer("serial.baud", 115_200, "bit/s of the serial line").range(1200.0, 4_000_000.0).read_only(),
        P::string(
            "key_file",
            "",
            "file with the robots' key, 32 hexadecimal digits, mode 0600; empty: packets carry no tag",
        )
        .read_only(),
        P::bool("stamped", true, "commands are geometry_msgs/TwistStamped; false: Twist").read_only(),
        P::integer("ranges", 4, "range sensors of a robot, counter-clockwise from the front")
            .range(0.0, MAX_RANGES as f64)
            .read_only(),
        P::double("body.half_axle", 0.06, "m, wheel to the middle of the axle").range(0.001, 1.0),
        P::double("wheels.max_speed", 0.2999, "m/s, faster commands are scaled down, their curvature kept")
            .range(0.001, WheelTimer::from_speed(1.0).speed()),
        P::double("limits.linear", 2.0, "m/s, a command beyond it is an error and dropped").range(0.0, 100.0),
        P::double("limits.angular", 20.0, "rad/s, a command beyond it is an error and dropped").range(0.0, 1000.0),
        P::bool("dither", true, "drive wheels below the motors' minimum speed part of the time"),
        P::double("gather", 0.002, "s, how long the first command of a camera frame waits for the others")
            .range(0.0, 0.05),
        P::double("age.command", 0.05, "s, from receipt to the serial port").range(0.001, 0.25),
        P::double("age.frame", 0.08, "s, how long a robot obeys a frame").range(0.001, 0.08),
        P::double("age.information", 0.25, "s, oldest exposure that may drive a robot").range(0.001, 0.25),
        P::double("age.unstamped", 0.12, "s, taken for the age of commands without stamp").range(0.0, 0.25),
        P::double("radio_delay", 0.008, "s, longest time in the air").range(0.0, 0.1),
        P::double("heartbeat", 0.1, "s, a frame goes out at least this often").range(0.01, 1.0),
        P::double("silence", 0.5, "s, silence after which a link is down, and a cmd_vel publisher has lost its robot")
            .range(0.01, 10.0),
        P::bool("relays", true, "robots pass packets on to those that do not hear the base station"),
        P::bool("needs_run_state", true, "stand still unless /run_state says running"),
    ]
}

impl Tuning {
    pub(crate) fn read(parameters: &Parameters) -> Result<Self, ConfigError> {
        let double = |name: &str| parameters.f64(name);
        Ok(Self {
            half_axle: double("body.half_axle")?,
            max_wheel_speed: double("wheels.max_speed")?,
            max_v: double("limits.linear")?,
            max_omega: double("limits.angular")?,
            dither: parameters.bool("dither")?,
            gather: double("gather")?,
            command_age: double("age.command")?,
            frame_age: double("age.frame")?,
            information_age: double("age.information")?,
            unstamped_age: double("age.unstamped")?,
            radio_delay: double("radio_delay")?,
            heartbeat: double("heartbeat")?,
            silence: double("silence")?,
            relays: parameters.bool("relays")?,
            needs_run_state: parameters.bool("needs_run_state")?,
        })
    }
}

impl Settings {
    pub(crate) fn read(parameters: &Parameters, files: &dyn Files) -> Result<Self, ConfigError> {
        let port = parameters.str("serial.port")?.to_owned();
        if port.is_empty() {
            let remedy = "write the device of the base station, for example /dev/ttyUSB0";
            return Err(parameters.error("serial.port", "there is no serial port", remedy));
        }
        let key = match parameters.str("key_file")? {
            "" => None,
            path => {
                let text = files.read_secret("key_file", path)?;
                let key = Key::from_hex(&text);
                Some(key.map_err(|error| parameters.error("key_file", error.to_string(), "write such a file"))?)
            }
        };
        Ok(Self {
            robots: robots(parameters)?,
            port,
            baud: u32::try_from(parameters.usize("serial.baud")?).unwrap_or(u32::MAX),
            key,
            stamped: parameters.bool("stamped")?,
            ranges: parameters.usize("ranges")?,
            tuning: Tuning::read(parameters)?,
        })
    }
}

/// Names and ids, each once.
fn robots(parameters: &Parameters) -> Result<Vec<(String, u8)>, ConfigError> {
    let (names, ids) = (parameters.some_names("robots")?, parameters.i64_list("ids")?);
    let given = || ids.iter().map(|id| *id as u8).collect();
    let ids: Vec<u8> = if ids.is_empty() { (1..=names.len().min(255) as u8).collect() } else { given() };
    if ids.len() != names.len() {
        let problem = format!("has {} ids for {} robots", ids.len(), names.len());
        return Err(parameters.error("ids", problem, "write one id a robot"));
    }
    for (index, (name, id)) in names.iter().zip(&ids).enumerate() {
        if ids[..index].contains(id) {
            return Err(parameters.error("ids", format!("{id} is there twice"), "give each robot its own id"));
        }
        if usize::from(*id) >= MAX_ROBOTS {
            let remedy = format!("use ids 0 to {}", MAX_ROBOTS - 1);
            return Err(parameters.error("robots", format!("{name} gets id {id}"), remedy));
        }
    }
    Ok(names.iter().cloned().zip(ids).collect())
}

/// The slowest speed that a wheel can turn at all the time, m/s.
pub(crate) fn slowest_speed() -> f64 {
    trench_radio::SPEED_TIMES_TIMER / f64::from(trench_radio::TIMER_SLOWEST)
}
