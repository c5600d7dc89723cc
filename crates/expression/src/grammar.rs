//! What may be written: sums, products, powers, names, calls, parentheses.

/// A parsed expression; `at` is a byte offset into the text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Node {
    Number { value: f64, at: usize },
    Name { name: String, at: usize },
    Call { name: String, at: usize, arguments: Vec<Node> },
    Negate(Box<Node>),
    Binary { sign: Sign, at: usize, operands: Box<(Node, Node)> },
}

/// An operator between two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sign {
    Plus,
    Minus,
    Times,
    Over,
    ToThe,
}

impl Node {
    fn binary(sign: Sign, at: usize, left: Self, right: Self) -> Self {
        Self::Binary { sign, at, operands: Box::new((left, right)) }
    }

    fn chain(first: Self, rest: Vec<(usize, Sign, Self)>) -> Self {
        rest.into_iter().fold(first, |left, (at, sign, right)| Self::binary(sign, at, left, right))
    }
}

peg::parser! {
    pub(crate) grammar language() for str {
        pub(crate) rule expression() -> Node = _ node:sum() _ { node }

        rule sum() -> Node = first:product() rest:(_ at:position!() sign:plus_or_minus() _ next:product() { (at, sign, next) })* {
            Node::chain(first, rest)
        }

        rule product() -> Node = first:signed() rest:(_ at:position!() sign:times_or_over() _ next:signed() { (at, sign, next) })* {
            Node::chain(first, rest)
        }

        /// A sign binds less than a power: -x^2 is -(x^2).
        rule signed() -> Node
            = minus() _ node:signed() { Node::Negate(Box::new(node)) }
            / plus() _ node:signed() { node }
            / power()

        rule power() -> Node = base:operand() exponent:(_ at:position!() to_the() _ next:signed() { (at, next) })? {
            match exponent {
                Some((at, exponent)) => Node::binary(Sign::ToThe, at, base, exponent),
                None => base,
            }
        }

        rule operand() -> Node
            = at:position!() value:number() { Node::Number { value, at } }
            / at:position!() name:name() arguments:(_ "(" _ list:(sum() ** (_ "," _)) _ ")" { list })? {
                match arguments {
                    Some(arguments) => Node::Call { name, at, arguments },
                    None => Node::Name { name, at },
                }
            }
            / "(" _ node:sum() _ ")" { node }

        rule plus_or_minus() -> Sign = quiet!{ "+" { Sign::Plus } / "-" { Sign::Minus } } / expected!("an operator")
        rule times_or_over() -> Sign = quiet!{ "*" !"*" { Sign::Times } / "/" { Sign::Over } } / expected!("an operator")
        rule to_the() = quiet!{ "^" / "**" } / expected!("an operator")

        rule number() -> f64 = quiet!{ text:$((digits() ("." digits()?)? / "." digits()) (['e' | 'E'] ['+' | '-']? digits())?) {?
            text.parse().or(Err("a number"))
        } } / expected!("a number")
        rule minus() = quiet!{ "-" }
        rule plus() = quiet!{ "+" }
        rule digits() = ['0'..='9']+

        rule name() -> String = quiet!{ text:$(['a'..='z' | 'A'..='Z' | '_'] ['a'..='z' | 'A'..='Z' | '_' | '0'..='9']*) {
            text.to_owned()
        } } / expected!("a name")

        rule _() = quiet!{ [' ' | '\t' | '\n' | '\r']* }
    }
}
