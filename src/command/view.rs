//! `trench view`: the live picture in a browser.

mod hub;
mod node;
mod serve;
mod stream;

use super::web::{Address, BindError};
use clap::Args;
use hub::Hub;
use serve::{Picture, router};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use trench_bag::{BagError, BagReader};
use trench_view::{LoadError, Recording, page};

const COMMAND: &str = "trench view";
/// What those may do who reach an address that is not this host's own.
const OPEN: &str = "sees the picture";
const FILES: &[&[page::File]] = &[page::SHARED, page::FIELD];

/// Shows the field in a browser: robots, trails, the formation, obstacles, alarms; live, or from a bag.
///
/// Serves one page on this host alone and prints its address. Live, it is a node that listens and, without --markers, says nothing.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    address: Address,
    /// Plays this bag (a folder or an .mcap file) instead of what happens now.
    #[arg(long, value_name = "FOLDER")]
    bag: Option<PathBuf>,
    /// The robots to listen to; by default those that /team_state tells of.
    #[arg(long, value_name = "NAME", value_delimiter = ',', conflicts_with = "bag")]
    robots: Vec<String>,
    /// Shows the simulated bed's ground truth and collisions too. (A bag shows what it has.)
    #[arg(long, conflicts_with = "bag")]
    ground_truth: bool,
    /// The field's corners, m; by default what the overhead camera of the small bed sees, or more where robots,
    /// obstacles or the target are outside.
    #[arg(long, value_names = ["X0", "Y0", "X1", "Y1"], num_args = 4, allow_negative_numbers = true)]
    field: Vec<f64>,
    /// Radii of the zones to draw around each robot, m.
    #[arg(long, value_name = "METRES", value_delimiter = ',')]
    zones: Vec<f64>,
    /// Publishes what the page alone draws (trails, links, V and its bound, alarms) on /markers, for RViz2 and Foxglove.
    #[arg(long, conflicts_with = "bag")]
    markers: bool,
    /// Further arguments of the node, for example `--ros-args -p use_sim_time:=true`.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    node_arguments: Vec<String>,
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
enum ViewError {
    #[error(transparent)]
    Bind(#[from] BindError),
    #[error(transparent)]
    Bag(#[from] BagError),
    #[error("{}: {source}", path.display())]
    Load { path: PathBuf, source: LoadError },
    #[error("--{0} wants numbers that are finite, the field two different corners, radii above 0")]
    Number(&'static str),
    #[error("the server failed: {0}")]
    Serve(#[from] std::io::Error),
}

/// Shows it until a signal ends the process.
pub(super) fn run(arguments: &Arguments) -> ExitCode {
    match show(arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("trench view: {error}");
            ExitCode::FAILURE
        }
    }
}

fn show(arguments: &Arguments) -> Result<u8, ViewError> {
    let setup = setup(arguments)?;
    let server = arguments.address.take()?;
    let Some(path) = &arguments.bag else {
        let hub = Arc::new(Hub::new(setup));
        server.announce(COMMAND, OPEN);
        server.serve_beside(COMMAND, FILES, router(Picture::Live(Arc::clone(&hub))))?;
        return Ok(node::run(
            hub,
            &arguments.robots,
            arguments.ground_truth,
            arguments.markers,
            &arguments.node_arguments,
        ));
    };
    let bag = BagReader::open(path)?;
    for damage in bag.damage() {
        eprintln!("trench view: {damage}");
    }
    let load = |source| ViewError::Load { path: path.clone(), source };
    let recording = Arc::new(Recording::load(&bag).map_err(load)?);
    server.announce(COMMAND, OPEN);
    server.serve(FILES, router(Picture::Bag { recording, setup }))?;
    Ok(0)
}

/// What the page must know beforehand, as JSON.
fn setup(arguments: &Arguments) -> Result<String, ViewError> {
    let field = match *arguments.field.as_slice() {
        [x0, y0, x1, y1] if x0 != x1 && y0 != y1 && arguments.field.iter().all(|number| number.is_finite()) => {
            Some([x0.min(x1), y0.min(y1), x0.max(x1), y0.max(y1)])
        }
        [] => None,
        _ => return Err(ViewError::Number("field")),
    };
    if !arguments.zones.iter().all(|radius| radius.is_finite() && *radius > 0.0) {
        return Err(ViewError::Number("zones"));
    }
    let name = arguments.bag.as_ref().map(|path| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy());
    Ok(serde_json::json!({
        "mode": if arguments.bag.is_some() { "bag" } else { "live" },
        "name": name,
        "field": field,
        "zones": arguments.zones,
        "colours": super::plot::colours(),
    })
    .to_string())
}
