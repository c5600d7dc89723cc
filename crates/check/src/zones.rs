//! The five zones of Fig. 6.1.

use crate::Verdict;
use crate::verdict::number;
use trench_formation::zoning::Radii;

const EQUATION: &str = "2 R <= rho_underbar < rho_hat < rho < rho_check <= rho_bar (6.2.2)";

/// Judges the radii (m) of the zones around robots of a radius (m), 0 where none is named.
pub fn zones(subject: &str, radii: [f64; 5], robot_radius: f64) -> Verdict {
    let [rho_underbar, rho_hat, rho, rho_check, rho_bar] = radii;
    let numbers = radii.map(number).join(" < ");
    match Radii::new(rho_underbar, rho_hat, rho, rho_check, rho_bar) {
        Err(wrong) => Verdict::new("zones", subject, false, wrong.to_string(), EQUATION),
        Ok(_) if rho_underbar < 2.0 * robot_radius => {
            let (underbar, touch) = (number(rho_underbar), number(2.0 * robot_radius));
            let finding =
                format!("rho_underbar = {underbar} m, but bodies touch at {touch} m: make it at least {touch}");
            Verdict::new("zones", subject, false, finding, EQUATION)
        }
        Ok(_) => {
            let bodies = if robot_radius > 0.0 {
                format!("bodies touch at {} m", number(2.0 * robot_radius))
            } else {
                "no body is named, points never touch".to_owned()
            };
            let finding = format!("{numbers} m are in order; {bodies}");
            Verdict::new("zones", subject, true, finding, EQUATION)
        }
    }
}
