//! What is known of the processes of a launch, as /diagnostics has it.

use std::collections::BTreeMap;
use trench_core::{Condition, Steady, Times};
use trench_launch::{Report, Severity};
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue};
use trench_msgs::std_msgs::Header;

/// How long what passes is told, s: as long as nodes tell of what they noticed.
const LATELY: f64 = 5.0;

pub(super) struct Statuses {
    /// The full name of the node that tells.
    node: String,
    /// The launch file.
    file: String,
    /// The last report on each process, by label, and when it came.
    reports: BTreeMap<String, (Steady, Report)>,
    launcher_is_gone: bool,
}

impl Statuses {
    pub(super) fn new(node: String, file: &str) -> Self {
        Self { node, file: file.to_owned(), reports: BTreeMap::new(), launcher_is_gone: false }
    }

    pub(super) fn take(&mut self, at: Steady, report: Report) {
        self.reports.insert(report.label.clone(), (at, report));
    }

    pub(super) fn launcher_is_gone(&mut self) {
        self.launcher_is_gone = true;
    }

    /// All processes, and the launch as a whole.
    pub(super) fn message(&self, at: Times) -> DiagnosticArray {
        let told: Vec<(&str, Condition, DiagnosticStatus)> =
            self.reports.values().map(|(since, report)| self.of(report, at.steady.seconds_since(*since))).collect();
        let summary = self.summary(&told);
        let status = told.into_iter().map(|(.., status)| status).chain([summary]).collect();
        DiagnosticArray { header: Header { stamp: at.ros.into(), frame_id: String::new() }, status }
    }

    /// The status of a process `age` seconds after the report on it.
    fn of<'a>(&self, report: &'a Report, age: f64) -> (&'a str, Condition, DiagnosticStatus) {
        let is_over = !report.lasts && age >= LATELY;
        let condition = match report.severity {
            _ if is_over => Condition::Ok,
            Severity::Fine => Condition::Ok,
            Severity::Warning => Condition::Warn,
            Severity::Error => Condition::Error,
        };
        let mut values = vec![value("label", &report.label), value("starts", report.starts)];
        values.extend(report.pid.map(|pid| value("pid", pid)));
        // Another launch may have a process of the same label.
        let name =
            if report.name.starts_with('/') { report.name.clone() } else { format!("{}/{}", self.node, report.name) };
        let status = DiagnosticStatus {
            level: condition as u8,
            name: format!("{name}: process"),
            message: if is_over { "runs".to_owned() } else { report.text.clone() },
            hardware_id: name,
            values,
        };
        (&report.label, condition, status)
    }

    fn summary(&self, told: &[(&str, Condition, DiagnosticStatus)]) -> DiagnosticStatus {
        let worst = told.iter().map(|(_, condition, _)| *condition).max().unwrap_or_default();
        let bad = told.iter().filter(|(_, condition, _)| *condition != Condition::Ok).map(|(label, ..)| *label);
        let bad = bad.collect::<Vec<_>>().join(", ");
        let (condition, message) = if self.launcher_is_gone {
            (Condition::Error, "the launcher was killed: its processes end".to_owned())
        } else if bad.is_empty() {
            (worst, "all as it should be".to_owned())
        } else {
            (worst, format!("{bad}: not as it should be"))
        };
        DiagnosticStatus {
            level: condition as u8,
            name: format!("{}: processes", self.node),
            message,
            hardware_id: self.node.clone(),
            values: vec![value("file", &self.file), value("processes", told.len())],
        }
    }
}

fn value(key: &str, value: impl ToString) -> KeyValue {
    KeyValue { key: key.to_owned(), value: value.to_string() }
}
