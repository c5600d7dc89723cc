//! `trench bag play`: becomes the node `bag_player`, with the options of `ros2 bag play`.

use super::node::Node;
use clap::Args;
use std::io::IsTerminal;
use std::path::PathBuf;

/// What to play, and how.
#[derive(Args)]
pub(super) struct Play {
    /// A bag's folder or an .mcap file.
    bag: PathBuf,
    /// Times as fast as recorded.
    #[arg(short, long, default_value_t = 1.0)]
    rate: f64,
    /// Begins again at the end.
    #[arg(short, long = "loop")]
    is_loop: bool,
    /// Where to begin, in seconds from the first message. Latched topics give what they last said before.
    #[arg(long, default_value_t = 0.0, value_name = "SECONDS")]
    start_offset: f64,
    /// How many seconds of the bag to play; by default all.
    #[arg(long, value_name = "SECONDS")]
    playback_duration: Option<f64>,
    /// Seconds before the first message: readers need a moment to find the player.
    #[arg(short, long, default_value_t = 0.0, value_name = "SECONDS")]
    delay: f64,
    /// Topics to play; by default all.
    #[arg(long, value_name = "TOPIC", num_args = 1..)]
    topics: Vec<String>,
    /// Plays topics that a regular expression finds, besides those named.
    #[arg(short = 'e', long, value_name = "PATTERN")]
    regex: Option<String>,
    /// Topics to leave out.
    #[arg(long, value_name = "TOPIC", num_args = 1..)]
    exclude_topics: Vec<String>,
    /// Leaves out topics that a regular expression finds.
    #[arg(short = 'x', long, value_name = "PATTERN")]
    exclude_regex: Option<String>,
    /// Publishes under other names: `/old:=/new`.
    #[arg(short = 'm', long, value_name = "RULE", num_args = 1..)]
    remap: Vec<String>,
    /// Publishes the bag's time on /clock, so many times a second (40 where no number stands), for nodes with
    /// use_sim_time.
    #[arg(long, value_name = "HZ", num_args = 0..=1, default_missing_value = "40")]
    clock: Option<f64>,
    /// Publishes the bag's time on /clock before each message.
    #[arg(long)]
    clock_topics_all: bool,
    /// Waits for the space bar or the service ~/resume.
    #[arg(short = 'p', long)]
    start_paused: bool,
    /// Leaves the keyboard alone.
    #[arg(long)]
    disable_keyboard_controls: bool,
    /// Further arguments of the node, for example `--ros-args --log-level debug`.
    #[arg(last = true)]
    node_arguments: Vec<String>,
}

impl Play {
    /// Becomes the player, and comes back only where that fails, with the reason.
    pub(super) fn run(&self) -> std::io::Error {
        let mut node = Node::new("bag_player");
        // As rosbag2's player is called, so that tools which call its services find them.
        node.remap("__node:=rosbag2_player");
        self.remap.iter().for_each(|rule| node.remap(rule));
        node.text("bag", &self.bag.to_string_lossy());
        node.value("rate", self.rate);
        node.value("loop", self.is_loop);
        node.value("start_offset", self.start_offset);
        node.value("playback_duration", self.playback_duration.unwrap_or(-1.0));
        node.value("delay", self.delay);
        node.texts("topics", &self.topics);
        node.text("regex", self.regex.as_deref().unwrap_or_default());
        node.texts("exclude_topics", &self.exclude_topics);
        node.text("exclude_regex", self.exclude_regex.as_deref().unwrap_or_default());
        node.value("clock", self.clock.unwrap_or(0.0));
        node.value("clock_topics_all", self.clock_topics_all);
        node.value("start_paused", self.start_paused);
        node.value("keyboard", !self.disable_keyboard_controls && std::io::stdin().is_terminal());
        node.run(&self.node_arguments)
    }
}
