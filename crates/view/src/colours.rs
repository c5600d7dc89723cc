//! What the page of `trench calibrate live` asks for.

use serde::Deserialize;

/// Yellow or blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Which {
    /// In front.
    Yellow,
    /// Behind.
    Blue,
}

/// A command of the page, as JSON: `{"click": {...}}`, `"undo"` and so on.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Command {
    /// This pixel of this picture is in the middle of a disc.
    Click {
        /// The disc's colour.
        which: Which,
        /// Column.
        u: f64,
        /// Row.
        v: f64,
        /// The picture's number.
        shot: u64,
    },
    /// Forget the last click, or the last frames learned from.
    Undo,
    /// Learn from the discs that are found in the next frames.
    Gather,
    /// These limits, set by hand.
    Limits {
        /// Least (R + G - 2 B) / (R + G + B) of yellow.
        yellow: f64,
        /// Least (2 B - R - G) / (R + G + B) of blue.
        blue: f64,
        /// Least absolute difference of either, of 510.
        minimum: f64,
    },
    /// Keep this picture, or go on.
    Hold(bool),
    /// Write the colour file.
    Save,
    /// Have the running localizer take these limits.
    Apply,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_read_and_nonsense_is_not() {
        let check = |text: &str, expected: Option<Command>| {
            assert_eq!(serde_json::from_str(text).ok(), expected, "{text}");
        };
        let click = Command::Click { which: Which::Blue, u: 3.5, v: 4.0, shot: 7 };
        check(r#"{"click": {"which": "blue", "u": 3.5, "v": 4, "shot": 7}}"#, Some(click));
        check(r#""undo""#, Some(Command::Undo));
        check(r#"{"hold": true}"#, Some(Command::Hold(true)));
        check(
            r#"{"limits": {"yellow": 0.3, "blue": 0.4, "minimum": 30}}"#,
            Some(Command::Limits { yellow: 0.3, blue: 0.4, minimum: 30.0 }),
        );
        for nonsense in ["{}", "[]", r#""fly""#, r#"{"click": {"which": "red", "u": 1, "v": 1, "shot": 1}}"#] {
            check(nonsense, None);
        }
    }
}
