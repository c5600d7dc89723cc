//! What happens at the edge of a zone: does the force jump there, does the robot go to and fro.

/// A distance this near to the edge (m) is at the edge.
const NEAR: f64 = 0.1;
/// Slower changes of the distance (m in a step) are rest.
const REST: f64 = 1e-9;

/// One robot at the edge of one zone.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Edges {
    last: Option<(f64, f64)>,
    outward: Option<bool>,
    /// Steps over the edge at which the force changed by more than asked about.
    pub(crate) jumps: u32,
    /// Times that the distance began to grow or to shrink near the edge.
    pub(crate) reversals: u32,
}

impl Edges {
    /// The next step: `distance` (m) and the force of the zone there (m/s^2), with the zone's edge at `edge` (m) and a jump that counts.
    pub(crate) fn see(&mut self, (distance, force): (f64, f64), edge: f64, jump: f64) {
        if let Some((before, force_before)) = self.last {
            let crossed = (before < edge) != (distance < edge);
            self.jumps += u32::from(crossed && (force - force_before).abs() > jump);
            if (distance - before).abs() > REST {
                let outward = distance > before;
                let turned = self.outward.is_some_and(|was| was != outward);
                self.reversals += u32::from(turned && (distance - edge).abs() < NEAR);
                self.outward = Some(outward);
            }
        }
        self.last = Some((distance, force));
    }
}

/// Jumps and reversals of all.
pub(crate) fn counted<'a>(all: impl IntoIterator<Item = &'a Edges>) -> (u32, u32) {
    all.into_iter().fold((0, 0), |(jumps, reversals), one| (jumps + one.jumps, reversals + one.reversals))
}
