//! The numbers at the marks of an axis.

/// Digits behind the point that a number may have before it is written with an exponent.
const DECIMALS: usize = 4;

/// Marks of an axis, no two of which read the same.
#[derive(Clone, Copy)]
pub(super) struct Ticks {
    /// Marks are no nearer to each other.
    apart: f64,
    /// The greatest of all numbers on the axis, either sign.
    most: f64,
}

impl Ticks {
    /// Of an axis with so many marks at most: they are a one, two or five of some power of ten apart.
    pub(super) fn of((low, high): (f64, f64), marks: usize) -> Self {
        Self { apart: (high - low) / (marks + 1) as f64, most: low.abs().max(high.abs()) }
    }

    /// With as many digits as tell it from its neighbours.
    pub(super) fn label(self, value: f64) -> String {
        let decimals = (-self.apart.log10()).ceil().max(0.0) as usize;
        if decimals <= 3 {
            short(value)
        } else if value.abs() < 1e-3 * self.apart {
            "0".to_owned()
        } else if decimals <= DECIMALS || self.most >= 1.0 {
            trimmed(&format!("{value:.decimals$}")).to_owned()
        } else {
            let digits = (value.abs() / self.apart).log10().ceil().max(0.0) as usize;
            let text = format!("{value:.digits$e}");
            text.split_once('e').map_or(text.clone(), |(number, power)| format!("{}e{power}", trimmed(number)))
        }
    }
}

/// A number without trailing zeros and without a negative zero.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = trimmed(&text);
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Without zeros behind the last digit behind the point.
fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::coord::ranged1d::{BoldPoints, Ranged};
    use plotters::coord::types::RangedCoordf64;

    fn labels(low: f64, high: f64, marks: usize) -> Vec<(f64, String)> {
        let ticks = Ticks::of((low, high), marks);
        let points = RangedCoordf64::from(low..high).key_points(BoldPoints(marks));
        points.into_iter().map(|point| (point, ticks.label(point))).collect()
    }

    #[test]
    fn no_two_marks_read_the_same() {
        for marks in 3..=12 {
            for power in -12..=6 {
                for width in [1.0, 1.06, 1.9, 2.5, 3.3, 4.99, 6.0, 7.7, 9.4] {
                    for from in [0.0, -0.06, -0.5, 0.3, -37.2, 1.0e4] {
                        let size = width * 10.0_f64.powi(power);
                        // Beside a large number marks are no nearer than plotters can tell.
                        let low = if from == 1.0e4 { from } else { from * size };
                        if from == 1.0e4 && power < -6 {
                            continue;
                        }
                        let found = labels(low, low + size, marks);
                        for (index, (point, label)) in found.iter().enumerate() {
                            let read: f64 = label.parse().unwrap();
                            assert!((read - point).abs() <= 1e-3 * size, "{point} reads {label}");
                            assert!(found[..index].iter().all(|other| other.1 != *label), "{found:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        let of = |low: f64, high: f64| labels(low, high, 6).into_iter().map(|(_, label)| label).collect::<Vec<_>>();
        assert_eq!(of(-1.0, 1.0), ["-1", "-0.5", "0", "0.5", "1"]);
        assert_eq!(of(0.0, 0.0011), ["0", "0.0002", "0.0004", "0.0006", "0.0008", "0.001"]);
        assert_eq!(of(0.0, 5.3e-9), ["0", "1e-9", "2e-9", "3e-9", "4e-9", "5e-9"]);
        assert_eq!(of(9.9e-8, 1.11e-7), ["1e-7", "1.02e-7", "1.04e-7", "1.06e-7", "1.08e-7", "1.1e-7"]);
    }
}
