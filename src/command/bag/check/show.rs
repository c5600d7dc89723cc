//! What `trench bag check` prints.

use super::Checked;
use serde_json::{Value, json};
use std::fmt;
use trench_harness::replay::{Report, Verdict};

/// A line for each node, then what differs.
pub(super) struct Table<'a> {
    pub(super) checked: &'a [Checked],
    /// How long checking took, s.
    pub(super) took: f64,
}

impl fmt::Display for Table<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(out, "{:<34} {:>8} {:>8} {:>8}  verdict", "node", "events", "outputs", "equal")?;
        for checked in self.checked {
            match &checked.result {
                Ok(report) => {
                    let Report { node, events, outputs, equal, .. } = report;
                    writeln!(out, "{node:<34} {events:>8} {outputs:>8} {equal:>8}  {}", verdict(checked, report))?;
                }
                Err(_) => writeln!(out, "{:<34} {:>8} {:>8} {:>8}  unreadable", name(checked), "-", "-", "-")?,
            }
        }
        let span = self.checked.iter().filter_map(|checked| Some(checked.result.as_ref().ok()?.seconds));
        let span = span.fold(0.0, f64::max);
        writeln!(out, "{span:.1} s checked in {:.2} s: {:.0} times real time", self.took, span / self.took)?;
        for checked in self.checked {
            details(checked, out)?;
        }
        Ok(())
    }
}

fn name(checked: &Checked) -> String {
    checked.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn verdict(checked: &Checked, report: &Report) -> String {
    match &report.verdict {
        Verdict::Equal if report.tolerated > 0 => format!("within tolerance ({} outputs differ)", report.tolerated),
        Verdict::Equal => "equal".to_owned(),
        Verdict::Differs(_) if checked.is_updated => "differed, written anew".to_owned(),
        Verdict::Differs(_) => "differs".to_owned(),
        Verdict::NotReplayable { from, .. } => format!("not replayable from {from:.3} s"),
    }
}

fn details(checked: &Checked, out: &mut fmt::Formatter<'_>) -> fmt::Result {
    match &checked.result {
        Err(error) => writeln!(out, "\n{error}"),
        Ok(Report { node, verdict: Verdict::NotReplayable { from, reason }, .. }) => {
            writeln!(out, "\n{node}: not replayable from {from:.3} s: {reason}")
        }
        Ok(Report { verdict: Verdict::Differs(first), changes, .. }) => {
            writeln!(out, "\n{first}")?;
            changes.subjects.iter().try_for_each(|(subject, change)| writeln!(out, "  {subject}: {change}"))
        }
        Ok(Report { verdict: Verdict::Equal, .. }) => Ok(()),
    }
}

/// The same for programs.
pub(super) fn json(checked: &[Checked]) -> Value {
    checked.iter().map(json_of).collect()
}

fn json_of(checked: &Checked) -> Value {
    let file = checked.path.display().to_string();
    let report = match &checked.result {
        Ok(report) => report,
        Err(error) => return json!({ "file": file, "verdict": "unreadable", "reason": error.to_string() }),
    };
    let changes = report.changes.subjects.iter().map(|(subject, change)| {
        let largest = change.largest.as_ref().map(|(path, by)| json!({ "field": path, "by": by }));
        json!({ "subject": subject, "count": change.count, "largest": largest })
    });
    let mut value = json!({
        "file": file,
        "node": report.node,
        "events": report.events,
        "outputs": report.outputs,
        "equal": report.equal,
        "tolerated": report.tolerated,
        "seconds": report.seconds,
        "changes": changes.collect::<Value>(),
        "updated": checked.is_updated,
    });
    match &report.verdict {
        Verdict::Equal => value["verdict"] = json!("equal"),
        Verdict::NotReplayable { from, reason } => {
            value["verdict"] = json!("not replayable");
            value["from"] = json!(from);
            value["reason"] = json!(reason);
        }
        Verdict::Differs(first) => {
            value["verdict"] = json!("differs");
            value["difference"] = json!({
                "seconds": first.seconds,
                "ros_time": first.ros.0,
                "subject": first.subject,
                "field": first.pair.path,
                "recorded": first.pair.recorded,
                "now": first.pair.now,
                "equal_before": first.equal_before,
            });
        }
    }
    value
}
