//! By how much outputs may differ from the recorded ones, where a user wants that.

use trench_config::{ConfigError, yaml};

/// Rules for fields of messages. Without any, outputs must be equal bit for bit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tolerances {
    rules: Vec<Rule>,
}

#[derive(Debug, Clone, PartialEq)]
struct Rule {
    topic: String,
    field: String,
    most: f64,
}

impl Tolerances {
    /// Reads them from a file: `tolerances`, a map from topics (or services) to maps from fields to the largest
    /// difference, in the field's unit. `*` in a name stands for any characters.
    ///
    /// # Errors
    /// When the text of `file` is something else.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        let document = yaml::parse(file, text)?;
        let root = document.map()?;
        let mut rules = Vec::new();
        for topic in root.map("tolerances")?.entries() {
            for field in topic.node.map()?.entries() {
                let most: f64 = field.node.get()?;
                if most.is_nan() || most < 0.0 {
                    return Err(field.node.error("is no tolerance", "write 0 or a positive number"));
                }
                rules.push(Rule { topic: topic.key.clone(), field: field.key.clone(), most });
            }
        }
        root.finish()?;
        Ok(Self { rules })
    }

    /// Whether there are any.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rules.is_empty()
    }

    /// Whether a field of a topic may have changed like this. The first rule whose names fit holds.
    pub(super) fn allow(&self, topic: &str, field: &str, was: f64, is: f64) -> bool {
        let fits = |rule: &&Rule| matches(&rule.topic, topic) && matches(&rule.field, field);
        self.rules.iter().find(fits).is_some_and(|rule| (was - is).abs() <= rule.most)
    }
}

/// Whether `name` fits `pattern`, in which `*` stands for any characters.
fn matches(pattern: &str, name: &str) -> bool {
    let Some((head, rest)) = pattern.split_once('*') else { return pattern == name };
    let Some(tail) = name.strip_prefix(head) else { return false };
    let ends = tail.char_indices().map(|(at, _)| at).chain([tail.len()]);
    ends.into_iter().any(|at| tail.get(at..).is_some_and(|tail| matches(rest, tail)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_stand_for_any_characters() {
        let check =
            |pattern: &str, name: &str, expected: bool| assert_eq!(matches(pattern, name), expected, "{pattern}");
        check("/robot*/cmd_vel", "/robot12/cmd_vel", true);
        check("/robot*/cmd_vel", "/robot12/cmd_vel2", false);
        check("robots[*].x", "robots[3].x", true);
        check("robots[*].x", "robots[3].y", false);
        check("*", "", true);
        check("*.x*", "a.x.b.x", true);
        check("twist", "twist.linear", false);
    }

    #[test]
    fn the_first_rule_that_fits_holds() {
        let text = "tolerances:\n  /robot1/*: {x: 0.0}\n  /robot*/odom:\n    x: 0.5\n    '*': 1.0e-3\n";
        let tolerances = Tolerances::parse("t.yaml", text).unwrap_or_default();
        let check = |topic: &str, field: &str, by: f64| tolerances.allow(topic, field, 1.0, 1.0 + by);
        assert!(check("/robot2/odom", "x", 0.4) && !check("/robot2/odom", "x", 0.6));
        assert!(!check("/robot1/odom", "x", 0.4), "robot1's own rule comes first");
        assert!(check("/robot1/odom", "y", 0.9e-3) && !check("/robot1/odom", "y", 1.1e-3));
        assert!(!check("/goals", "x", 1e-12));
        assert!(!tolerances.allow("/robot2/odom", "x", f64::NAN, 1.0));
    }

    #[test]
    fn what_is_no_tolerance_is_refused_with_its_line() {
        let check = |text: &str, expected: &str| {
            let error = Tolerances::parse("t.yaml", text).err().map(|error| error.to_string()).unwrap_or_default();
            assert!(error.contains(expected), "{error}");
        };
        check("tolerances:\n  /a:\n    x: -1.0\n", "t.yaml:3");
        check("tolerances:\n  /a: 3\n", "t.yaml:2");
        check("tolerance: {}\n", "tolerances");
    }
}
