//! What is said of a process to those who cannot see the launcher's screen: one line a change.

/// A line is no longer, in bytes: a pipe takes as much as one piece or not at all (`PIPE_BUF`).
const LONGEST_LINE: usize = 4096;
/// Nor is its text, in characters.
const LONGEST_TEXT: usize = 500;

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// As it should be.
    Fine,
    /// Worth a look.
    Warning,
    /// The process does nothing.
    Error,
}

/// What has become of a process.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Report {
    /// Its name for everybody: the node's full one where it is one node, else its label.
    pub name: String,
    /// Its label in this launch.
    pub label: String,
    /// How bad that is.
    pub severity: Severity,
    /// Whether it stays so; else it runs again, and what happened is soon no news any more.
    pub lasts: bool,
    /// How often it was started.
    pub starts: u32,
    /// The process id of its present life.
    pub pid: Option<u32>,
    /// What happened.
    pub text: String,
}

impl Report {
    /// As one line, which ends with a line break: fields with tabs between them, the text last.
    #[must_use]
    pub fn line(&self) -> String {
        let severity = match self.severity {
            Severity::Fine => "fine",
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        let stay = if self.lasts { "lasts" } else { "passes" };
        let pid = self.pid.map_or(String::new(), |pid| pid.to_string());
        let text: String = self.text.chars().take(LONGEST_TEXT).collect();
        let fields = [&self.name, &self.label, severity, stay, &self.starts.to_string(), &pid, &text].map(plain);
        format!("{}\n", fields.join("\t"))
    }

    /// Whether a pipe takes it as one piece.
    pub(crate) fn fits(line: &str) -> bool {
        line.len() <= LONGEST_LINE
    }

    /// Reads a line without its line break; nothing if it is none.
    #[must_use]
    pub fn parse(line: &str) -> Option<Self> {
        let [name, label, severity, stay, starts, pid, text] = line.split('\t').collect::<Vec<_>>().try_into().ok()?;
        let severity = match severity {
            "fine" => Severity::Fine,
            "warning" => Severity::Warning,
            "error" => Severity::Error,
            _ => return None,
        };
        let lasts = match stay {
            "lasts" => true,
            "passes" => false,
            _ => return None,
        };
        let pid = if pid.is_empty() { None } else { Some(pid.parse().ok()?) };
        let [name, label, text] = [name, label, text].map(str::to_owned);
        Some(Self { name, label, severity, lasts, starts: starts.parse().ok()?, pid, text })
    }
}

/// What ends a field or a line has no place in one.
fn plain(text: &str) -> String {
    text.replace(char::is_control, " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report() -> Report {
        Report {
            name: "/robot2/formation_controller".to_owned(),
            label: "robot2/formation_controller-7".to_owned(),
            severity: Severity::Warning,
            lasts: false,
            starts: 3,
            pid: Some(4711),
            text: "has died (signal: 9 (SIGKILL))".to_owned(),
        }
    }

    #[test]
    fn a_report_reads_back_from_its_line() {
        for report in [
            report(),
            Report { severity: Severity::Fine, lasts: true, pid: None, ..report() },
            Report { severity: Severity::Error, text: String::new(), ..report() },
        ] {
            let line = report.line();
            assert_eq!(Report::parse(line.strip_suffix('\n').unwrap()), Some(report));
        }
    }

    #[test]
    fn one_report_is_one_line_that_a_pipe_takes_as_one_piece() {
        let long = Report { text: "\u{1f916}\n\t".repeat(10_000), ..report() };
        let line = long.line();
        assert!(Report::fits(&line) && line.matches('\n').count() == 1, "{}", line.len());
        assert!(Report::parse(line.trim_end_matches('\n')).is_some());
    }

    #[test]
    fn what_is_no_report_is_none() {
        for line in ["", "a\tb", "a\tb\tbad\tlasts\t1\t\tx", "a\tb\tfine\tever\t1\t\tx", "a\tb\tfine\tlasts\t-1\t\tx"] {
            assert_eq!(Report::parse(line), None, "{line}");
        }
    }
}
