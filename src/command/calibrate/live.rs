//! `trench calibrate live`: the camera's picture on a page, what the limits of the colours cover on it, and clicks that teach them.

mod bench;
mod eye;
mod lessons;
mod node;
mod page;
mod shot;
mod table;

use super::apply;
use super::error::{CalibrateError, read};
use crate::command::web::{Address, BindError};
use bench::{Bench, Names};
use eye::Eye;
use node::Ears;
use std::path::PathBuf;
use std::process::ExitCode;
use table::Table;
use trench_calibrate::Colours;
use trench_config::ConfigError;
use trench_harness::vision::{ColourLimits, Expectation};
use trench_optics::{Overhead, Pad};

const COMMAND: &str = "trench calibrate live";
/// What those may do who reach an address that is not this host's own.
const OPEN: &str = "sees the picture and may change the colours";

/// Shows the camera's picture on a page in the browser, and on it what each colour's limits cover, as the localizer sees it.
///
/// A click on a disc teaches its colour. Saves the colour file; a running localizer takes it over at once. Serves one page on
/// this host alone and prints its address.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The lens file: the colours are for its camera.
    #[arg(long, default_value = "lens.yaml")]
    lens: PathBuf,
    /// The mount file: how large a disc is.
    #[arg(long, default_value = "mount.yaml")]
    mount: PathBuf,
    /// Which camera of the mount file, where it places several.
    #[arg(long)]
    camera: Option<String>,
    /// Diameter of a disc, m.
    #[arg(long, value_name = "METRES", default_value_t = Pad::NOMINAL.disc_diameter)]
    disc: f64,
    /// Listens to /overhead/image_raw/compressed instead of /overhead/image_raw.
    #[arg(long)]
    compressed: bool,
    /// The parameter file for the localizer; its limits are the first ones, if it is there.
    #[arg(long, default_value = "colours.yaml")]
    out: PathBuf,
    /// The full name of the localizer that takes the colours over.
    #[arg(long, default_value = "/overhead_localizer")]
    localizer: String,
    #[command(flatten)]
    address: Address,
    /// Further arguments of the node, for example `--ros-args -r /overhead/image_raw:=/camera/image_raw`.
    #[arg(last = true)]
    node_arguments: Vec<String>,
}

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
enum LiveError {
    #[error(transparent)]
    Calibrate(#[from] CalibrateError),
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error(transparent)]
    Bind(#[from] BindError),
    #[error("{}: it places {}; name one with --camera", mount.display(), cameras.join(", "))]
    WhichCamera { mount: PathBuf, cameras: Vec<String> },
    #[error("{}: the camera sees no pad below it: measure its place again", .0.display())]
    Blind(PathBuf),
    #[error("--disc {0}: a diameter between 5 mm and 1 m is meant")]
    Disc(f64),
    #[error("the server failed: {0}")]
    Serve(#[from] std::io::Error),
}

/// Shows it until a signal ends the process.
pub(super) fn run(arguments: &Arguments) -> ExitCode {
    match show(arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("{COMMAND}: {error}");
            ExitCode::from(2)
        }
    }
}

fn show(arguments: &Arguments) -> Result<u8, LiveError> {
    let view = camera(arguments)?;
    let limits = limits(arguments)?;
    let pad = Pad { disc_diameter: arguments.disc, ..Pad::NOMINAL };
    if !(0.005..1.0).contains(&pad.disc_diameter) {
        return Err(LiveError::Disc(pad.disc_diameter));
    }
    let expectation = Expectation::new(&view.camera, &pad);
    let expectation = expectation.ok_or_else(|| LiveError::Blind(arguments.mount.clone()))?;
    let lens = view.camera.lens();
    let eye = Eye::new([lens.width as usize, lens.height as usize], expectation, &limits);
    let topic = view.topic(if arguments.compressed { "image_raw/compressed" } else { "image_raw" });
    let names = Names {
        camera: view.lens_name,
        topic: topic.clone(),
        out: arguments.out.display().to_string(),
        localizer: arguments.localizer.clone(),
    };
    let ears = Ears {
        topic,
        compressed: arguments.compressed,
        out: arguments.out.clone(),
        localizer: arguments.localizer.clone(),
    };
    let server = arguments.address.take()?;
    let table = node::keep(Table::new(Bench::new(names, eye, limits)), ears);
    server.announce(COMMAND, OPEN);
    server.serve_beside(COMMAND, page::FILES, page::router(table))?;
    Ok(node::run(&arguments.node_arguments))
}

/// Those of the colour file, if there is one, or else the localizer's own.
fn limits(arguments: &Arguments) -> Result<Colours, LiveError> {
    let default = ColourLimits::default();
    let mut limits = Colours { yellow: default.yellow_ratio, blue: default.blue_ratio, minimum: default.minimum };
    if !arguments.out.exists() {
        return Ok(limits);
    }
    let path = arguments.out.display().to_string();
    for parameter in apply::values(&path, &read(&arguments.out)?, &arguments.localizer)? {
        let value = parameter.value.double_value;
        match parameter.name.as_str() {
            "colour.yellow" => limits.yellow = value,
            "colour.blue" => limits.blue = value,
            "colour.minimum" => limits.minimum = value,
            _ => {}
        }
    }
    Ok(limits)
}

fn camera(arguments: &Arguments) -> Result<Overhead, LiveError> {
    let text = read(&arguments.mount)?;
    let path = |path: &PathBuf| path.display().to_string();
    let lens = |file: &str| {
        std::fs::read_to_string(file).map_err(|error| ConfigError {
            origin: trench_config::Origin::new(file, 0),
            key: "lens".to_owned(),
            value: String::new(),
            problem: error.to_string(),
            remedy: "name the lens file with --lens; `trench calibrate lens` makes it".to_owned(),
        })
    };
    let mut cameras = Overhead::all(&path(&arguments.lens), (&path(&arguments.mount), &text), lens)?;
    let wanted = cameras.iter().position(|view| arguments.camera.is_none() || view.name == arguments.camera);
    match wanted {
        Some(index) if arguments.camera.is_some() || cameras.len() == 1 => Ok(cameras.swap_remove(index)),
        _ => Err(LiveError::WhichCamera {
            mount: arguments.mount.clone(),
            cameras: cameras.into_iter().map(|view| view.name.unwrap_or_else(|| "one camera".to_owned())).collect(),
        }),
    }
}
