//! Scenarios that are launch files, and who is to blame when one cannot be driven.

use trench_config::{ConfigError, Origin};

/// A launch file, driven as `trench sim` drives it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Launch {
    /// Relative to the scenario file.
    pub file: String,
    /// Where the scenario names it.
    pub origin: Origin,
    /// Arguments of the launch file.
    pub arguments: Vec<Argument>,
}

/// An argument of the launch file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Argument {
    /// Its name.
    pub name: String,
    /// Its value, as the command line would have it.
    pub value: String,
    /// Where it stands.
    pub origin: Origin,
}

/// What launch files and parameters name as the origin of what no file says.
const COMMAND_LINE: &str = "command line";

impl Launch {
    /// The same without the arguments that `given` (name and value, on the command line) has, too: what comes later wins.
    #[must_use]
    pub fn overridden_by(&self, given: &[(String, String)]) -> Self {
        let stays = |argument: &&Argument| given.iter().all(|(name, _)| *name != argument.name);
        Self { arguments: self.arguments.iter().filter(stays).cloned().collect(), ..self.clone() }
    }

    /// Names and values.
    #[must_use]
    pub fn pairs(&self) -> Vec<(String, String)> {
        self.arguments.iter().map(|argument| (argument.name.clone(), argument.value.clone())).collect()
    }

    /// An error of the launch file as one of the scenario: the scenario's words are no command line, and what they lead to is told with
    /// the line that leads there.
    #[must_use]
    pub fn blamed(&self, error: ConfigError) -> ConfigError {
        if &*error.origin.file != COMMAND_LINE {
            return self.led_to(error.to_string(), Some(&error));
        }
        match self.arguments.iter().find(|argument| argument.name == error.key) {
            Some(argument) => {
                ConfigError { origin: argument.origin.clone(), key: format!("arguments.{}", argument.name), ..error }
            }
            None if error.key.is_empty() => {
                ConfigError { origin: self.origin.clone(), key: "launch".to_owned(), value: self.file.clone(), ..error }
            }
            // It does stand on the command line.
            None => error,
        }
    }

    /// What was `told` of a node or a file that the launch file leads to, `about` a value of it: at the argument that the value came from,
    /// if that is plain, else where the launch file is named.
    #[must_use]
    pub fn led_to(&self, told: String, about: Option<&ConfigError>) -> ConfigError {
        let argument = about.and_then(|about| self.argument(about));
        let (origin, key, value) = match argument {
            Some(argument) => (argument.origin.clone(), format!("arguments.{}", argument.name), argument.value.clone()),
            None => (self.origin.clone(), "launch".to_owned(), self.file.clone()),
        };
        ConfigError { origin, key, value, problem: told, remedy: String::new() }
    }

    /// The argument that an error of something else is about: of the same name, of the same value, or alone in what is said.
    fn argument(&self, about: &ConfigError) -> Option<&Argument> {
        let key = about.key.rsplit('.').next().unwrap_or_default();
        let alone = |fits: &dyn Fn(&Argument) -> bool| {
            let mut fitting = self.arguments.iter().filter(|argument| fits(argument));
            fitting.next().filter(|_| fitting.next().is_none())
        };
        alone(&|argument| argument.name == key)
            .or_else(|| alone(&|argument| argument.value == about.value.trim_matches('"')))
            .or_else(|| alone(&|argument| about.problem.contains(&argument.value)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn launch() -> Launch {
        let argument = |(line, (name, value)): (usize, (&str, &str))| Argument {
            name: name.to_owned(),
            value: value.to_owned(),
            origin: Origin::new("square.yaml", line),
        };
        let arguments = (5..).zip([("seed", "abc"), ("profile", "nonsense"), ("bed", "ideal")]).map(argument).collect();
        Launch { file: "square.launch.yaml".to_owned(), origin: Origin::new("square.yaml", 3), arguments }
    }

    fn check(origin: Origin, (key, value, problem): (&str, &str, &str), expected: &str) {
        let (key, value, problem) = (key.to_owned(), value.to_owned(), problem.to_owned());
        let error = ConfigError { origin, key, value, problem, remedy: "mend it".to_owned() };
        assert_eq!(launch().blamed(error).to_string(), expected);
    }

    #[test]
    fn what_the_scenario_says_is_told_there() {
        let line = || Origin::new(COMMAND_LINE, 0);
        check(
            line(),
            ("", "", "cannot read it"),
            "square.yaml:3: launch = square.launch.yaml: cannot read it; mend it",
        );
        check(
            line(),
            ("profile", "nonsense", "no such argument"),
            "square.yaml:6: arguments.profile = nonsense: no such argument; mend it",
        );
        check(line(), ("tolerance", "1", "no such argument"), "command line: tolerance = 1: no such argument; mend it");
    }

    #[test]
    fn what_it_leads_to_is_told_where_it_leads_there() {
        let file = || Origin::new("p.yaml", 9);
        check(
            file(),
            ("bed.seed", "\"abc\"", "is a string"),
            "square.yaml:5: arguments.seed = abc: p.yaml:9: bed.seed = \"abc\": is a string; mend it",
        );
        check(
            file(),
            ("from", "$(var profile).yaml", "cannot read nonsense.yaml"),
            "square.yaml:6: arguments.profile = nonsense: p.yaml:9: from = $(var profile).yaml: cannot read nonsense.yaml; mend it",
        );
        check(
            file(),
            ("law", "x", "is no law"),
            "square.yaml:3: launch = square.launch.yaml: p.yaml:9: law = x: is no law; mend it",
        );
    }

    #[test]
    fn the_command_line_wins() {
        let given = [("seed".to_owned(), "7".to_owned())];
        let left: Vec<String> = launch().overridden_by(&given).pairs().into_iter().map(|(name, _)| name).collect();
        assert_eq!(left, ["profile", "bed"]);
    }
}
