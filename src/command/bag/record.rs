//! `trench bag record`: becomes the node `bag_recorder`, which lies beside this program.

use super::node::Node;
use clap::Args;
use std::path::PathBuf;

/// What to record, and where.
#[derive(Args)]
pub(super) struct Record {
    /// The new bag's folder, which must not exist.
    out: PathBuf,
    /// Topics: NAME, or NAME:TYPE where it is to be heard before anybody writes it (/x:std_msgs/msg/Bool).
    #[arg(long, value_name = "TOPIC", num_args = 1.., conflicts_with = "all")]
    topics: Vec<String>,
    /// All topics of the graph. Without any choice these are recorded too, images excepted.
    #[arg(short, long)]
    all: bool,
    /// Records topics that a regular expression finds, besides those named.
    #[arg(short = 'e', long, value_name = "PATTERN")]
    regex: Option<String>,
    /// Topics to leave out.
    #[arg(long, alias = "exclude", value_name = "TOPIC", num_args = 1..)]
    exclude_topics: Vec<String>,
    /// Leaves out topics that a regular expression finds.
    #[arg(short = 'x', long, value_name = "PATTERN")]
    exclude_regex: Option<String>,
    /// Begins the next file before one is larger than this many bytes.
    #[arg(short = 'b', long, value_name = "BYTES", default_value_t = 0)]
    max_bag_size: u64,
    /// Begins the next file when one spans this many seconds.
    #[arg(short = 'd', long, value_name = "SECONDS", default_value_t = 0.0)]
    max_bag_duration: f64,
    /// Robots whose topics are heard before anybody writes them.
    #[arg(long, value_name = "NAME", num_args = 1.., value_delimiter = ',')]
    robots: Vec<String>,
    /// Further arguments of the node, for example `--ros-args -p use_sim_time:=true`.
    #[arg(last = true)]
    node_arguments: Vec<String>,
}

impl Record {
    /// Becomes the recorder, and comes back only where that fails, with the reason.
    pub(super) fn run(&self) -> std::io::Error {
        let mut node = Node::new("bag_recorder");
        node.text("output", &self.out.to_string_lossy());
        node.texts("topics", &self.topics);
        node.texts("robots", &self.robots);
        node.value("all", self.all);
        node.text("regex", self.regex.as_deref().unwrap_or_default());
        node.texts("exclude_topics", &self.exclude_topics);
        node.text("exclude_regex", self.exclude_regex.as_deref().unwrap_or_default());
        node.value("max_bag_size", self.max_bag_size);
        node.value("max_bag_duration", self.max_bag_duration);
        node.run(&self.node_arguments)
    }
}
