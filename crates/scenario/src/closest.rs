//! How near the robots of a team come to each other, without looking at all pairs.

use crate::room::rounding;
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::simulate::Neighbours;
use trench_formation::zoning::{Zone, Zoning};

/// How much farther than needed neighbours are sought, so that their lists last.
const WIDER: f64 = 1.2;

/// Looks at each robot, on average, after which neighbours are sought anew: that may give robots more room. Where it does not, twice as
/// many the next time, up to the second.
const PATIENCE: [usize; 2] = [8, 64];

/// The least distance of any two robots of a team so far. A robot need not be looked at while it and whoever is near it are where they
/// cannot have met.
#[derive(Debug, Clone)]
pub(crate) struct Closest {
    neighbours: Neighbours,
    /// Where each robot was when neighbours were sought, m.
    anchors: Vec<Vector2<f64>>,
    /// As far as each may go from there without coming nearer to another that does so too than was needed then, m.
    rooms: Vec<f64>,
    /// As far as any may go before the lists miss somebody, m.
    keeps: f64,
    /// Up to where pairs said something new then, m.
    needed: f64,
    /// Robots looked at since then, and how many of them, a robot, are too many.
    looks: usize,
    patience: usize,
    /// m; infinite before two robots were seen.
    least: f64,
}

impl Default for Closest {
    fn default() -> Self {
        Self {
            neighbours: Neighbours::default(),
            anchors: Vec::new(),
            rooms: Vec::new(),
            keeps: 0.0,
            needed: f64::INFINITY,
            looks: 0,
            patience: PATIENCE[0],
            least: f64::INFINITY,
        }
    }
}

impl Closest {
    /// m.
    pub(crate) fn least(&self) -> f64 {
        self.least
    }

    /// Seeks who is near whom in a team, if that is not known well enough for those who went `astray`; whether it was: then all have to be
    /// looked at.
    pub(crate) fn prepare(&mut self, team: &[PointState], astray: &[u32], zoning: Option<&Zoning>) -> bool {
        let is_far = |index: &u32| {
            let index = *index as usize;
            // What is no number is far.
            let is_near = (team[index].position - self.anchors[index]).norm() <= self.keeps;
            !is_near
        };
        let is_known = self.anchors.len() == team.len() && !astray.iter().any(is_far);
        if is_known && self.looks <= self.patience * team.len() {
            return false;
        }
        self.patience = if is_known { PATIENCE[1].min(2 * self.patience) } else { PATIENCE[0] };
        (self.needed, self.looks) = (self.needed(team, zoning), 0);
        self.anchors.clear();
        self.anchors.extend(team.iter().map(|robot| robot.position));
        self.rooms.clear();
        if self.needed > 0.0 && self.needed.is_finite() {
            let range = WIDER * self.needed;
            self.neighbours.seek(range, team);
            self.keeps = 0.499 * (Neighbours::reach(range) - self.needed);
            let rooms = (0..team.len()).map(|index| {
                let apart = |mate: &u32| (team[*mate as usize].position - team[index].position).norm();
                let nearest = self.neighbours.of(index).iter().map(apart).fold(f64::INFINITY, f64::min);
                self.keeps.min(0.5 * (nearest - self.needed)) - rounding(team[index].position)
            });
            self.rooms.extend(rooms);
        } else {
            // Nobody is nearer than in the same place, and nobody is near one who is alone.
            self.least = if self.needed <= 0.0 { 0.0 } else { self.least };
            self.keeps = f64::INFINITY;
            self.rooms.resize(team.len(), f64::INFINITY);
        }
        true
    }

    /// No pair beyond the nearest so far, or of some, nor beyond zone 1, says anything new.
    fn needed(&self, team: &[PointState], zoning: Option<&Zoning>) -> f64 {
        let some = || team.windows(2).map(|pair| (pair[1].position - pair[0].position).norm());
        let nearest = if self.least.is_finite() { self.least } else { some().fold(self.least, f64::min) };
        nearest.max(zoning.map_or(0.0, |zoning| zoning.radii().rho_underbar))
    }

    /// Looks at a robot of the team that was prepared, and at its neighbours, if they may say something new; calls `forbidden` for each pair
    /// in zone 1 that is not another's to look at. As far as it may go until it has to be looked at again, m.
    pub(crate) fn look(
        &mut self,
        team: &[PointState],
        index: usize,
        zoning: Option<&Zoning>,
        mut forbidden: impl FnMut(),
    ) -> f64 {
        let left = self.left(team, index);
        if left > 0.0 {
            return left;
        }
        self.looks += 1;
        let place = team[index].position;
        for &mate in self.neighbours.of(index) {
            let mate = mate as usize;
            // Of two that have no room left, the one behind looks.
            if mate > index && self.left(team, mate) <= 0.0 {
                continue;
            }
            let distance = (team[mate].position - place).norm();
            self.least = self.least.min(distance);
            if zoning.is_some_and(|zoning| zoning.zone(distance) == Zone::Forbidden) {
                forbidden();
            }
        }
        left
    }

    /// What is left of a robot's room, m.
    fn left(&self, team: &[PointState], index: usize) -> f64 {
        self.rooms[index] - (team[index].position - self.anchors[index]).norm()
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
            let mut rooms = vec![(Vector2::zeros(), -1.0); team.len()];
            let (mut least, mut expected) = (f64::INFINITY, 0);
            for step in 0..24 {
                // Who has room left is not looked at.
                let mut astray: Vec<u32> = (0..team.len() as u32).filter(|index| is_astray(rooms[*index as usize], team[*index as usize].position)).collect();
                if closest.prepare(&team, &astray, zoning.as_ref()) {
                    astray = (0..team.len() as u32).collect();
                }
                for index in astray {
                    let index = index as usize;
                    let room = closest.look(&team, index, zoning.as_ref(), || seconds += 1);
                    rooms[index] = (team[index].position, room);
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
                    robot.position += Vector2::new(*x, *y) * [1.0, -0.3, 0.02, -0.02][step % 4];
                }
            }
        }
    }

    fn is_astray((from, room): (Vector2<f64>, f64), place: Vector2<f64>) -> bool {
        room <= 0.0 || (place - from).norm() >= room
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
            closest.prepare(&team, &[0, 1], None);
            for index in 0..2 {
                closest.look(&team, index, None, || {});
            }
            assert_eq!(closest.least(), 0.0);
        }
        let mut alone = Closest::default();
        assert!(alone.prepare(&[at(1.0, 1.0)], &[0], None));
        assert_eq!(alone.look(&[at(1.0, 1.0)], 0, None, || {}), f64::INFINITY);
        assert!(!alone.prepare(&[at(9.0, 1.0)], &[0], None));
        assert_eq!(alone.least(), f64::INFINITY);
    }
}
