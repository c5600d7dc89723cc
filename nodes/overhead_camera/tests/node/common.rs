//! Driving the core from tests: its own clock, the messages it publishes.

use std::path::Path;
use trench_config::params::{Source as Given, resolve};
use trench_config::{ConfigError, Origin};
use trench_core::{Action, Event, Files, NodeContext, NodeCore, Outbox, RosTime, Steady, Times};
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::sensor_msgs::Image;

/// ROS time at monotonic time zero, ns.
pub(crate) const EPOCH: i64 = 1_000_000_000_000;

/// The lens file of config/cameras under its own name.
pub(crate) struct Shipped;

impl Files for Shipped {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        match path {
            "overhead.yaml" => Ok(include_str!("../../../../config/cameras/overhead.yaml").to_owned()),
            "overhead_mount.yaml" => Ok(include_str!("../../../../config/cameras/overhead_mount.yaml").to_owned()),
            other => Err(ConfigError {
                origin: Origin::default(),
                key: key.to_owned(),
                value: other.to_owned(),
                problem: "cannot be read".to_owned(),
                remedy: String::new(),
            }),
        }
    }
}

/// Makes the core that these lines of its parameter file ask for.
pub(crate) fn build(lines: &str) -> Result<Box<dyn NodeCore>, String> {
    let description = overhead_camera::description();
    let text = format!("overhead_camera:\n  ros__parameters:\n    {}\n", lines.replace('\n', "\n    "));
    let sources = [Given::File { name: "camera.yaml", text: &text }];
    let parameters = resolve(&sources, "/", description.name, &(description.parameters)())
        .map_err(|errors| errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))?;
    let context =
        NodeContext { namespace: "/".to_owned(), name: description.name.to_owned(), ..NodeContext::default() };
    (description.build)(&context, &parameters, &Shipped).map_err(|error| error.to_string())
}

/// Lines that ask for `source` at `path`.
pub(crate) fn lines(source: &str, path: &Path, more: &str) -> String {
    format!("source: {source}\npath: {}\n{more}", path.display())
}

/// What a run of a core brought.
#[derive(Default)]
pub(crate) struct Run {
    /// Images with the monotonic time of their publication, s.
    pub(crate) images: Vec<(f64, Image)>,
    /// Everything else, in order.
    pub(crate) outbox: Outbox,
    /// The exit code, if the core asked for the end.
    pub(crate) exit: Option<u8>,
}

impl Run {
    /// All log lines.
    pub(crate) fn log(&self) -> Vec<&str> {
        let text = |action: &Action| matches!(action, Action::Log { .. });
        let lines = self.outbox.actions.iter().filter(|action| text(action));
        lines
            .filter_map(|action| if let Action::Log { text, .. } = action { Some(text.as_str()) } else { None })
            .collect()
    }

    /// The last diagnostics.
    pub(crate) fn diagnostics(&self) -> DiagnosticArray {
        self.outbox.last(1).unwrap()
    }
}

/// Lets the core run for `seconds` or to its end, waking it when it asks for that.
pub(crate) fn run(core: &mut dyn NodeCore, seconds: f64) -> Run {
    let (mut run, mut now, mut event) = (Run::default(), Steady(0), Event::Started);
    while now.seconds_since(Steady(0)) <= seconds && run.exit.is_none() {
        let mut outbox = Outbox::default();
        core.handle(Times { ros: RosTime(EPOCH + now.0 as i64), steady: now }, event, &mut outbox);
        let images = outbox.published::<Image>(0).into_iter();
        run.images.extend(images.map(|image| (now.seconds_since(Steady(0)), image)));
        for action in outbox.take() {
            match action {
                Action::Exit(code) => run.exit = Some(code),
                Action::Publish { port: 0, .. } => {}
                other => run.outbox.actions.push(other),
            }
        }
        let Some(next) = core.next_wakeup() else { break };
        (now, event) = (next.max(now), Event::Wakeup);
    }
    run
}

/// Seconds from the start of the run to a message's stamp.
pub(crate) fn stamp(image: &Image) -> f64 {
    RosTime::from(&image.header.stamp).seconds_since(RosTime(EPOCH))
}
