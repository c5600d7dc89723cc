//! Comments of a definition as Rust documentation.

/// Doc comment lines, indented; `fallback` where the definition says nothing.
pub(super) fn lines(comment: &[String], fallback: &str, indent: &str) -> String {
    let comment: Vec<String> = comment.iter().map(|line| escape(line)).collect();
    let text = comment.join("\n");
    let text = if text.trim().is_empty() { fallback } else { text.trim() };
    text.lines().map(|line| format!("{indent}/// {line}").trim_end().to_owned() + "\n").collect()
}

/// Comments are plain text: what Markdown or rustdoc would take for a link or a tag is escaped.
fn escape(line: &str) -> String {
    let mut text = String::with_capacity(line.len());
    for character in line.chars() {
        if matches!(character, '[' | ']' | '<' | '>' | '*' | '_' | '`' | '\\') {
            text.push('\\');
        }
        text.push(character);
    }
    text
}
