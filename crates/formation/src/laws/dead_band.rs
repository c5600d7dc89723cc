//! Where a robot may call itself arrived.

/// A dead band with hysteresis around the goal point: a robot within `hold` of it rests until it is beyond `resume`.
///
/// On the goal point no direction towards it exists, and close by the direction is noise: without the band (3.13) would
/// turn a robot on the spot for ever, by K2 times a random angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeadBand {
    /// Metres; 0 turns the band off.
    pub hold: f64,
    /// Metres, at least `hold`; noise below `resume - hold` never wakes a robot.
    pub resume: f64,
}

impl DeadBand {
    /// No dead band.
    pub const OFF: Self = Self { hold: 0.0, resume: 0.0 };

    /// Whether to rest at `distance` (m), given whether the robot rested until now.
    pub fn holds(self, distance: f64, held: bool) -> bool {
        distance < if held { self.resume } else { self.hold }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hysteresis() {
        let band = DeadBand { hold: 0.004, resume: 0.01 };
        let rests: Vec<bool> = [0.02, 0.005, 0.003, 0.009, 0.011, 0.005]
            .into_iter()
            .scan(false, |held, distance| {
                *held = band.holds(distance, *held);
                Some(*held)
            })
            .collect();
        assert_eq!(rests, [false, false, true, true, false, false]);
        assert!(!DeadBand::OFF.holds(0.0, true));
    }
}
