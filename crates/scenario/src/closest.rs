//! How near the robots of a team come to each other, without looking at all pairs.

use std::ops::Range;
use trench_formation::kinematics::PointState;
use trench_formation::simulate::Neighbours;
use trench_formation::zoning::{Zone, Zoning};

/// How much farther than needed neighbours are sought, so that their lists last.
const WIDER: f64 = 1.5;

/// Lists that reach this much farther than needed are made anew.
const TOO_WIDE: f64 = 4.0;

/// The least distance of any two robots of a team so far.
#[derive(Debug, Clone)]
pub(crate) struct Closest {
    neighbours: Neighbours,
    /// Up to where neighbours are sought, m.
    range: f64,
    /// m; infinite before two robots were seen.
    least: f64,
}

impl Default for Closest {
    fn default() -> Self {
        Self { neighbours: Neighbours::default(), range: 0.0, least: f64::INFINITY }
    }
}

impl Closest {
    /// m.
    pub(crate) fn least(&self) -> f64 {
        self.least
    }

    /// Seeks who is near whom in a team; whether any pair can say anything new.
    pub(crate) fn prepare(&mut self, team: &[PointState], zoning: Option<&Zoning>) -> bool {
        // No pair beyond the nearest so far, or of some, nor beyond zone 1, says anything new.
        let some = || team.windows(2).map(|pair| (pair[1].position - pair[0].position).norm());
        let nearest = if self.least.is_finite() { self.least } else { some().fold(self.least, f64::min) };
        let needed = nearest.max(zoning.map_or(0.0, |zoning| zoning.radii().rho_underbar));
        if !needed.is_finite() {
            return false;
        }
        // Nobody is nearer than in the same place.
        if needed <= 0.0 {
            self.least = 0.0;
            return false;
        }
        if !(needed..=TOO_WIDE * needed).contains(&self.range) {
            self.range = WIDER * needed;
        }
        self.neighbours.update(self.range, team, &[]);
        true
    }

    /// Looks at some robots of the team that was prepared, and at their neighbours before them; calls `forbidden` for each pair in zone 1.
    #[inline]
    pub(crate) fn take(
        &mut self,
        team: &[PointState],
        some: Range<usize>,
        zoning: Option<&Zoning>,
        mut forbidden: impl FnMut(),
    ) {
        for (index, robot) in some.clone().zip(&team[some]) {
            for &mate in self.neighbours.of(index).iter().take_while(|mate| (**mate as usize) < index) {
                let distance = (team[mate as usize].position - robot.position).norm();
                self.least = self.least.min(distance);
                if zoning.is_some_and(|zoning| zoning.zone(distance) == Zone::Forbidden) {
                    forbidden();
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trench_formation::Vector2;

    fn at(x: f64, y: f64) -> PointState {
        PointState::at_rest(Vector2::new(x, y))
    }

    proptest! {
        /// The same bits as from all pairs, however robots move, and whether or not there are zones.
        #[test]
        fn all_pairs_say_the_same(
            starts in prop::collection::vec((-20.0..20.0_f64, -20.0..20.0_f64), 0..40),
            moves in prop::collection::vec((-2.0..2.0_f64, -2.0..2.0_f64), 40),
            zoned in any::<bool>(),
        ) {
            let zoning = zoned.then(zoning);
            let mut team: Vec<PointState> = starts.iter().map(|(x, y)| at(*x, *y)).collect();
            let (mut closest, mut seconds) = (Closest::default(), 0);
            let (mut least, mut expected) = (f64::INFINITY, 0);
            for step in 0..12 {
                if closest.prepare(&team, zoning.as_ref()) {
                    let half = team.len() / 2;
                    closest.take(&team, 0..half, zoning.as_ref(), || seconds += 1);
                    closest.take(&team, half..team.len(), zoning.as_ref(), || seconds += 1);
                }
                for (index, robot) in team.iter().enumerate() {
                    for mate in &team[..index] {
                        let distance = (mate.position - robot.position).norm();
                        least = least.min(distance);
                        expected += i32::from(zoning.is_some_and(|zoning| zoning.zone(distance) == Zone::Forbidden));
                    }
                }
                prop_assert_eq!(closest.least().to_bits(), least.to_bits());
                prop_assert_eq!(seconds, expected);
                for (robot, (x, y)) in team.iter_mut().zip(&moves) {
                    robot.position += Vector2::new(*x, *y) * if step % 3 == 0 { 1.0 } else { -0.3 };
                }
            }
        }
    }

    fn zoning() -> Zoning {
        let text = include_str!("../../../config/scenarios/7.10.yaml");
        let scenario = crate::parse("7.10.yaml", text).unwrap_or_else(|error| unreachable!("{error}"));
        *scenario.zoning().unwrap_or_else(|| unreachable!("7.10 has zones"))
    }

    #[test]
    fn robots_in_the_same_place_are_no_trouble() {
        let mut closest = Closest::default();
        for x in [1.0, 2.0] {
            let team = [at(1.0, 1.0), at(x, 1.0)];
            if closest.prepare(&team, None) {
                closest.take(&team, 0..2, None, || {});
            }
            assert_eq!(closest.least(), 0.0);
        }
        let mut alone = Closest::default();
        assert!(!alone.prepare(&[at(1.0, 1.0)], None));
        assert_eq!(alone.least(), f64::INFINITY);
    }
}
