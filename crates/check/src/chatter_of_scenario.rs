//! Whether robots that chatter about a kink stay as near to it as the scenario asks.

use crate::Verdict;
use crate::chatter::Kinked;
use crate::verdict::number;
use trench_formation::laws::Capability;
use trench_formation::simulate::Integration;
use trench_formation::trench::Trench;

const EQUATION: &str = "|lambda| h within the method's stability; about a kink 3 c h Phi'(0+)/(4 k) + h^2 Phi'(0+) within tolerance, c = 1 (semi-implicit Euler), 2 (held), 2/3 (rk4)";

/// A trench as robots feel it.
pub(crate) struct Felt<'a> {
    pub(crate) trench: &'a dyn Trench,
    /// k, 1/s, of the distance (m); without that towards a leader, which the first robot has not.
    pub(crate) damping: &'a dyn Fn(f64) -> f64,
    /// Of the angle across which it pulls.
    pub(crate) sine: f64,
    pub(crate) limits: Option<Capability>,
}

/// The verdict on a step (s) that the methods follow elsewhere, with what robots make of a kink.
pub(crate) fn with_chatter(
    verdict: Verdict,
    felt: &Felt<'_>,
    tolerance: f64,
    (step, method): (f64, Integration),
) -> Verdict {
    let kinked = Kinked::new(felt.trench, felt.damping, felt.sine, felt.limits.as_ref());
    let Some(kinked) = kinked.filter(|_| verdict.holds) else { return verdict };
    let amplitude = kinked.amplitude(step, method);
    let told = format!(
        "{}. The trench has a kink at its bottom, where it pulls with {} m/s^2, and no step is short enough for it: robots may chatter about it by \
         up to {} m",
        verdict.finding,
        number(kinked.pull),
        number(amplitude)
    );
    let within = number(tolerance);
    if amplitude <= tolerance {
        let finding = format!("{told}, within the tolerance of {within} m");
        return Verdict { note: true, finding, equation: EQUATION, ..verdict };
    }
    // Four digits may be rounded up.
    let mended = number(0.99 * kinked.step_within(tolerance, (step, method)));
    let finding = format!(
        "{told}, but the tolerance is {within} m, and whoever leaves it does not conform: make step {mended} or less, or take a trench without a \
         kink"
    );
    Verdict { holds: false, note: false, finding, equation: EQUATION, ..verdict }
}
