//! One thing that was looked at.

use serde::Serialize;

/// One thing that was looked at, and whether it is as the theory asks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// What was looked at: `gains`, `potential`, `zones` ...
    pub check: &'static str,
    /// Of which files, nodes or queues.
    pub subjects: Vec<String>,
    /// Whether it holds: nothing is wrong with it.
    pub holds: bool,
    /// Whether there is something to know though nothing is wrong: a claim of the theory does not reach as far as what was looked at.
    pub note: bool,
    /// What was found, with its numbers; if it fails, what would be right.
    pub finding: String,
    /// The equation or section that decides.
    pub equation: &'static str,
    /// The numbers of the finding, all of them and unrounded, where there are more than it tells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub values: Option<Values>,
}

/// Numbers for programs.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Values {
    /// Of `chain`.
    Chain {
        /// What |e_j| never exceeds, by rank: of all robots of the chain, but of no more than a hundred. m and m/s together.
        bounds: Vec<f64>,
        /// The same by (8.26) as corrected.
        recursive_bounds: Vec<f64>,
        /// How many robots in one chain, all starting alike, stay within the tolerance.
        longest: usize,
        /// Ranks that were computed: where `longest` is as many, longer chains may stay within, too.
        computed: usize,
    },
    /// Of `gains` of (3.13): the guidelines of 4.3.2 for its K1 and K2.
    Gains {
        /// Guideline (2), K1 + (c1 + c2) K2: as far from both bounds of the stable zone as can be.
        k3_centred: f64,
        /// Guideline (3), K1 + c1 K2: as far as can be from both bounds of its upper part, K3 >= K1.
        k3_centred_above: f64,
    },
}

impl Verdict {
    /// A verdict about one subject.
    pub(crate) fn new(
        check: &'static str,
        subject: &str,
        holds: bool,
        finding: impl Into<String>,
        equation: &'static str,
    ) -> Self {
        let (subjects, finding) = (vec![subject.to_owned()], finding.into());
        Self { check, subjects, holds, note: false, finding, equation, values: None }
    }

    /// A note about one subject.
    pub(crate) fn noted(
        check: &'static str,
        subject: &str,
        finding: impl Into<String>,
        equation: &'static str,
    ) -> Self {
        Self { note: true, ..Self::new(check, subject, true, finding, equation) }
    }
}

/// A number for people: four significant digits.
pub(crate) fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let digits = (3.0 - libm::floor(libm::log10(value.abs()))).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (0.16, "0.16"),
            (12.345_67, "12.35"),
            (-1.5, "-1.5"),
            (1234.56, "1235"),
            (6e-7, "0.0000006"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
