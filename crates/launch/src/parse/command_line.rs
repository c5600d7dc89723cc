//! Splitting a command line into words, as the real `ros2 launch` does: the texts between substitutions are split like
//! a shell would, one by one; a substitution is never split, and joins the text it touches.

use super::Text;
use crate::substitution::{Part, Template};
use trench_config::ConfigError;

/// One word of a command line: the parts that make it up.
pub(crate) type Word = Template;

/// The words of `text`. Quotes around a substitution are an error, as they are there: a text with an unclosed quote.
pub(crate) fn words(text: &Text<'_>) -> Result<Vec<Word>, ConfigError> {
    let mut words = Vec::new();
    let mut word: Vec<Part> = Vec::new();
    for part in &text.template.0 {
        match part {
            Part::Call { .. } => word.push(part.clone()),
            Part::Text(piece) => {
                let tokens = shlex::split(piece).ok_or_else(|| {
                    text.node
                        .error("has a quote that is not closed", "close it; a substitution needs no quotes around it")
                })?;
                if piece.starts_with(char::is_whitespace) && !word.is_empty() {
                    words.push(Template(std::mem::take(&mut word)));
                }
                for (index, token) in tokens.iter().enumerate() {
                    if index > 0 {
                        words.push(Template(std::mem::take(&mut word)));
                    }
                    word.push(Part::Text(token.clone()));
                }
                if piece.ends_with(char::is_whitespace) && !word.is_empty() {
                    words.push(Template(std::mem::take(&mut word)));
                }
            }
        }
    }
    if !word.is_empty() {
        words.push(Template(word));
    }
    Ok(words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_config::Origin;
    use trench_config::yaml::{Node, Value};

    fn split(text: &str) -> Result<Vec<String>, String> {
        let value = Value::Scalar { text: text.to_owned(), plain: false };
        let node = Node { value, origin: Origin::default(), path: String::new() };
        let show = |word: &Word| {
            let show_part = |part: &Part| match part {
                Part::Text(text) => text.clone(),
                Part::Call { name, .. } => format!("<{name}>"),
            };
            word.0.iter().map(show_part).collect::<String>()
        };
        words(&Text::parse(&node).unwrap()).map(|words| words.iter().map(show).collect()).map_err(|error| error.problem)
    }

    #[test]
    fn splits_like_ros2_launch() {
        for (text, expected) in [
            ("one 'two three' four", vec!["one", "two three", "four"]),
            ("$(dirname)/show one $(var a)", vec!["<dirname>/show", "one", "<var>"]),
            ("$(var a) $(var b)", vec!["<var>", "<var>"]),
            ("a=$(var a),b=$(var b) c", vec!["a=<var>,b=<var>", "c"]),
            ("  x  ", vec!["x"]),
            ("a ''", vec!["a", ""]),
        ] {
            assert_eq!(split(text), Ok(expected.into_iter().map(str::to_owned).collect()), "{text}");
        }
        assert_eq!(split("a '$(var b)'"), Err("has a quote that is not closed".to_owned()));
    }
}
