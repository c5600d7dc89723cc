//! Log lines: to the console as every ROS 2 node writes them, and to /rosout.

use crate::transport::network::NetworkWriter;
use std::io::Write;
use trench_core::{Level, RosTime};
use trench_msgs::Encode;
use trench_msgs::rcl_interfaces::Log;

/// The logger of one node.
pub(crate) struct Logger {
    name: String,
    lowest: Level,
    console: bool,
    rosout: Option<Box<dyn NetworkWriter>>,
}

impl Logger {
    /// For the logger `name` (the node's full name with dots), which speaks from `lowest` on.
    pub(crate) fn new(name: String, lowest: Level, console: bool) -> Self {
        Self { name, lowest, console, rosout: None }
    }

    /// Sends lines to /rosout too.
    pub(crate) fn attach(&mut self, rosout: Box<dyn NetworkWriter>) {
        self.rosout = Some(rosout);
    }

    /// Writes one line.
    pub(crate) fn log(&mut self, at: RosTime, level: Level, text: &str) {
        if level < self.lowest {
            return;
        }
        if self.console {
            // A console that has gone away must not end a node that drives robots.
            let _lost = writeln!(std::io::stderr().lock(), "{}", console_line(at, level, &self.name, text));
        }
        if let Some(rosout) = &mut self.rosout {
            let message = Log {
                stamp: at.into(),
                level: level as u8,
                name: self.name.clone(),
                msg: text.to_owned(),
                ..Log::default()
            };
            let _congested = rosout.write(message.to_cdr().into());
        }
    }

    /// Sends what waits; true when nothing waits any longer.
    pub(crate) fn flush(&mut self) -> bool {
        self.rosout.as_mut().is_none_or(|rosout| rosout.flush())
    }
}

/// `/robot1/pilot` logs as `robot1.pilot`.
pub(crate) fn logger_name(node: &str) -> String {
    node.trim_start_matches('/').replace('/', ".")
}

fn console_line(at: RosTime, level: Level, name: &str, text: &str) -> String {
    let level = match level {
        Level::Debug => "DEBUG",
        Level::Info => "INFO",
        Level::Warn => "WARN",
        Level::Error => "ERROR",
        Level::Fatal => "FATAL",
    };
    let (seconds, nanoseconds) = (at.0.div_euclid(1_000_000_000), at.0.rem_euclid(1_000_000_000));
    format!("[{level}] [{seconds}.{nanoseconds:09}] [{name}]: {text}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_look_like_those_of_ros() {
        assert_eq!(
            console_line(RosTime(1_700_000_000_000_000_042), Level::Warn, &logger_name("/robot1/pilot"), "low battery"),
            "[WARN] [1700000000.000000042] [robot1.pilot]: low battery"
        );
    }
}
