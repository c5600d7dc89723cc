//! The localizer's parameters.

use crate::track::{self, Motion, Names, Robot};
use crate::vision::{Colour, ColourLimits};
use trench_config::{ConfigError, ParameterDescriptor as P, Parameters};
use trench_core::Files;
use trench_optics::{Overhead, Pad, Pose2};

/// What the discs come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Input {
    /// Frames on /overhead/image_raw.
    Image,
    /// Frames on /overhead/image_raw/compressed.
    Compressed,
    /// Discs on /overhead/detections.
    Detections,
    /// Poses, with or without names, on /overhead/pads.
    Pads,
}

/// What is on the robots' backs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pattern {
    /// A yellow disc in front, a blue one behind: all robots look alike.
    Discs,
    /// The Small Size League's, with a middle of this colour: codes name the robots.
    Coded(Colour),
}

/// What a detector's centres of discs are taken to be off by, m: 0.0185 pixel of the test bed's camera, as the own one's.
const DETECTED_SIGMA: f64 = 6e-5;
/// What makes coded pads that are found here off by 0.1 mm and 0.002 rad, m.
const CODED_SIGMA: f64 = 1.5e-4;
/// What makes another system's pads off by 1.3 mm and 0.03 rad, m: the Small Size League's cameras.
const PADS_SIGMA: f64 = 1.8e-3;

/// What the localizer is told once.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    pub(crate) cameras: Vec<Overhead>,
    /// Frames whose stamps differ by less are of one exposure, s.
    pub(crate) together: f64,
    pub(crate) input: Input,
    pub(crate) pattern: Pattern,
    pub(crate) noise_seed: u64,
    /// So many equal frames in a row are a frozen camera.
    pub(crate) frozen: u32,
    /// Of each robot, ordered by name, the code of its pad.
    pub(crate) pad_ids: Vec<i64>,
    pub(crate) team: track::Settings,
    pub(crate) colours: ColourLimits,
    /// The camera whose colours these are, by its lens file; empty: any.
    pub(crate) colours_of: String,
}

pub(crate) fn descriptors() -> Vec<P> {
    let (colours, motion) = (ColourLimits::default(), Motion::default());
    vec![
        P::string_list("robots", &[], "names of the robots that carry pads").read_only(),
        P::double_list(
            "initial_poses",
            &[],
            "m, m, rad: x, y, theta of each robot at the start, in the order of `robots`; empty: see `names`",
        )
        .read_only(),
        P::integer_list("pad_ids", &[], "codes of the pads on /overhead/pads, or of the Small Size League's patterns, in the order of `robots`; empty: 1, 2, 3 and so on")
            .range(0.0, 65_535.0)
            .read_only(),
        P::string("camera_info_file", "", "lens file in ROS's camera_info format (config/cameras); {camera} in it stands for the name of one of several").read_only(),
        P::string("mount_file", "", "where the camera hangs, or where several do (config/cameras)").read_only(),
        P::double("cameras.together", 0.002, "s, frames of several cameras whose stamps differ by less are one exposure")
            .range(0.0, 0.1)
            .read_only(),
        P::string(
            "input",
            "image",
            "image: find discs in /overhead/image_raw; compressed: in /overhead/image_raw/compressed (PNG or JPEG); \
             detections: take /overhead/detections; pads: take /overhead/pads",
        )
        .read_only(),
        P::string(
            "pad.pattern",
            "discs",
            "discs: a yellow disc in front, a blue one behind; ssl_yellow, ssl_blue: the Small Size League's, with this colour in the middle, \
             whose codes name the robots (pad_ids)",
        )
        .read_only(),
        P::double("pad.disc_diameter", Pad::NOMINAL.disc_diameter, "m, of each disc").range(0.005, 1.0).read_only(),
        P::double("pad.disc_spacing", Pad::NOMINAL.disc_spacing, "m, between the discs' centres")
            .range(0.005, 1.0)
            .read_only(),
        P::double("pad.height", Pad::NOMINAL.height, "m, the discs above the floor").range(0.0, 2.0).read_only(),
        P::double("body.diameter", Pad::NOMINAL.body_diameter, "m, two robots are never nearer than this")
            .range(0.005, 2.0)
            .read_only(),
        P::double("pad.tolerance", 0.005, "m, how far a pair of discs may be from the pad's spacing").range(1e-4, 0.1),
        P::string("colour.camera", "", "the camera whose colours these are, by its lens file; empty: any"),
        P::double("colour.yellow", colours.yellow_ratio, "least (R + G - 2 B) / (R + G + B) of yellow")
            .range(0.05, 2.0),
        P::double("colour.blue", colours.blue_ratio, "least (2 B - R - G) / (R + G + B) of blue").range(0.05, 2.0),
        P::double("colour.minimum", colours.minimum, "of 510, least absolute difference of either").range(5.0, 510.0),
        P::integer("frozen_frames", 3, "so many equal frames in a row after a first are a frozen camera; 0: never")
            .range(0.0, 1000.0),
        P::double("hold", 0.5, "s, how long an unseen robot is carried forward before it is lost").range(0.0, 10.0),
        P::double(
            "disc_sigma",
            0.0,
            "m, standard deviation of a disc's measured centre; 0: 5e-5 for discs found here, 6e-5 for detections, 1.8e-3 for pads",
        )
        .range(0.0, 0.1),
        P::string(
            "names",
            "turns",
            "how doubts about who is who end; turns: by small turns of one robot after the other; told: by ~/name_robots; \
             order: at the start names go by x, later doubts end by ~/name_robots",
        ),
        P::double("motion.acceleration", motion.acceleration, "m/s/sqrt(s), how freely forward speeds change")
            .range(1e-3, 100.0),
        P::double("motion.turning", motion.turning, "rad/s/sqrt(s), how freely turning speeds change").range(1e-3, 1e3),
        P::double("motion.slip", motion.slip, "m/sqrt(s), sideways slip").range(0.0, 1.0),
        P::double_list(
            "added_noise.sigma",
            &[0.0, 0.0, 0.0],
            "m, m, rad: noise added to measured poses; [0.00046, 0.00049, 0.0122] is that of 4.5.3",
        )
        .range(0.0, 1.0),
        P::integer("added_noise.seed", 1, "of the added noise").read_only(),
    ]
}

impl Settings {
    pub(crate) fn load(parameters: &Parameters, files: &dyn Files) -> Result<Self, ConfigError> {
        let text = |key: &str| -> Result<(String, String), ConfigError> {
            let path = parameters.str(key)?;
            if path.is_empty() {
                return Err(parameters.error(key, "is missing", "name a file, for example one of config/cameras"));
            }
            Ok((path.to_owned(), files.read(key, path)?))
        };
        let (mount_file, mounts) = text("mount_file")?;
        let lens_file = parameters.str("camera_info_file")?;
        if lens_file.is_empty() {
            return Err(parameters.error(
                "camera_info_file",
                "is missing",
                "name a file, for example one of config/cameras",
            ));
        }
        let read = |path: &str| files.read("camera_info_file", path);
        let cameras = Overhead::all(lens_file, (&mount_file, &mounts), read)?;

        let pad = Pad {
            disc_diameter: parameters.f64("pad.disc_diameter")?,
            disc_spacing: parameters.f64("pad.disc_spacing")?,
            height: parameters.f64("pad.height")?,
            body_diameter: parameters.f64("body.diameter")?,
        };
        let lowest = cameras.iter().map(|view| view.camera.mount().height).fold(f64::INFINITY, f64::min);
        if pad.height >= lowest {
            return Err(parameters.error("pad.height", "is above the camera", format!("below {lowest} m")));
        }
        let input = match parameters.str("input")? {
            "image" => Input::Image,
            "compressed" => Input::Compressed,
            "detections" => Input::Detections,
            "pads" => Input::Pads,
            _ => {
                return Err(parameters.error(
                    "input",
                    "is not an input",
                    "write image, compressed, detections or pads",
                ));
            }
        };
        let pattern = pattern(parameters, input, cameras.len())?;
        let mut settings = Self {
            cameras,
            pattern,
            together: parameters.f64("cameras.together")?,
            input,
            noise_seed: parameters.i64("added_noise.seed")? as u64,
            frozen: 0,
            pad_ids: pad_ids(parameters)?,
            team: track::Settings { pad, ..track::Settings::new(robots(parameters)?) },
            colours: ColourLimits::default(),
            colours_of: String::new(),
        };
        settings.tune(parameters)?;
        Ok(settings)
    }

    /// Takes what may change while the node runs; on an error nothing changes.
    pub(crate) fn tune(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        let colours_of = parameters.str("colour.camera")?;
        if let Some(other) = foreign(colours_of, &self.cameras) {
            let problem = format!("these are not the colours of the camera {other}");
            return Err(parameters.error("colour.camera", problem, "learn them by `trench calibrate colours`"));
        }
        let colours = ColourLimits {
            yellow_ratio: parameters.f64("colour.yellow")?,
            blue_ratio: parameters.f64("colour.blue")?,
            minimum: parameters.f64("colour.minimum")?,
        };
        let frozen = u32::try_from(parameters.i64("frozen_frames")?).unwrap_or(0);
        let team = track::Settings {
            spacing_tolerance: parameters.f64("pad.tolerance")?,
            disc_sigma: match parameters.f64("disc_sigma")? {
                known if known > 0.0 => known,
                _ if self.input == Input::Detections => DETECTED_SIGMA,
                _ if self.input == Input::Pads => PADS_SIGMA,
                _ if self.pattern != Pattern::Discs => CODED_SIGMA,
                _ => track::Settings::FOUND_SIGMA,
            },
            added_sigma: parameters.f64_array("added_noise.sigma")?,
            hold: parameters.f64("hold")?,
            motion: Motion {
                acceleration: parameters.f64("motion.acceleration")?,
                turning: parameters.f64("motion.turning")?,
                slip: parameters.f64("motion.slip")?,
            },
            names: match parameters.str("names")? {
                "turns" => Names::Turns,
                "told" => Names::Told,
                "order" => Names::Order,
                _ => return Err(parameters.error("names", "is no way to names", "write turns, told or order")),
            },
            ..self.team.clone()
        };
        (self.colours, self.team, self.frozen) = (colours, team, frozen);
        self.colours_of = colours_of.to_owned();
        Ok(())
    }
}

fn pattern(parameters: &Parameters, input: Input, cameras: usize) -> Result<Pattern, ConfigError> {
    let pattern = match parameters.str("pad.pattern")? {
        "discs" => return Ok(Pattern::Discs),
        "ssl_yellow" => Pattern::Coded(Colour::Yellow),
        "ssl_blue" => Pattern::Coded(Colour::Blue),
        _ => return Err(parameters.error("pad.pattern", "is no pattern", "write discs, ssl_yellow or ssl_blue")),
    };
    match input {
        Input::Image | Input::Compressed if cameras == 1 => Ok(pattern),
        Input::Image | Input::Compressed => Err(parameters.error(
            "pad.pattern",
            "codes are read below one camera alone",
            "write discs, or mount one camera",
        )),
        Input::Detections | Input::Pads => {
            Err(parameters.error("pad.pattern", "codes are read in images", "write discs, or the input image"))
        }
    }
}

/// The codes of the robots' pads, ordered by the robots' names.
fn pad_ids(parameters: &Parameters) -> Result<Vec<i64>, ConfigError> {
    let (names, ids) = (parameters.str_list("robots")?, parameters.i64_list("pad_ids")?);
    if !ids.is_empty() && ids.len() != names.len() {
        let problem = format!("has {} codes for {} robots", ids.len(), names.len());
        return Err(parameters.error("pad_ids", problem, "write one for each, or nothing"));
    }
    let mut coded: Vec<(&String, i64)> = names
        .iter()
        .enumerate()
        .map(|(index, name)| (name, ids.get(index).copied().unwrap_or(index as i64 + 1)))
        .collect();
    coded.sort();
    Ok(coded.into_iter().map(|(_, id)| id).collect())
}

/// The robots with their start poses, ordered by name.
fn robots(parameters: &Parameters) -> Result<Vec<Robot>, ConfigError> {
    let (names, poses) = (parameters.some_names("robots")?, parameters.f64_list("initial_poses")?);
    if !poses.is_empty() && poses.len() != 3 * names.len() {
        let problem = format!("has {} numbers for {} robots", poses.len(), names.len());
        return Err(parameters.error("initial_poses", problem, "write x, y and theta of each, or nothing"));
    }
    let mut robots: Vec<Robot> = Vec::with_capacity(names.len());
    for (index, name) in names.iter().enumerate() {
        let start = match poses.get(3 * index..3 * index + 3) {
            Some(&[x, y, theta]) => Some(Pose2 { x, y, theta: track::wrap(theta) }),
            _ => None,
        };
        robots.push(Robot { name: name.clone(), start });
    }
    robots.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(robots)
}

/// The camera whose colours these are not, as far as their file says whose they are.
pub(crate) fn foreign<'a>(colours_of: &str, cameras: &'a [Overhead]) -> Option<&'a str> {
    let other = cameras.iter().find(|view| !colours_of.is_empty() && view.lens_name != colours_of);
    other.map(|view| view.lens_name.as_str())
}
