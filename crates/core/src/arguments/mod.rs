//! The command line of a ROS 2 node: `--ros-args ... [--]`, as often as one likes, `--namespaces` and `--help`.

mod error;
mod namespaces;
mod parameters;
mod remap;

pub use error::UsageError;
pub use parameters::{
    CLOCK_REFERENCE, NETWORK_RATE, PUBLISH_OVER_NETWORK, READ_BEST_EFFORT, SERVE_CLOCK, process_parameters,
};
pub use remap::{NameKind, Names, Remap};

use crate::Level;

/// Where a parameter value comes from, in the order of the command line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ParameterSource {
    /// `--params-file PATH`
    File(String),
    /// `-p [NODE:]NAME:=VALUE`
    Override {
        /// The node it is meant for, if not all.
        node: Option<String>,
        /// The parameter.
        name: String,
        /// Its value in YAML.
        value: String,
    },
}

/// What the command line asks for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Arguments {
    /// `-r`, in order: the first that matches a name applies.
    pub remaps: Vec<Remap>,
    /// `--params-file` and `-p`, in order.
    pub parameters: Vec<ParameterSource>,
    /// `--log-level LEVEL`
    pub log_level: Level,
    /// `--log-level NAME:=LEVEL`
    pub log_levels: Vec<(String, Level)>,
    /// Whether log lines go to /rosout.
    pub rosout: bool,
    /// Whether log lines go to the console.
    pub console: bool,
    /// `--enclave NAME`: who the process is where DDS Security is asked for.
    pub enclave: String,
    /// `--namespaces LIST`: a node in each of them instead of one; see [`Arguments::of_each_node`].
    pub namespaces: Vec<String>,
    /// `--help` was given.
    pub help: bool,
}

impl Default for Arguments {
    fn default() -> Self {
        Self {
            remaps: Vec::new(),
            parameters: Vec::new(),
            log_level: Level::Info,
            log_levels: Vec::new(),
            rosout: true,
            console: true,
            enclave: "/".to_owned(),
            namespaces: Vec::new(),
            help: false,
        }
    }
}

impl Arguments {
    /// Reads the arguments behind the program's name.
    ///
    /// # Errors
    /// At the first argument that is not understood.
    pub fn parse(arguments: impl IntoIterator<Item = String>) -> Result<Self, UsageError> {
        let mut parsed = Self::default();
        let mut rest = arguments.into_iter();
        let mut ros = false;
        while let Some(argument) = rest.next() {
            match argument.as_str() {
                "--ros-args" => ros = true,
                "--" if ros => ros = false,
                "-h" | "--help" => parsed.help = true,
                "--namespaces" if !ros => {
                    let list = rest.next().ok_or_else(|| UsageError::MissingValue(argument.clone()))?;
                    parsed.namespaces = namespaces::parse(&list)?;
                }
                _ if ros => parsed.ros_argument(&argument, &mut rest)?,
                _ => return Err(UsageError::Unknown(argument)),
            }
        }
        Ok(parsed)
    }

    /// The lowest level at which the logger `name` speaks.
    #[must_use]
    pub fn level_of(&self, name: &str) -> Level {
        self.log_levels.iter().rev().find(|(logger, _)| logger == name).map_or(self.log_level, |(_, level)| *level)
    }

    fn ros_argument(&mut self, flag: &str, rest: &mut impl Iterator<Item = String>) -> Result<(), UsageError> {
        let mut value = || rest.next().ok_or_else(|| UsageError::MissingValue(flag.to_owned()));
        match flag {
            "-r" | "--remap" => self.remaps.push(Remap::parse(&value()?)?),
            "-p" | "--param" => self.parameters.push(parameter(&value()?)?),
            "--params-file" => self.parameters.push(ParameterSource::File(value()?)),
            "--log-level" => self.log_level_argument(&value()?)?,
            "--enable-rosout-logs" => self.rosout = true,
            "--disable-rosout-logs" => self.rosout = false,
            "--enable-stdout-logs" => self.console = true,
            "--disable-stdout-logs" => self.console = false,
            "-e" | "--enclave" => self.enclave = enclave(value()?)?,
            // Accepted as every ROS 2 node does; there is no external log library here.
            "--enable-external-lib-logs" | "--disable-external-lib-logs" => {}
            "--log-config-file" | "--log-file-name" => {
                value()?;
            }
            _ => return Err(UsageError::Unknown(flag.to_owned())),
        }
        Ok(())
    }

    fn log_level_argument(&mut self, text: &str) -> Result<(), UsageError> {
        match text.split_once(":=") {
            Some((name, name_level)) => self.log_levels.push((name.to_owned(), level(name_level, text)?)),
            None => self.log_level = level(text, text)?,
        }
        Ok(())
    }
}

/// An absolute name whose parts are none that lead out of the keystore.
fn enclave(name: String) -> Result<String, UsageError> {
    let parts = name.strip_prefix('/').map(|rest| rest.split('/').all(|part| !matches!(part, "." | "..")));
    if parts == Some(true) { Ok(name) } else { Err(UsageError::EnclaveName(name)) }
}

/// `[node:]name:=value`
fn parameter(text: &str) -> Result<ParameterSource, UsageError> {
    let wrong = || UsageError::Parameter(text.to_owned());
    let (target, value) = text.split_once(":=").ok_or_else(wrong)?;
    let (node, name) = match target.split_once(':') {
        Some((node, name)) => (Some(node.to_owned()), name),
        None => (None, target),
    };
    if name.is_empty() || node.as_deref() == Some("") {
        return Err(wrong());
    }
    Ok(ParameterSource::Override { node, name: name.to_owned(), value: value.to_owned() })
}

fn level(name: &str, whole: &str) -> Result<Level, UsageError> {
    match name.to_ascii_lowercase().as_str() {
        "debug" => Ok(Level::Debug),
        "info" => Ok(Level::Info),
        "warn" => Ok(Level::Warn),
        "error" => Ok(Level::Error),
        "fatal" => Ok(Level::Fatal),
        _ => Err(UsageError::LogLevel(whole.to_owned())),
    }
}

#[cfg(test)]
mod tests;
