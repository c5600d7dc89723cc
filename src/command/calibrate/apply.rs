//! `trench calibrate apply`: becomes a node that asks a running localizer to take what calibration has found.

use std::path::PathBuf;
use std::process::ExitCode;
use trench_config::params::{Source, resolve};
use trench_config::{ConfigError, Origin, ParameterDescriptor, ParameterValue, Parameters};
use trench_core::{
    Event, Files, Interface, Level, NodeContext, NodeCore, NodeDescription, Serve, Sink, StartError, Steady, Times,
};
use trench_harness::catalog;
use trench_msgs::Message;
use trench_msgs::msg::{SetCalibration, SetCalibrationRequest, SetCalibrationResponse};
use trench_msgs::rcl_interfaces::{
    Parameter, SetParametersAtomically, SetParametersAtomicallyRequest, SetParametersAtomicallyResponse,
};
use trench_runtime::parameter_message;

/// Exit codes: it was refused; nobody answered.
const REFUSED: u8 = 1;
const SILENT: u8 = 2;
/// Places in `Interface::clients`.
const CALIBRATION: usize = 0;
const COLOURS: usize = 1;
/// Its parameter, the camera whose colours are in force.
const COLOURS_OF: &str = "colour.camera";

/// What was asked for last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// Colours that are of no camera, so that a lens of another one fits.
    Free,
    Calibration,
    Colours,
}

/// Gives a running localizer another lens, place of the camera or colours, each as a whole: in force from the next frame on, or
/// refused with the reason. Let robots stand meanwhile. Exit code 1: refused; 2: nobody answers; 3: a file
/// cannot be read.
#[derive(clap::Args)]
#[group(id = "what", required = true, multiple = true, args = ["lens", "mount", "colours"])]
pub(super) struct Arguments {
    /// A lens file, of `trench calibrate lens`.
    #[arg(long)]
    lens: Option<PathBuf>,
    /// A mount file, of `trench calibrate field`.
    #[arg(long)]
    mount: Option<PathBuf>,
    /// A parameter file, of `trench calibrate colours`.
    #[arg(long)]
    colours: Option<PathBuf>,
    /// Whose lens it is, where there are several cameras.
    #[arg(long, default_value = "")]
    camera: String,
    /// The localizer's full name.
    #[arg(long, default_value = "/overhead_localizer")]
    node: String,
    /// Further arguments of the node that asks, for example `--ros-args --log-level debug`.
    #[arg(last = true)]
    node_arguments: Vec<String>,
}

/// Becomes the node; the exit code is the node's.
pub(super) fn run(arguments: &Arguments) -> ExitCode {
    let path = |path: &Option<PathBuf>| path.as_ref().map(|path| path.display().to_string()).unwrap_or_default();
    let given = [
        ("localizer", arguments.node.clone()),
        ("camera", arguments.camera.clone()),
        ("lens", path(&arguments.lens)),
        ("mount", path(&arguments.mount)),
        ("colours", path(&arguments.colours)),
    ];
    let own = given.into_iter().flat_map(|(name, value)| ["-p".to_owned(), format!("{name}:={value:?}")]);
    let own = std::iter::once("--ros-args".to_owned()).chain(own).chain(["--".to_owned()]);
    trench_runtime::run_with_arguments(description(), own.chain(arguments.node_arguments.iter().cloned())).into()
}

fn description() -> NodeDescription {
    NodeDescription { name: "calibrate", about: "Gives a localizer what calibration has found", parameters, build }
}

fn parameters() -> Vec<ParameterDescriptor> {
    use ParameterDescriptor as P;
    vec![
        P::string("localizer", "/overhead_localizer", "the localizer's full name").read_only(),
        P::string("camera", "", "whose lens it is").read_only(),
        P::string("lens", "", "a lens file").read_only(),
        P::string("mount", "", "a mount file").read_only(),
        P::string("colours", "", "a parameter file").read_only(),
    ]
}

fn build(_: &NodeContext, parameters: &Parameters, files: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let localizer = parameters.str("localizer")?;
    let text = |key: &str| -> Result<String, ConfigError> {
        let path = parameters.str(key)?;
        if path.is_empty() { Ok(String::new()) } else { files.read(key, path) }
    };
    let calibration = SetCalibrationRequest {
        camera: parameters.str("camera")?.to_owned(),
        camera_info: text("lens")?,
        mount: text("mount")?,
    };
    let colours = text("colours")?;
    let file = parameters.str("colours")?;
    let colours = if file.is_empty() { Vec::new() } else { values(file, &colours, localizer)? };
    let interface = Interface {
        clients: vec![
            Serve::of::<SetCalibration>(format!("{localizer}/set_calibration")),
            Serve::of::<SetParametersAtomically>(format!("{localizer}/set_parameters_atomically")),
        ],
        ..Interface::default()
    };
    let colours = SetParametersAtomicallyRequest { parameters: colours };
    Ok(Box::new(Apply { interface, calibration, colours, step: None }))
}

/// What a parameter file says of the localizer, checked as the localizer would at its start.
pub(super) fn values(file: &str, text: &str, localizer: &str) -> Result<Vec<Parameter>, ConfigError> {
    let declared = catalog::node("overhead_localizer").map(|node| (node.parameters)()).unwrap_or_default();
    let (namespace, name) = localizer.rsplit_once('/').unwrap_or(("", localizer));
    let resolved = resolve(&[Source::File { name: file, text }], namespace, name, &declared);
    let resolved = match resolved {
        Ok(resolved) => resolved,
        Err(errors) => return Err(errors.into_iter().next().unwrap_or_else(|| nothing(file, localizer))),
    };
    let said = resolved.iter().filter(|(.., origin)| *origin.file == *file);
    let message = |(name, value, _): (&str, &ParameterValue, &Origin)| Parameter {
        name: name.to_owned(),
        value: parameter_message(value),
    };
    let values: Vec<Parameter> = said.map(message).collect();
    if values.is_empty() { Err(nothing(file, localizer)) } else { Ok(values) }
}

fn nothing(file: &str, localizer: &str) -> ConfigError {
    let remedy = format!(
        "write `/**/overhead_localizer: {{ros__parameters: ...}}`, as `trench calibrate colours` does for {localizer}"
    );
    ConfigError {
        origin: Origin::new(file, 0),
        key: "colours".into(),
        value: String::new(),
        problem: "says nothing of this localizer".into(),
        remedy,
    }
}

struct Apply {
    interface: Interface,
    calibration: SetCalibrationRequest,
    colours: SetParametersAtomicallyRequest,
    step: Option<Step>,
}

impl Apply {
    /// Whether anything has to be asked for in this step.
    fn has(&self, step: Step) -> bool {
        let (lens, colours) = (!self.calibration.camera_info.is_empty(), !self.colours.parameters.is_empty());
        match step {
            Step::Free => lens && colours,
            Step::Calibration => lens || !self.calibration.mount.is_empty(),
            Step::Colours => colours,
        }
    }

    /// Asks for what comes next, or ends.
    fn go_on(&mut self, sink: &mut dyn Sink) {
        let steps = [Step::Free, Step::Calibration, Step::Colours];
        let behind = steps.iter().position(|step| Some(*step) == self.step).map_or(0, |index| index + 1);
        self.step = steps.into_iter().skip(behind).find(|step| self.has(*step));
        match self.step {
            Some(Step::Free) => {
                let value = parameter_message(&ParameterValue::String(String::new()));
                let free = Parameter { name: COLOURS_OF.to_owned(), value };
                sink.call(COLOURS, &SetParametersAtomicallyRequest { parameters: vec![free] });
            }
            Some(Step::Calibration) => sink.call(CALIBRATION, &self.calibration),
            Some(Step::Colours) => sink.call(COLOURS, &self.colours),
            None => sink.exit(0),
        }
    }

    fn answered(&mut self, client: usize, cdr: Option<&[u8]>, sink: &mut dyn Sink) {
        let answer = cdr.and_then(|cdr| match client {
            CALIBRATION => SetCalibrationResponse::decode(cdr).ok().map(|answer| (answer.success, answer.message)),
            _ => {
                let result = SetParametersAtomicallyResponse::decode(cdr).ok()?.result;
                let message = if result.successful { "colours are in force".to_owned() } else { result.reason };
                Some((result.successful, message))
            }
        });
        match answer {
            Some((true, message)) => {
                if self.step != Some(Step::Free) {
                    sink.log(Level::Info, &message);
                }
                self.go_on(sink);
            }
            Some((false, reason)) => {
                sink.log(Level::Error, &format!("refused: {reason}"));
                sink.exit(REFUSED);
            }
            None => {
                let name = self.interface.clients.get(client).map_or("", |client| &client.name);
                sink.log(
                    Level::Error,
                    &format!("nobody answers at {name}: is the localizer running, in this ROS_DOMAIN_ID?"),
                );
                sink.exit(SILENT);
            }
        }
    }
}

impl NodeCore for Apply {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, _: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Started => self.go_on(sink),
            Event::Response { client, cdr } => self.answered(client, cdr, sink),
            _ => {}
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        None
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        // All are fixed at the start.
        Ok(())
    }
}
