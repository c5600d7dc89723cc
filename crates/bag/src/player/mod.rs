//! The player: a node that publishes what is in a bag, spaced as it was recorded.
//!
//! A node core like the recorder: it reads a file, and runs on whatever transports its process has. Its parameters are
//! the options of `ros2 bag play`, its services those of rosbag2's player, its keys too.

mod core;
mod keys;
mod publications;
mod services;
mod settings;
mod tape;
mod timeline;

use crate::BagReader;
use settings::Settings;
use std::path::Path;
use std::sync::Arc;
use trench_config::Parameters;
use trench_core::{Files, NodeContext, NodeCore, NodeDescription, StartError};

/// The player as processes make it.
#[must_use]
pub fn description() -> NodeDescription {
    NodeDescription {
        name: "bag_player",
        about: "Publishes the messages of a bag (MCAP as rosbag2 writes it) at the pace at which they were recorded.",
        parameters: settings::parameters,
        build,
    }
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let settings = Settings::new(parameters)?;
    let problem = |problem: String| parameters.error("bag", problem, "name a bag's folder or an .mcap file");
    let bag = BagReader::open(Path::new(&settings.bag)).map_err(|error| problem(error.to_string()))?;
    let longest = bag.longest().map_err(|error| problem(error.to_string()))?;
    let player = core::Player::new(Arc::new(bag), &longest, settings);
    Ok(Box::new(player.ok_or_else(|| problem("holds no message of the topics and times that are chosen".to_owned()))?))
}
