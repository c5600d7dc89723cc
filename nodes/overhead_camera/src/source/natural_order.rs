//! The order in which a person counts: frame2.png before frame10.png.

use std::cmp::Ordering;
use std::iter::Peekable;
use std::str::Chars;

/// Compares names, runs of digits by their value. Equal values go by the number of leading zeros.
pub(super) fn compare(left: &str, right: &str) -> Ordering {
    let (mut a, mut b) = (left.chars().peekable(), right.chars().peekable());
    loop {
        let order = match (a.peek().copied(), b.peek().copied()) {
            (None, None) => return left.cmp(right),
            (Some(x), Some(y)) if x.is_ascii_digit() && y.is_ascii_digit() => {
                let (x, y) = (digits(&mut a), digits(&mut b));
                // Without leading zeros the longer number is the greater.
                x.len().cmp(&y.len()).then_with(|| x.cmp(&y))
            }
            (x, y) => {
                a.next();
                b.next();
                x.cmp(&y)
            }
        };
        if order != Ordering::Equal {
            return order;
        }
    }
}

/// Takes a run of digits, without its leading zeros.
fn digits(text: &mut Peekable<Chars<'_>>) -> String {
    let mut number = String::new();
    while let Some(digit) = text.next_if(char::is_ascii_digit) {
        if digit != '0' || !number.is_empty() {
            number.push(digit);
        }
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_count_as_numbers() {
        let mut names = ["b1", "a10.png", "a9.png", "a09.png", "a1b20", "a1b3", "a", "a99999999999999999999999", "ä1"];
        names.sort_by(|a, b| compare(a, b));
        let expected = ["a", "a1b3", "a1b20", "a09.png", "a9.png", "a10.png", "a99999999999999999999999", "b1", "ä1"];
        assert_eq!(names, expected);
        assert_eq!(compare("x01", "x01"), Ordering::Equal);
        assert_eq!(compare("x01", "x1"), compare("x1", "x01").reverse());
    }
}
