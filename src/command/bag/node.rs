//! Becoming a node that lies beside this program.

use std::io;
use std::os::unix::process::CommandExt;
use std::process::Command;

/// The command line of a node, parameter by parameter.
pub(super) struct Node {
    program: &'static str,
    command_line: Vec<String>,
}

impl Node {
    /// Of the executable `program`.
    pub(super) fn new(program: &'static str) -> Self {
        Self { program, command_line: vec!["--ros-args".to_owned()] }
    }

    /// Sets a string.
    pub(super) fn text(&mut self, name: &str, value: &str) {
        self.parameter(name, &quoted(value));
    }

    /// Sets a list of strings; an empty one stays as it is.
    pub(super) fn texts(&mut self, name: &str, values: &[String]) {
        if !values.is_empty() {
            let values: Vec<_> = values.iter().map(|value| quoted(value)).collect();
            self.parameter(name, &format!("[{}]", values.join(", ")));
        }
    }

    /// Sets a flag or a number.
    pub(super) fn value(&mut self, name: &str, value: impl std::fmt::Debug) {
        // A number that is whole keeps its point this way, which makes it a double for ROS.
        self.parameter(name, &format!("{value:?}"));
    }

    /// Adds a rule `from:=to`.
    pub(super) fn remap(&mut self, rule: &str) {
        self.command_line.extend(["-r".to_owned(), rule.to_owned()]);
    }

    fn parameter(&mut self, name: &str, value: &str) {
        self.command_line.extend(["-p".to_owned(), format!("{name}:={value}")]);
    }

    /// Becomes the node, with further arguments; comes back only where that fails, with the reason.
    pub(super) fn run(&self, further: &[String]) -> io::Error {
        let program = match std::env::current_exe() {
            Ok(program) => program.with_file_name(self.program),
            Err(error) => return error,
        };
        let error = Command::new(&program).args(&self.command_line).arg("--").args(further).exec();
        io::Error::new(error.kind(), format!("{}: {error}", program.display()))
    }
}

/// A string as YAML takes it, whatever is in it.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "''"))
}
