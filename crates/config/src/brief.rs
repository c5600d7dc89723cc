//! Messages that fit on a screen, whatever a file says.

/// Numbers of more digits than tell them apart are written with an exponent.
const MOST_DIGITS: usize = 24;

/// `text` with what is in the middle left out where it has more than `most` characters.
pub(crate) fn elided(text: &str, most: usize) -> String {
    let count = text.chars().count();
    if count <= most {
        return text.to_owned();
    }
    let (head, tail) = (2 * most / 3, most / 3);
    let start: String = text.chars().take(head).collect();
    let end: String = text.chars().skip(count - tail).collect();
    format!("{start} ... ({} characters) ... {end}", count - head - tail)
}

/// `text` with its endless numbers, as 1 with 308 zeros behind it, as 1e308.
pub(crate) fn with_short_numbers(text: &str) -> String {
    let mut brief = String::with_capacity(text.len());
    let mut rest = text;
    let is_digit = |letter: char| letter.is_ascii_digit() || letter == '.';
    while let Some(start) = rest.find(is_digit) {
        let end = rest[start..].find(|letter| !is_digit(letter)).map_or(rest.len(), |length| start + length);
        let number = &rest[start..end];
        let value = if number.len() > MOST_DIGITS { number.parse::<f64>().ok() } else { None };
        brief.push_str(&rest[..start]);
        match value {
            Some(value) => brief.push_str(&format!("{value:e}")),
            None => brief.push_str(number),
        }
        rest = &rest[end..];
    }
    brief.push_str(rest);
    brief
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_lose_their_middle() {
        assert_eq!(elided("short", 9), "short");
        assert_eq!(elided(&"ab".repeat(50), 9), "ababab ... (91 characters) ... bab");
        assert_eq!(elided("ärgerlicher", 6), "ärge ... (5 characters) ... er");
    }

    #[test]
    fn long_numbers_get_exponents() {
        let check = |text: String, expected: &str| assert_eq!(with_short_numbers(&text), expected);
        check(format!("is {} m, but", 1e308), "is 1e308 m, but");
        check(format!("is -{} m", 1.5e-300), "is -1.5e-300 m");
        check(format!("from {} to {}.", 0.1 + 0.2, 12.5), "from 0.30000000000000004 to 12.5.");
        check("..........................".to_owned(), "..........................");
    }
}
