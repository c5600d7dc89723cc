//! Which topics are meant: by name, by pattern, but for exceptions. The same words for recording and playing, as
//! `ros2 bag` has them.

use regex::Regex;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};

/// A choice of topics.
#[derive(Debug, Clone, Default)]
pub(crate) struct Selection {
    topics: Vec<String>,
    regex: Option<Regex>,
    exclude_topics: Vec<String>,
    exclude_regex: Option<Regex>,
}

/// The parameters that a node chooses topics by, besides `topics`.
pub(crate) fn parameters() -> [ParameterDescriptor; 3] {
    let regex = "topics that this regular expression finds, besides those named";
    let exclude_topics = "topics that are left out, whatever else names them";
    let exclude_regex = "topics that this regular expression finds are left out";
    [
        ParameterDescriptor::string("regex", "", regex).read_only(),
        ParameterDescriptor::string_list("exclude_topics", &[], exclude_topics).read_only(),
        ParameterDescriptor::string("exclude_regex", "", exclude_regex).read_only(),
    ]
}

impl Selection {
    /// Of these topics and what the parameters say.
    pub(crate) fn new(topics: Vec<String>, parameters: &Parameters) -> Result<Self, ConfigError> {
        Ok(Self {
            topics,
            regex: regex(parameters, "regex")?,
            exclude_topics: parameters.str_list("exclude_topics")?.to_vec(),
            exclude_regex: regex(parameters, "exclude_regex")?,
        })
    }

    /// Whether some topics are chosen; else all are, but for the exceptions.
    pub(crate) fn is_narrow(&self) -> bool {
        !self.topics.is_empty() || self.regex.is_some()
    }

    /// Whether this topic is among those chosen.
    pub(crate) fn takes(&self, topic: &str) -> bool {
        let found = |regex: &Option<Regex>| regex.as_ref().is_some_and(|regex| regex.is_match(topic));
        let named = |names: &[String]| names.iter().any(|name| name == topic);
        let is_chosen = !self.is_narrow() || named(&self.topics) || found(&self.regex);
        is_chosen && !named(&self.exclude_topics) && !found(&self.exclude_regex)
    }
}

fn regex(parameters: &Parameters, name: &str) -> Result<Option<Regex>, ConfigError> {
    let text = parameters.str(name)?;
    if text.is_empty() {
        return Ok(None);
    }
    let wrong = |error: regex::Error| parameters.error(name, error.to_string(), "write a regular expression");
    Regex::new(text).map(Some).map_err(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(topics: &[&str], regex: &str, exclude: &str, exclude_regex: &str, expected: &[&str]) {
        let compiled = |text: &str| (!text.is_empty()).then(|| Regex::new(text).unwrap());
        let selection = Selection {
            topics: topics.iter().map(|&topic| topic.to_owned()).collect(),
            regex: compiled(regex),
            exclude_topics: vec![exclude.to_owned()],
            exclude_regex: compiled(exclude_regex),
        };
        let all = ["/goals", "/robot1/odom", "/robot2/odom", "/rosout"];
        let taken: Vec<_> = all.into_iter().filter(|topic| selection.takes(topic)).collect();
        assert_eq!(taken, expected, "{selection:?}");
    }

    #[test]
    fn names_patterns_and_exceptions() {
        check(&[], "", "", "", &["/goals", "/robot1/odom", "/robot2/odom", "/rosout"]);
        check(&["/goals"], "", "", "", &["/goals"]);
        check(&["/goals"], "odom$", "", "", &["/goals", "/robot1/odom", "/robot2/odom"]);
        check(&[], "^/robot", "/robot2/odom", "", &["/robot1/odom"]);
        check(&["/goals"], "", "/goals", "", &[]);
        check(&[], "", "", "odom|rosout", &["/goals"]);
    }
}
