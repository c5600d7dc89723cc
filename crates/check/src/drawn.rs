//! How near followers come to their leaders that begin far from them.

use crate::stopping::closing;
use trench_formation::kinematics::PointState;
use trench_formation::laws::Capability;
use trench_formation::zoning::{Zone, Zoning};

/// Steps in which the way to the leader is looked at.
const STEPS: u32 = 10_000;
/// Halvings that find what would be right.
const HALVINGS: u32 = 30;
/// Share of what would just be right that is named.
const SAFELY: f64 = 0.99;

/// A chain whose followers are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drawn<'a> {
    /// By rank.
    pub(crate) robots: &'a [PointState],
    pub(crate) zoning: &'a Zoning,
    /// k + c: what slows a robot down before a leader that rests, 1/s.
    pub(crate) damping: f64,
    pub(crate) limits: Option<Capability>,
    /// The largest pull of the trench, m/s^2.
    pub(crate) pull: f64,
}

/// One follower in zone 4 or 5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pair {
    /// Index of the follower.
    pub(crate) index: usize,
    /// m.
    pub(crate) distance: f64,
    /// How fast it comes nearer, m/s.
    pub(crate) closing: f64,
}

impl Drawn<'_> {
    /// Those that begin in zones 4 and 5, nearer than where links end.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = Pair> + '_ {
        let pair = |(index, pair): (usize, &[PointState])| {
            let apart = pair[0].position - pair[1].position;
            let closing = closing(pair[1].velocity - pair[0].velocity, apart).max(0.0);
            Pair { index: index + 1, distance: apart.norm(), closing }
        };
        let is_drawn = |pair: &Pair| matches!(self.zone(pair), Zone::Attractive | Zone::Margin);
        self.robots.windows(2).enumerate().map(pair).filter(is_drawn)
    }

    pub(crate) fn zone(&self, pair: &Pair) -> Zone {
        self.zoning.zone(pair.distance)
    }

    /// How near a follower comes to a leader that rests, m, where zones push and pull with no more than `full` (m/s^2), and how fast it
    /// becomes, m/s. Energy over distance, in steps that no damping makes unstable: v v' = force - (k + c) v.
    pub(crate) fn approach(&self, pair: &Pair, full: f64) -> (f64, f64) {
        let (most, fastest) = self.limits.map_or((f64::INFINITY, f64::INFINITY), |it| (it.acceleration, it.speed));
        let step = pair.distance / f64::from(STEPS);
        let lost = step * self.damping;
        let (mut speed, mut greatest) = (pair.closing, pair.closing);
        for index in 0..STEPS {
            let distance = pair.distance - f64::from(index) * step;
            let force = self.zoning.force(distance).clamp(-full, full);
            let energy = 0.5 * speed * speed;
            let left = energy + step * force;
            // Who has less left than a step stops in it.
            let rests = force <= 0.0 && speed <= lost;
            let wanted = if left > 0.0 { libm::sqrt(lost * lost + 2.0 * left) - lost } else { 0.0 };
            let next = (0.5 * wanted * wanted).max(energy - step * most).min(energy + step * most);
            if rests || next <= 0.0 {
                return (distance, greatest);
            }
            speed = libm::sqrt(2.0 * next);
            // Limits brake who is faster, and let nobody become so.
            if force > 0.0 {
                speed = speed.min(fastest.max(pair.closing));
            }
            greatest = greatest.max(speed);
        }
        (0.0, greatest)
    }

    /// Whether a follower stays outside of zone 2.
    pub(crate) fn is_borne(&self, pair: &Pair, full: f64) -> bool {
        self.approach(pair, full).0 >= self.zoning.radii().rho_hat
    }

    /// The largest full acceleration with which a follower, and all others, stay outside of zone 2, m/s^2; none where that is not above the
    /// trench's pull.
    pub(crate) fn bearable_force(&self, worst: &Pair) -> Option<f64> {
        let most = largest(self.pull, self.zoning.full_acceleration(), |full| self.is_borne(worst, full))?;
        let safe = SAFELY * most;
        (safe > self.pull && self.pairs().all(|pair| self.is_borne(&pair, safe))).then_some(safe)
    }

    /// From how far off a follower would stay outside of zone 2, m.
    pub(crate) fn bearable_distance(&self, pair: &Pair) -> Option<f64> {
        let full = self.zoning.full_acceleration();
        let bears = |distance: f64| self.is_borne(&Pair { distance, ..*pair }, full);
        largest(self.zoning.radii().rho, pair.distance, bears).map(|most| SAFELY * most)
    }
}

/// The largest number between two of which the smaller, but not the larger, is right.
fn largest(low: f64, high: f64, is_right: impl Fn(f64) -> bool) -> Option<f64> {
    if low >= high || !is_right(low) {
        return None;
    }
    let (mut low, mut high) = (low, high);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_right(middle) { low = middle } else { high = middle }
    }
    Some(low)
}
