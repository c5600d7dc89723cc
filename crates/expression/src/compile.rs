//! From text to steps of a stack machine.
use crate::evaluate::STACK;
use crate::grammar::{Node, Sign, language};
use crate::{ExpressionError, Function, Taylor};
use core::fmt;
use std::sync::Arc;

/// Numbers with names.
pub const CONSTANTS: &[(&str, f64)] =
    &[("pi", core::f64::consts::PI), ("tau", core::f64::consts::TAU), ("e", core::f64::consts::E)];

/// Most characters of a text.
const LONGEST: usize = 1000;
/// Most parentheses within each other.
const DEEPEST: usize = 40;
/// Whole exponents up to this are repeated products.
const LARGEST_POWER: f64 = 64.0;

/// A function of one variable, `x`. Cheap to copy.
#[derive(Clone)]
pub struct Expression {
    source: Arc<str>,
    pub(crate) steps: Arc<[Step]>,
}

/// What to do with the top of the stack, and where it stands in the text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Step {
    pub(crate) action: Action,
    pub(crate) column: usize,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Action {
    Constant(f64),
    Variable,
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    /// A whole exponent.
    Power(i32),
    /// Any other constant exponent.
    RealPower(f64),
    /// An exponent that changes with x: e^(b ln a).
    GeneralPower,
    Apply(Function),
}

impl Expression {
    /// Reads `text`.
    ///
    /// # Errors
    /// When it is no expression in x: see [`ExpressionError`].
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        let too_large = ExpressionError::TooLarge { characters: LONGEST, depth: DEEPEST };
        if text.len() > LONGEST || depth(text) > DEEPEST {
            return Err(too_large);
        }
        let node = language::expression(text).map_err(|error| syntax(text, &error))?;
        let mut compiler = Compiler { text, steps: Vec::new(), used: 0, most: 0 };
        compiler.push(&node)?;
        if compiler.most > STACK {
            return Err(too_large);
        }
        Ok(Self { source: text.into(), steps: compiler.steps.into() })
    }

    /// The function whose graph is this one's, larger by `factor`: factor f(x / factor).
    ///
    /// # Errors
    /// When the text becomes too long, or `factor` is not finite.
    pub fn scaled(&self, factor: f64) -> Result<Self, ExpressionError> {
        let is_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        let mut text = format!("{factor:?}*(");
        let mut rest = &*self.source;
        while let Some(letter) = rest.chars().next() {
            let word = rest.find(|letter| !is_name(letter)).unwrap_or(rest.len()).max(letter.len_utf8());
            match &rest[..word] {
                "x" => text.push_str(&format!("(x/{factor:?})")),
                other => text.push_str(other),
            }
            rest = &rest[word..];
        }
        text.push(')');
        Self::parse(&text)
    }

    /// The text.
    pub fn source(&self) -> &str {
        &self.source
    }
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.source == other.source
    }
}

impl fmt::Debug for Expression {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Expression({:?})", self.source)
    }
}

/// How deep parentheses lie in each other.
fn depth(text: &str) -> usize {
    let (mut now, mut most) = (0_usize, 0);
    for letter in text.chars() {
        match letter {
            '(' => now += 1,
            ')' => now = now.saturating_sub(1),
            _ => {}
        }
        most = most.max(now);
    }
    most
}

fn column(text: &str, at: usize) -> usize {
    text.get(..at).map_or(0, |before| before.chars().count()) + 1
}

fn syntax(text: &str, error: &peg::error::ParseError<peg::str::LineCol>) -> ExpressionError {
    let at = error.location.offset;
    let found = match text.get(at..).and_then(|rest| rest.chars().next()) {
        Some(letter) => format!("`{letter}`"),
        None => "the end".to_owned(),
    };
    let mut expected: Vec<String> =
        error.expected.tokens().map(|token| token.replace('"', "`").replace("EOF", "the end")).collect();
    expected.sort_unstable();
    let last = expected.pop().unwrap_or_default();
    let expected = if expected.is_empty() { last } else { format!("{} or {last}", expected.join(", ")) };
    ExpressionError::Syntax { column: column(text, at), found, expected }
}

struct Compiler<'a> {
    text: &'a str,
    steps: Vec<Step>,
    /// Depth of the stack now, and at most.
    used: usize,
    most: usize,
}

impl Compiler<'_> {
    fn push(&mut self, node: &Node) -> Result<(), ExpressionError> {
        let begin = self.steps.len();
        match node {
            Node::Number { value, at } => self.number(*value, *at)?,
            Node::Name { name, at } => self.name(name, *at)?,
            Node::Call { name, at, arguments } => self.call(name, *at, arguments)?,
            Node::Negate(operand) => {
                self.push(operand)?;
                self.step(Action::Negate, 0, 1);
            }
            Node::Binary { sign, at, operands } => self.binary(*sign, *at, operands)?,
        }
        self.fold(begin, node.at())
    }

    fn step(&mut self, action: Action, at: usize, takes: usize) {
        self.steps.push(Step { action, column: column(self.text, at) });
        self.used = self.used + 1 - takes;
        self.most = self.most.max(self.used);
    }

    fn number(&mut self, value: f64, at: usize) -> Result<(), ExpressionError> {
        if !value.is_finite() {
            return Err(ExpressionError::NotFinite { column: column(self.text, at), value: value.to_string() });
        }
        self.step(Action::Constant(value), at, 0);
        Ok(())
    }

    fn name(&mut self, name: &str, at: usize) -> Result<(), ExpressionError> {
        if name == "x" {
            self.step(Action::Variable, at, 0);
            return Ok(());
        }
        if let Some((_, value)) = CONSTANTS.iter().find(|(known, _)| *known == name) {
            return self.number(*value, at);
        }
        match Function::named(name) {
            Some(function) => Err(self.wrong_arguments(name, at, function, 0)),
            None => Err(ExpressionError::UnknownName { column: column(self.text, at), name: name.to_owned() }),
        }
    }

    fn call(&mut self, name: &str, at: usize, arguments: &[Node]) -> Result<(), ExpressionError> {
        let Some(function) = Function::named(name) else {
            return Err(ExpressionError::UnknownName { column: column(self.text, at), name: name.to_owned() });
        };
        if arguments.len() != function.arguments() {
            return Err(self.wrong_arguments(name, at, function, arguments.len()));
        }
        arguments.iter().try_for_each(|argument| self.push(argument))?;
        match function {
            Function::Clamp => {
                // The value and its bounds lie on the stack: min with the upper one, then max with the lower one.
                self.step(Action::Apply(Function::Clamp), at, 3);
            }
            _ => self.step(Action::Apply(function), at, arguments.len()),
        }
        Ok(())
    }

    fn wrong_arguments(&self, name: &str, at: usize, function: Function, got: usize) -> ExpressionError {
        let wanted = function.arguments();
        let expected = format!("{wanted} argument{} in parentheses", if wanted == 1 { "" } else { "s" });
        ExpressionError::Arguments { column: column(self.text, at), name: name.to_owned(), expected, got }
    }

    fn binary(&mut self, sign: Sign, at: usize, operands: &(Node, Node)) -> Result<(), ExpressionError> {
        self.push(&operands.0)?;
        self.push(&operands.1)?;
        let action = match sign {
            Sign::Plus => Action::Add,
            Sign::Minus => Action::Subtract,
            Sign::Times => Action::Multiply,
            Sign::Over => Action::Divide,
            Sign::ToThe => {
                if let Some(&Step { action: Action::Constant(exponent), .. }) = self.steps.last() {
                    self.steps.pop();
                    self.used -= 1;
                    let whole = libm::trunc(exponent) == exponent && exponent.abs() <= LARGEST_POWER;
                    let action = if whole { Action::Power(exponent as i32) } else { Action::RealPower(exponent) };
                    self.step(action, at, 1);
                    return Ok(());
                }
                Action::GeneralPower
            }
        };
        self.step(action, at, 2);
        Ok(())
    }

    /// Replaces the steps from `begin` on by their result if x is not among them.
    fn fold(&mut self, begin: usize, at: usize) -> Result<(), ExpressionError> {
        let steps = &self.steps[begin..];
        if steps.len() < 2 || self.most > STACK || steps.iter().any(|step| step.action == Action::Variable) {
            return Ok(());
        }
        let Taylor([value]) = crate::evaluate::run::<f64, 1>(steps, Taylor([0.0]), true, |_, _| {});
        if !value.is_finite() {
            return Err(ExpressionError::NotFinite { column: column(self.text, at), value: value.to_string() });
        }
        self.steps.truncate(begin);
        self.steps.push(Step { action: Action::Constant(value), column: column(self.text, at) });
        Ok(())
    }
}

impl Node {
    fn at(&self) -> usize {
        match self {
            Self::Number { at, .. } | Self::Name { at, .. } | Self::Call { at, .. } => *at,
            Self::Negate(operand) => operand.at(),
            Self::Binary { operands, .. } => operands.0.at(),
        }
    }
}
