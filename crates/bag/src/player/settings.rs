//! What `ros2 bag play` has as options.

use crate::selection::{self, Selection};
use trench_config::{ConfigError, ParameterDescriptor, Parameters};

/// How a bag is played.
pub(super) struct Settings {
    pub(super) bag: String,
    pub(super) selection: Selection,
    /// Times as fast as recorded.
    pub(super) rate: f64,
    pub(super) is_loop: bool,
    /// From the bag's first message, s.
    pub(super) start_offset: f64,
    /// From there on, s; negative: to the end.
    pub(super) playback_duration: f64,
    /// Before the first message, s.
    pub(super) delay: f64,
    /// How often /clock is published, Hz; 0: not.
    pub(super) clock: f64,
    /// Whether /clock is also published before each message.
    pub(super) clock_topics_all: bool,
    pub(super) start_paused: bool,
    /// Whether keys of the terminal are heard.
    pub(super) keyboard: bool,
}

pub(super) fn parameters() -> Vec<ParameterDescriptor> {
    let topics = "topics to play; without any and without `regex`, all";
    let delay = "before the first message, s: readers need a moment to find this node";
    let clock = "how often /clock tells the time of the bag, Hz; 0: not at all";
    let all = "whether /clock also tells the time before each message";
    let mut descriptors = vec![
        ParameterDescriptor::string("bag", "", "the bag's folder, or an .mcap file"),
        ParameterDescriptor::string_list("topics", &[], topics),
        ParameterDescriptor::double("rate", 1.0, "times as fast as recorded").range(0.001, 1000.0),
        ParameterDescriptor::bool("loop", false, "whether the end is followed by the beginning"),
        ParameterDescriptor::double("start_offset", 0.0, "where to begin, s from the first message").range(0.0, 1e9),
        ParameterDescriptor::double("playback_duration", -1.0, "how much to play, s of the bag; negative: all"),
        ParameterDescriptor::double("delay", 0.0, delay).range(0.0, 1e6),
        ParameterDescriptor::double("clock", 0.0, clock).range(0.0, 1000.0),
        ParameterDescriptor::bool("clock_topics_all", false, all),
        ParameterDescriptor::bool("start_paused", false, "whether to wait for the first key or service call"),
        ParameterDescriptor::bool("keyboard", false, "whether keys of the terminal pause, step and change the rate"),
    ];
    descriptors.extend(selection::parameters());
    descriptors.into_iter().map(ParameterDescriptor::read_only).collect()
}

impl Settings {
    pub(super) fn new(parameters: &Parameters) -> Result<Self, ConfigError> {
        Ok(Self {
            bag: parameters.str("bag")?.to_owned(),
            selection: Selection::new(parameters.str_list("topics")?.to_vec(), parameters)?,
            rate: parameters.f64("rate")?,
            is_loop: parameters.bool("loop")?,
            start_offset: parameters.f64("start_offset")?,
            playback_duration: parameters.f64("playback_duration")?,
            delay: parameters.f64("delay")?,
            clock: parameters.f64("clock")?,
            clock_topics_all: parameters.bool("clock_topics_all")?,
            start_paused: parameters.bool("start_paused")?,
            keyboard: parameters.bool("keyboard")?,
        })
    }

    /// Whether /clock is published at all.
    pub(super) fn has_clock(&self) -> bool {
        self.clock > 0.0 || self.clock_topics_all
    }
}
