//! Assignment of robots to queues and places.
//!
//! [`split`] says how many robots a queue gets, [`solve`] which; [`keeps`] keeps noise from changing an assignment.
mod shares;
mod solve;

pub use shares::split;
pub use solve::{Optimum, solve};

/// Whether a present assignment of cost `present` stays in force against the best one of cost `best`: unless the best is
/// shorter by the fraction `relative` and by `absolute`. With costs that grow with distance, noise below the absolute
/// margin never makes two robots change places back and forth.
pub fn keeps(present: f64, best: f64, relative: f64, absolute: f64) -> bool {
    present - best <= absolute || best >= present * (1.0 - relative)
}

#[cfg(test)]
mod tests {
    use super::keeps;

    #[test]
    fn hysteresis() {
        assert!(keeps(1.0, 1.0, 0.2, 0.01));
        assert!(keeps(1.0, 0.9, 0.2, 0.01), "10 % is too little");
        assert!(!keeps(1.0, 0.7, 0.2, 0.01));
        assert!(keeps(0.001, 0.0001, 0.2, 0.01), "millimetres are noise");
    }
}
