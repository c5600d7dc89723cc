//! Which pad belongs to which robot, and whether there is doubt about it.
//!
//! Every (robot, pad) hypothesis costs minus twice its log likelihood. The assignment with the least total cost wins; a
//! robot whose place in it could be exchanged at little more cost is in doubt.

use super::assignment::assign;
use super::pairing::Pair;
use super::tracker::Track;
use nalgebra::{Matrix3, Vector3};
use trench_optics::Pose2;

/// What a robot may do between frames beyond its filter's model, when it is pushed or starts and stops: standard
/// deviations, m, m, rad. A fraction of the 0.16 m that two robots are apart at least.
const ALLOWANCE: [f64; 3] = [0.015, 0.015, 0.15];
/// Squared distance (3 degrees of freedom) beyond which a pad is not the robot's.
const GATE: f64 = 25.0;
/// More than the greatest cost of a hypothesis (gate, and the widest spread of `Filter::rest`): it is always better to
/// match one more robot.
const WORTH: f64 = 60.0;

/// What it costs to assume that a robot seen in the last frame is hidden in this one.
const VANISHED: f64 = 14.0;

/// The costs of all hypotheses of a frame; None where a pad cannot be the robot's.
pub(super) struct Hypotheses {
    costs: Vec<Vec<Option<f64>>>,
    was_seen: Vec<bool>,
    pads: usize,
}

impl Hypotheses {
    /// An exchange that costs less than this is as good: a likelihood ratio of e^6.
    pub(super) const MARGIN: f64 = 12.0;

    pub(super) fn new(tracks: &[Track], pairs: &[Pair], measurement: &Matrix3<f64>) -> Self {
        // Robots whose pad was read in this frame have it.
        let costs = |track: &Track| {
            let cost = |pair: &Pair| if track.code_read { None } else { track.cost(pair.pose, measurement) };
            pairs.iter().map(cost).collect()
        };
        let costs = tracks.iter().map(costs).collect();
        Self { costs, was_seen: tracks.iter().map(|track| track.was_seen).collect(), pads: pairs.len() }
    }

    /// For each robot its pad in the best assignment.
    pub(super) fn best(&self) -> Vec<Option<usize>> {
        assign(self.costs.len(), self.pads, |robot, pad| self.costs[robot][pad].map(|cost| WORTH - cost))
    }

    /// How good an assignment is as a whole: a robot more counts for more than any cost.
    pub(super) fn worth(&self, matched: &[Option<usize>]) -> f64 {
        let pads = self.costs.iter().zip(matched).filter_map(|(costs, pad)| costs[(*pad)?]);
        pads.map(|cost| WORTH - cost).sum()
    }

    /// For each robot whether another assignment is nearly as good.
    pub(super) fn doubtful(&self, matched: &[Option<usize>]) -> Vec<bool> {
        let mut doubtful = vec![false; matched.len()];
        for (robot, own) in matched.iter().enumerate() {
            let Some(own) = *own else { continue };
            let Some(own_cost) = self.costs[robot][own] else { continue };
            // A free pad that it could be instead.
            for pad in (0..self.pads).filter(|pad| !matched.contains(&Some(*pad))) {
                doubtful[robot] |= self.costs[robot][pad].is_some_and(|cost| cost - own_cost < Self::MARGIN);
            }
            for (other, others) in matched.iter().enumerate().filter(|(other, _)| *other != robot) {
                let Some(other_here) = self.costs[other][own] else { continue };
                let exchange = match *others {
                    // An unseen robot that could be here instead, this one being hidden.
                    None if self.was_seen[robot] => Some(other_here - own_cost + VANISHED),
                    None => Some(other_here - own_cost),
                    // One that could have changed places with it.
                    Some(theirs) => {
                        let here = self.costs[robot][theirs].zip(self.costs[other][theirs]);
                        here.map(|(robot_there, other_there)| robot_there + other_here - own_cost - other_there)
                    }
                };
                doubtful[robot] |= exchange.is_some_and(|extra| extra < Self::MARGIN);
            }
        }
        doubtful
    }
}

impl Track {
    /// Minus twice the log likelihood that this robot is at `pose`, up to a constant; None beyond the gate.
    fn cost(&self, pose: Pose2, measurement: &Matrix3<f64>) -> Option<f64> {
        let (difference, spread) = self.filter.as_ref()?.innovation(pose, measurement);
        let allowance = Matrix3::from_diagonal(&Vector3::from(ALLOWANCE.map(|sigma| sigma * sigma)));
        let spread = spread + allowance;
        let distance2 = difference.dot(&(spread.try_inverse()? * difference));
        let widening = spread.determinant() / allowance.determinant();
        (distance2 < GATE).then(|| distance2 + libm::log(widening))
    }

    /// From 0 to 1, how well this robot fits at `pose`; None beyond the gate.
    pub(super) fn fit(&self, pose: Pose2, measurement: &Matrix3<f64>) -> Option<f64> {
        self.cost(pose, measurement).map(|cost| (1.0 - cost / WORTH).clamp(0.0, 1.0))
    }
}
