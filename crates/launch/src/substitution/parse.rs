//! From text to template, by the grammar of ROS 2's launch (`grammar.lark`): a backslash takes the special meaning from
//! the next letter; arguments are separated by one space and may stand in quotes.

use super::{Part, Template};

/// Substitutions nested deeper than this are refused; parsing them recurses.
const DEEPEST: usize = 32;

impl Template {
    /// Parses `text`; the error says what is wrong with it.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let letters: Vec<char> = text.chars().collect();
        Parser { letters: &letters, at: 0, depth: 0 }.template(None)
    }
}

struct Parser<'a> {
    letters: &'a [char],
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    /// Parts up to the end of the text, or up to the quote that ends a quoted argument.
    fn template(&mut self, quote: Option<char>) -> Result<Template, String> {
        self.parts(|letter| Some(letter) == quote, quote.is_some())
    }

    /// Parts up to the first letter for which `ends` holds, outside of substitutions and not escaped.
    fn parts(&mut self, ends: impl Fn(char) -> bool, must_end: bool) -> Result<Template, String> {
        let mut parts = Vec::new();
        let mut text = String::new();
        loop {
            match (self.peek(0), self.peek(1)) {
                (None, _) if must_end => return Err("a quote or parenthesis is not closed".to_owned()),
                (None, _) => break,
                (Some('\\'), Some(escaped)) => {
                    text.push(escaped);
                    self.at += 2;
                }
                (Some('$'), Some('(')) => {
                    if !text.is_empty() {
                        parts.push(Part::Text(std::mem::take(&mut text)));
                    }
                    parts.push(self.call()?);
                }
                (Some(letter), _) if ends(letter) => break,
                (Some(letter), _) => {
                    text.push(letter);
                    self.at += 1;
                }
            }
        }
        if !text.is_empty() {
            parts.push(Part::Text(text));
        }
        Ok(Template(parts))
    }

    /// `$(name argument ...)`
    fn call(&mut self) -> Result<Part, String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("substitutions are nested deeper than {DEEPEST}"));
        }
        self.at += 2;
        let mut name = String::new();
        while let Some(letter) = self.peek(0).filter(|letter| letter.is_ascii_alphanumeric() || "_-".contains(*letter))
        {
            name.push(letter);
            self.at += 1;
        }
        if !name.starts_with(|first: char| first.is_ascii_alphabetic()) {
            return Err("a name must follow `$(`".to_owned());
        }
        let mut arguments = Vec::new();
        loop {
            match self.peek(0) {
                Some(')') => break,
                Some(' ') => {
                    self.at += 1;
                    arguments.push(self.argument()?);
                }
                Some(_) => return Err(format!("a space or `)` must follow `$({name}`")),
                None => return Err(format!("`$({name}` is not closed by `)`")),
            }
        }
        self.at += 1;
        self.depth -= 1;
        Ok(Part::Call { name, arguments })
    }

    fn argument(&mut self) -> Result<Template, String> {
        if let Some(quote @ ('"' | '\'')) = self.peek(0) {
            self.at += 1;
            let template = self.template(Some(quote))?;
            self.at += 1;
            return Ok(template);
        }
        let argument = self.parts(|letter| " )('\"".contains(letter), true)?;
        match (argument.0.is_empty(), self.peek(0)) {
            (true, _) => Err("an argument is empty: separate arguments by one space".to_owned()),
            (false, Some(' ' | ')')) => Ok(argument),
            (false, _) => Err("a quote or parenthesis inside an argument needs a backslash".to_owned()),
        }
    }

    fn peek(&self, ahead: usize) -> Option<char> {
        self.letters.get(self.at + ahead).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn text(text: &str) -> Part {
        Part::Text(text.to_owned())
    }

    fn call(name: &str, arguments: &[&[Part]]) -> Part {
        Part::Call {
            name: name.to_owned(),
            arguments: arguments.iter().map(|parts| Template(parts.to_vec())).collect(),
        }
    }

    #[test]
    fn parses_the_grammar_of_launch() {
        for (input, expected) in [
            ("", vec![]),
            ("plain $5 text)", vec![text("plain $5 text)")]),
            ("$(dirname)/show", vec![call("dirname", &[]), text("/show")]),
            ("a$(var b)c", vec![text("a"), call("var", &[&[text("b")]]), text("c")]),
            ("$(env A $(var b)/c)", vec![call("env", &[&[text("A")], &[call("var", &[&[text("b")]]), text("/c")]])]),
            ("$(env A 'two words')", vec![call("env", &[&[text("A")], &[text("two words")]])]),
            (
                "$(env A \"it's $(var b)\")",
                vec![call("env", &[&[text("A")], &[text("it's "), call("var", &[&[text("b")]])]])],
            ),
            ("\\$(var b)", vec![text("$(var b)")]),
            ("$(env A '')", vec![call("env", &[&[text("A")], &[]])]),
        ] {
            assert_eq!(Template::parse(input), Ok(Template(expected)), "{input}");
        }
    }

    #[test]
    fn says_what_is_wrong() {
        for (input, expected) in [
            ("$(var a", "a quote or parenthesis is not closed"),
            ("$(", "a name must follow `$(`"),
            ("$(9)", "a name must follow `$(`"),
            ("$(var,a)", "a space or `)` must follow `$(var`"),
            ("$(var  a)", "an argument is empty: separate arguments by one space"),
            ("$(env A 'b)", "a quote or parenthesis is not closed"),
            ("$(env A b'c)", "a quote or parenthesis inside an argument needs a backslash"),
            ("$(dirname", "`$(dirname` is not closed by `)`"),
        ] {
            assert_eq!(Template::parse(input), Err(expected.to_owned()), "{input}");
        }
        assert!(Template::parse(&"$(var ".repeat(1000)).unwrap_err().contains("nested deeper"));
    }

    proptest! {
        #[test]
        fn no_text_makes_it_panic(text in "[$()a '\"\\\\]{0,40}") {
            let _ = Template::parse(&text);
        }
    }
}
