//! A Rust file as the tokens that run in production: no comments, no texts, nothing under `#[cfg(test)]`.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// A word, a sign or a bracket, and its line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Token {
    pub(crate) text: String,
    pub(crate) line: usize,
}

/// The tokens of `source`, brackets included.
pub(crate) fn production_tokens(source: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    append(source.parse().unwrap(), &mut tokens);
    tokens
}

fn append(stream: TokenStream, tokens: &mut Vec<Token>) {
    let mut trees = stream.into_iter().peekable();
    while let Some(tree) = trees.next() {
        let line = tree.span().start().line;
        match tree {
            TokenTree::Punct(sign) if sign.as_char() == '#' => {
                if trees.next().is_some_and(|attribute| is_test(&attribute)) {
                    skip_item(&mut trees);
                }
            }
            TokenTree::Group(group) => {
                let (open, close) = brackets(group.delimiter());
                tokens.push(Token { text: open.to_owned(), line });
                append(group.stream(), tokens);
                tokens.push(Token { text: close.to_owned(), line: group.span_close().start().line });
            }
            // A text or a number means nothing here, but it parts what stands before and behind it.
            TokenTree::Literal(_) => tokens.push(Token { text: String::new(), line }),
            word_or_sign => tokens.push(Token { text: word_or_sign.to_string(), line }),
        }
    }
}

fn is_test(attribute: &TokenTree) -> bool {
    attribute.to_string().replace(' ', "") == "[cfg(test)]"
}

/// Passes over an item: to its body in braces, or to its semicolon.
fn skip_item(trees: &mut impl Iterator<Item = TokenTree>) {
    trees.find(|tree| match tree {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        tree => tree.to_string() == ";",
    });
}

fn brackets(delimiter: Delimiter) -> (&'static str, &'static str) {
    match delimiter {
        Delimiter::Parenthesis => ("(", ")"),
        Delimiter::Brace => ("{", "}"),
        Delimiter::Bracket => ("[", "]"),
        Delimiter::None => ("", ""),
    }
}
