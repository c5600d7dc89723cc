//! The five zones of Fig. 6.1.

/// Radii of the zones around a follower, metres, 0 < rho_underbar < rho_hat < rho < rho_check <= rho_bar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Radii {
    /// No other robot may come as near: the border of zone 1.
    pub rho_underbar: f64,
    /// Where the repulsive zone 2 ends.
    pub rho_hat: f64,
    /// Where the attractive zone 4 begins.
    pub rho: f64,
    /// Where zone 4 ends, at the pole of the attractive potential.
    pub rho_check: f64,
    /// The end of the team link, and of zone 5.
    pub rho_bar: f64,
}

/// Radii that make no zones.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RadiiError {
    /// A radius is not a positive number.
    #[error("{name} is {value}; it must be a positive, finite number of metres")]
    NotPositive {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// Two are out of order.
    #[error(
        "{inner_name} = {inner} and {outer_name} = {outer} are out of order (6.2.2): {inner_name} must be {relation} {outer_name}"
    )]
    Order {
        /// The one that should be smaller.
        inner_name: &'static str,
        /// Its value.
        inner: f64,
        /// The one that should be larger.
        outer_name: &'static str,
        /// Its value.
        outer: f64,
        /// "below" or "at most".
        relation: &'static str,
    },
}

/// Where the other robot is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Zone {
    /// Zone 1, d <= rho_underbar: too near.
    Forbidden,
    /// Zone 2: move away.
    Repulsive,
    /// Zone 3, rho_hat <= d <= rho.
    Neutral,
    /// Zone 4: come nearer.
    Attractive,
    /// Zone 5, rho_check <= d <= rho_bar: the margin of the team link.
    Margin,
    /// Beyond rho_bar: the link is lost.
    Beyond,
}

impl Radii {
    /// Checked radii.
    ///
    /// # Errors
    /// When one is not positive and finite, or two are out of order.
    pub fn new(rho_underbar: f64, rho_hat: f64, rho: f64, rho_check: f64, rho_bar: f64) -> Result<Self, RadiiError> {
        let named = [
            ("rho_underbar", rho_underbar),
            ("rho_hat", rho_hat),
            ("rho", rho),
            ("rho_check", rho_check),
            ("rho_bar", rho_bar),
        ];
        for (name, value) in named {
            if !(value.is_finite() && value > 0.0) {
                return Err(RadiiError::NotPositive { name, value });
            }
        }
        for (index, pair) in named.windows(2).enumerate() {
            let [(inner_name, inner), (outer_name, outer)] = [pair[0], pair[1]];
            let may_equal = index == 3;
            if inner > outer || (inner == outer && !may_equal) {
                let relation = if may_equal { "at most" } else { "below" };
                return Err(RadiiError::Order { inner_name, inner, outer_name, outer, relation });
            }
        }
        Ok(Self { rho_underbar, rho_hat, rho, rho_check, rho_bar })
    }

    /// The zone in which a robot at `distance` (m) is.
    #[inline]
    pub fn zone(&self, distance: f64) -> Zone {
        if distance <= self.rho_underbar {
            Zone::Forbidden
        } else if distance < self.rho_hat {
            Zone::Repulsive
        } else if distance <= self.rho {
            Zone::Neutral
        } else if distance < self.rho_check {
            Zone::Attractive
        } else if distance <= self.rho_bar {
            Zone::Margin
        } else {
            Zone::Beyond
        }
    }

    /// Whether a leader and its follower at `distance` (m) are part of a coordinated chain (6.2.2).
    pub fn is_coordinated(&self, distance: f64) -> bool {
        (self.rho_underbar..=self.rho_bar).contains(&distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_6_2_makes_five_zones() {
        let radii = Radii::new(1.0, 4.0, 10.0, 13.0, 30.0).unwrap();
        for (distance, zone) in [
            (1.0, Zone::Forbidden),
            (1.1, Zone::Repulsive),
            (4.0, Zone::Neutral),
            (10.0, Zone::Neutral),
            (12.9, Zone::Attractive),
            (13.0, Zone::Margin),
            (30.0, Zone::Margin),
            (30.1, Zone::Beyond),
        ] {
            assert_eq!(radii.zone(distance), zone, "{distance}");
        }
        assert!(radii.is_coordinated(1.0) && radii.is_coordinated(30.0) && !radii.is_coordinated(0.9));
    }

    fn check(radii: [f64; 5], expected: &str) {
        let [a, b, c, d, e] = radii;
        let text = Radii::new(a, b, c, d, e).map_err(|error| error.to_string());
        assert!(text.clone().is_err_and(|text| text.contains(expected)), "{text:?}");
    }

    #[test]
    fn bad_radii() {
        check([0.0, 4.0, 10.0, 13.0, 30.0], "rho_underbar is 0");
        check([1.0, f64::NAN, 10.0, 13.0, 30.0], "rho_hat is NaN");
        check([1.0, 4.0, 4.0, 13.0, 30.0], "rho_hat must be below rho");
        check([1.0, 4.0, 10.0, 31.0, 30.0], "rho_check must be at most rho_bar");
        assert!(Radii::new(1.0, 4.0, 10.0, 13.0, 13.0).is_ok());
    }
}
