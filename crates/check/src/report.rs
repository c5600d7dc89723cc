//! All verdicts together.

use crate::Verdict;
use core::fmt;
use serde::Serialize;

/// Verdicts in the order in which they were reached; equal ones about several subjects are one.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Report {
    /// Whether all hold.
    pub holds: bool,
    /// All of them.
    pub verdicts: Vec<Verdict>,
}

impl Report {
    /// From all verdicts.
    pub fn new(verdicts: impl IntoIterator<Item = Verdict>) -> Self {
        let mut kept: Vec<Verdict> = Vec::new();
        for verdict in verdicts {
            let same = |other: &&mut Verdict| {
                (other.check, other.holds, other.note, &other.finding, other.equation, &other.values)
                    == (verdict.check, verdict.holds, verdict.note, &verdict.finding, verdict.equation, &verdict.values)
            };
            match kept.iter_mut().find(same) {
                Some(other) => {
                    let new = verdict.subjects.into_iter().filter(|subject| !other.subjects.contains(subject));
                    let new: Vec<String> = new.collect();
                    other.subjects.extend(new);
                }
                None => kept.push(verdict),
            }
        }
        Self { holds: kept.iter().all(|verdict| verdict.holds), verdicts: kept }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for verdict in &self.verdicts {
            let mark = match verdict {
                Verdict { holds: false, .. } => "FAILS",
                Verdict { note: true, .. } => "NOTE ",
                _ => "holds",
            };
            writeln!(formatter, "{mark}  {}: {}", verdict.check, verdict.subjects.join(", "))?;
            writeln!(formatter, "       {}", verdict.finding)?;
            writeln!(formatter, "       by {}", verdict.equation)?;
        }
        let count = |counts: fn(&Verdict) -> bool| self.verdicts.iter().filter(|verdict| counts(verdict)).count();
        let (failed, notes) = (count(|verdict| !verdict.holds), count(|verdict| verdict.holds && verdict.note));
        let besides = match notes {
            0 => String::new(),
            1 => "; 1 note".to_owned(),
            _ => format!("; {notes} notes"),
        };
        match (self.verdicts.len() - notes, failed) {
            (0, _) if notes > 0 => writeln!(formatter, "Nothing fails{besides}."),
            (0, _) => writeln!(formatter, "Nothing to judge."),
            (1, 0) => writeln!(formatter, "The verdict holds{besides}."),
            (all, 0) => writeln!(formatter, "All {all} verdicts hold{besides}."),
            (all, 1) => writeln!(formatter, "1 of {all} verdicts fails{besides}."),
            (all, _) => writeln!(formatter, "{failed} of {all} verdicts fail{besides}."),
        }
    }
}
