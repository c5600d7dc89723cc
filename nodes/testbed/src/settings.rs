//! The test bed's parameters.

use crate::poses::poses;
use crate::{faults, obstacles, radio};
use trench_config::{ConfigError, ParameterDescriptor as P, Parameters};
use trench_core::Files;
use trench_optics::{Camera, Overhead, Pad};
use trench_radio::{Key, MAX_ROBOTS};
use trench_sim::camera::{Appearance, BALANCED_FOR, Background};
use trench_sim::{BedSetup, Body, Faults, Field, Laser, Motor, Shutter};

/// What the test bed is told. All of it is fixed while it runs.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    pub(crate) robots: Vec<String>,
    pub(crate) bed: BedSetup,
    pub(crate) link: String,
    pub(crate) cameras: Vec<Overhead>,
    pub(crate) pad: Pad,
    pub(crate) appearance: Appearance,
    pub(crate) render: bool,
    pub(crate) detection_noise: f64,
    pub(crate) publish_clock: bool,
    /// Whether somebody is told of obstacles: of those of a file, though there be none in it.
    pub(crate) publish_obstacles: bool,
}

pub(crate) fn descriptors() -> Vec<P> {
    let parameters = vec![
        P::string_list("robots", &[], "the robots' names"),
        P::integer_list("ids", &[], "their radio ids; empty: 1, 2, 3 and so on").range(0.0, MAX_ROBOTS as f64 - 1.0),
        P::double_list("poses", &[], "m and rad, x, y and heading of each robot in turn; empty: at random"),
        P::double("random.gap", 0.1, "m, between bodies, obstacles and edge where poses are random").range(0.0, 1.0),
        P::integer("seed", 1, "all chance comes from it"),
        P::double("field.width", 2.48, "m, along x").range(0.2, 100.0),
        P::double("field.height", 1.83, "m, along y").range(0.2, 100.0),
        P::string("plant", "honest", "honest: stepper motors with pull-in speed and ramp; ideal: they follow at once"),
        P::double("body.radius", 0.08, "m, of the robots").range(0.01, 1.0),
        P::double("body.half_axle", 0.06, "m, wheel to the middle of the axle").range(0.001, 1.0),
        P::double("radio.delay_min", 0.003, "s, shortest time of a packet in the air").range(0.0, 1.0),
        P::double("radio.delay_max", 0.008, "s, longest").range(0.0, 1.0),
        P::double("radio.loss", 0.03, "share of the packets that a receiver misses").range(0.0, 1.0),
        P::double_list("radio.antenna", &[0.0, 0.0], "m, where the base station's antenna is"),
        P::double("radio.reach.down", 0.0, "m, how far robots hear the base station; 0: everywhere").range(0.0, 1e4),
        P::double("radio.reach.up", 0.0, "m, how far the base station hears robots; 0: everywhere").range(0.0, 1e4),
        P::double("radio.reach.robots", 0.0, "m, how far robots hear one another; 0: everywhere").range(0.0, 1e4),
        P::double("radio.bursts.every", 0.0, "s, mean time between bursts of interference; 0: none").range(0.0, 1e6),
        P::double("radio.bursts.length", 0.5, "s, mean length of a burst, in which nobody hears anybody")
            .range(0.0, 1e4),
        P::string(
            "key_file",
            "",
            "file with the robots' key, 32 hexadecimal digits, mode 0600; empty: robots obey anyone",
        ),
        P::string("serial.link", "", "where the link to the base station's pseudo-terminal is made"),
        P::integer("serial.baud", 115_200, "bit/s at which the line is paced").range(1200.0, 4_000_000.0),
        P::double("camera.rate", 30.0, "frames a second").range(1.0, 100.0),
        P::double("camera.exposure", 0.01, "s, for which a frame gathers light").range(0.0, 0.1),
        P::double("camera.delay", 0.035, "s, from the middle of the exposure to the frame").range(0.0, 0.2),
        P::string(
            "camera.info_file",
            "",
            "camera_info YAML of the lens, {camera} in it stands for a name; empty: nominal",
        ),
        P::string(
            "camera.mount_file",
            "",
            "where the camera hangs, or where several do; empty: above the view's middle",
        ),
        P::bool("render", true, "publish images; false: the discs that a detector would find"),
        P::string("image.background", "plain", "plain, noisy or wood"),
        P::double("image.noise", 4.0, "of 255, standard deviation of each channel of each pixel").range(0.0, 64.0),
        P::double("image.brightness", 1.0, "the light where it is brightest, of nominal").range(0.05, 10.0),
        P::double("image.temperature", BALANCED_FOR, "K, colour temperature of the light").range(1500.0, 20_000.0),
        P::double("image.gradient", 0.3, "how much darker the darkest corner is").range(0.0, 1.0),
        P::double(
            "detections.noise",
            0.0185,
            "pixel, standard deviation of each disc's u and v; as of the own detector",
        )
        .range(0.0, 10.0),
        P::double("pad.disc_diameter", Pad::NOMINAL.disc_diameter, "m, of each disc").range(0.005, 1.0),
        P::double("pad.disc_spacing", Pad::NOMINAL.disc_spacing, "m, between the discs' centres").range(0.005, 1.0),
        P::double("pad.height", Pad::NOMINAL.height, "m, above the floor").range(0.0, 1.0),
        P::string("obstacles_file", "", "YAML list of obstacles; empty: none"),
        P::bool("publish_obstacles", true, "tell of them on /obstacles; false: lasers must find them"),
        P::string("faults_file", "", "YAML list of what goes wrong, and when; empty: nothing"),
        P::string_list("laser.robots", &[], "names of the robots that carry a laser"),
        P::double("laser.rate", 10.0, "scans a second").range(0.1, 100.0),
        P::double("laser.range_min", 0.1, "m, what is nearer is not measured").range(0.0, 100.0),
        P::double("laser.range_max", 3.5, "m, what is farther is not seen").range(0.01, 100.0),
        P::double("laser.field_of_view", std::f64::consts::TAU, "rad, half of it to either side of the front")
            .range(0.0, std::f64::consts::TAU),
        P::integer("laser.rays", 180, "a scan").range(1.0, 10_000.0),
        P::double("laser.noise", 0.01, "m, standard deviation of a range").range(0.0, 1.0),
        P::bool("publish_clock", false, "publish /clock"),
    ];
    parameters.into_iter().map(P::read_only).collect()
}

impl Settings {
    pub(crate) fn read(parameters: &Parameters, files: &dyn Files) -> Result<Self, ConfigError> {
        let link = parameters.str("serial.link")?.to_owned();
        if link.is_empty() {
            let remedy = "write a path that does not exist yet; the bridge's serial.port is the same";
            return Err(parameters.error("serial.link", "the pseudo-terminal has no place", remedy));
        }
        let double = |name: &str| parameters.f64(name);
        let pad = Pad {
            disc_diameter: double("pad.disc_diameter")?,
            disc_spacing: double("pad.disc_spacing")?,
            height: double("pad.height")?,
            body_diameter: 2.0 * double("body.radius")?,
        };
        Ok(Self {
            robots: parameters.str_list("robots")?.to_vec(),
            bed: bed(parameters, files)?,
            link,
            cameras: cameras(parameters, files)?,
            pad,
            appearance: appearance(parameters)?,
            render: parameters.bool("render")?,
            detection_noise: double("detections.noise")?,
            publish_clock: parameters.bool("publish_clock")?,
            publish_obstacles: parameters.bool("publish_obstacles")? && !parameters.str("obstacles_file")?.is_empty(),
        })
    }
}

fn bed(parameters: &Parameters, files: &dyn Files) -> Result<BedSetup, ConfigError> {
    let double = |name: &str| parameters.f64(name);
    let seed = parameters.i64("seed")? as u64;
    let motor = match parameters.str("plant")? {
        "honest" => Motor::HONEST,
        "ideal" => Motor::Ideal,
        _ => return Err(parameters.error("plant", "is no plant", "write honest or ideal")),
    };
    let body = Body { radius: double("body.radius")?, half_axle: double("body.half_axle")?, motor };
    let field = Field { width: double("field.width")?, height: double("field.height")? };
    let obstacles = match parameters.str("obstacles_file")? {
        "" => Vec::new(),
        path => obstacles::parse(path, &files.read("obstacles_file", path)?)?,
    };
    let key = match parameters.str("key_file")? {
        "" => None,
        path => {
            let key = Key::from_hex(&files.read_secret("key_file", path)?);
            Some(key.map_err(|error| parameters.error("key_file", error.to_string(), "write such a file"))?)
        }
    };
    let faults = match parameters.str("faults_file")? {
        "" => Faults::default(),
        path => faults::parse(path, &files.read("faults_file", path)?, parameters.str_list("robots")?)?,
    };
    let poses = poses(parameters, field, body, &obstacles, seed)?;
    let medium = radio::medium(parameters)?;
    let nanoseconds = |seconds: f64| (seconds * 1e9) as u64;
    Ok(BedSetup {
        start: 0,
        seed,
        robots: ids(parameters)?.into_iter().zip(poses).collect(),
        body,
        field,
        obstacles,
        medium,
        shutter: Shutter {
            period: nanoseconds(1.0 / double("camera.rate")?),
            exposure: nanoseconds(double("camera.exposure")?),
            delay: nanoseconds(double("camera.delay")?),
        },
        lasers: lasers(parameters)?,
        laser: laser(parameters)?,
        baud: u32::try_from(parameters.usize("serial.baud")?).unwrap_or(u32::MAX),
        key,
        nonces: seed,
        faults,
    })
}

/// Scans are at whole milliseconds, where the world is exact.
fn laser(parameters: &Parameters) -> Result<Laser, ConfigError> {
    let rate = parameters.f64("laser.rate")?;
    let laser = Laser {
        period: ((1e3 / rate).round().max(1.0) as u64).saturating_mul(1_000_000),
        range_min: parameters.f64("laser.range_min")?,
        range_max: parameters.f64("laser.range_max")?,
        field_of_view: parameters.f64("laser.field_of_view")?,
        rays: parameters.usize("laser.rays")?,
        noise: parameters.f64("laser.noise")?,
    };
    if laser.range_max <= laser.range_min {
        let remedy = format!("write more than {}", laser.range_min);
        return Err(parameters.error("laser.range_max", "is not beyond laser.range_min", remedy));
    }
    Ok(laser)
}

/// Indices of the robots with lasers.
fn lasers(parameters: &Parameters) -> Result<Vec<usize>, ConfigError> {
    let (robots, names) = (parameters.str_list("robots")?, parameters.names("laser.robots")?);
    let index = |name: &String| {
        robots.iter().position(|robot| robot == name).ok_or_else(|| {
            let problem = format!("{name} is no robot");
            parameters.error("laser.robots", problem, format!("write some of {}", robots.join(", ")))
        })
    };
    names.iter().map(index).collect()
}

/// The robots' ids, each once, as many as names.
fn ids(parameters: &Parameters) -> Result<Vec<u8>, ConfigError> {
    let (names, ids) = (parameters.names("robots")?, parameters.i64_list("ids")?);
    if names.len() >= MAX_ROBOTS {
        let problem = format!("a base station has room for {}", MAX_ROBOTS - 1);
        return Err(parameters.error("robots", problem, "take fewer robots"));
    }
    if ids.is_empty() {
        return Ok((1..=names.len() as u8).collect());
    }
    if ids.len() != names.len() {
        let problem = format!("has {} ids for {} robots", ids.len(), names.len());
        return Err(parameters.error("ids", problem, "write one id a robot"));
    }
    if let Some(twice) = ids.iter().enumerate().find(|(index, id)| ids[..*index].contains(id)) {
        return Err(parameters.error("ids", format!("{} is there twice", twice.1), "give each robot its own id"));
    }
    Ok(ids.iter().map(|id| *id as u8).collect())
}

fn cameras(parameters: &Parameters, files: &dyn Files) -> Result<Vec<Overhead>, ConfigError> {
    match [parameters.str("camera.info_file")?, parameters.str("camera.mount_file")?] {
        ["", ""] => Ok(vec![Overhead { name: None, camera: Camera::nominal(), lens_name: "overhead".to_owned() }]),
        ["", _] => Err(parameters.error("camera.info_file", "is missing", "name the lens of the camera on this mount")),
        [_, ""] => Err(parameters.error("camera.mount_file", "is missing", "say where the camera of this lens hangs")),
        [lens, mount] => {
            let mounts = files.read("camera.mount_file", mount)?;
            Overhead::all(lens, (mount, &mounts), |path| files.read("camera.info_file", path))
        }
    }
}

fn appearance(parameters: &Parameters) -> Result<Appearance, ConfigError> {
    let plain = Appearance::default();
    let background = match parameters.str("image.background")? {
        "plain" => plain.background,
        "noisy" => Background::Noisy([150, 150, 145], 0.1),
        "wood" => Background::Wood,
        _ => return Err(parameters.error("image.background", "is no background", "write plain, noisy or wood")),
    };
    Ok(Appearance {
        background,
        noise: parameters.f64("image.noise")?,
        brightness: parameters.f64("image.brightness")?,
        temperature: parameters.f64("image.temperature")?,
        gradient: parameters.f64("image.gradient")?,
        seed: parameters.i64("seed")? as u64,
        ..plain
    })
}
