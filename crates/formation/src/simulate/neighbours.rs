//! Lists of neighbours that outlast several ticks (L. Verlet, "Computer experiments on classical fluids", 1967).
use super::grid::Grid;
use super::marks::Marks;
use crate::Vector2;
use crate::hull::ApparentObstacle;
use crate::kinematics::PointState;

/// What rounding may do to ways of robots 1 m from the origin is far less, m.
const ROUNDING: f64 = 1e-9;

/// How much farther than asked the lists reach, as a part of the range: the more, the longer they last, and the longer they are.
const SKIN: f64 = 0.5;

/// How often each robot, on average, may be out of its room before lists are made anew, which may give it more. Where it does not, twice
/// as often the next time, up to the second.
const PATIENCE: [usize; 2] = [8, 64];

/// For each robot all others within a range. They are sought anew once a robot has moved so far that one may be missing.
#[derive(Debug, Clone, Default)]
pub struct Neighbours {
    grid: Grid,
    range: f64,
    /// Where the robots were when the lists were made.
    anchors: Vec<Vector2<f64>>,
    /// The lists one after the other, each ascending, and where they end.
    others: Vec<u32>,
    ends: Vec<u32>,
    found: Vec<u32>,
    /// How far each robot was from all obstacles then, at least, m.
    clear: Vec<f64>,
    keeps: f64,
    /// The square of the way that each may go from its anchor while nobody who has not gone so far comes within range, m^2.
    rooms: Vec<f64>,
    /// Who has gone farther, and who is in their lists.
    astray: Vec<u32>,
    awake: Marks,
    /// How many have been astray since the lists were made, all updates together, and how many a robot are too many.
    looks: usize,
    patience: usize,
}

impl Neighbours {
    /// Makes sure that the lists hold whoever is within `range` (m) of each other now; whether they are made anew. `obstacles` rest, and are
    /// the same as before unless all was forgotten.
    pub(super) fn update(&mut self, range: f64, robots: &[PointState], obstacles: &[ApparentObstacle]) -> bool {
        let same = self.range == range && self.rooms.len() == robots.len();
        let is_known = same && self.look_for_astray(robots);
        let made = !is_known || self.looks > self.patience * robots.len();
        if made {
            self.patience = if is_known { PATIENCE[1].min(2 * self.patience) } else { PATIENCE[0] };
            self.seek(range, robots);
            let least = |anchor: &Vector2<f64>| {
                obstacles.iter().map(|obstacle| obstacle.shape.least_gap(*anchor)).fold(f64::INFINITY, f64::min)
            };
            self.clear.clear();
            self.clear.extend(self.anchors.iter().map(least));
            self.measure_rooms();
            self.look_for_astray(robots);
        }
        self.wake();
        made
    }

    /// Who has left its room; whether nobody is so far that one of the others may be missing.
    fn look_for_astray(&mut self, robots: &[PointState]) -> bool {
        self.astray.clear();
        let places = self.anchors.iter().zip(&self.rooms).zip(robots);
        let mut keeps = true;
        for (index, ((anchor, room), robot)) in (0..).zip(places) {
            let way_squared = (robot.position - anchor).norm_squared();
            // A position that is not a number is in no room.
            let stays = way_squared < *room;
            if !stays {
                keeps &= way_squared <= self.keeps * self.keeps;
                self.astray.push(index);
            }
        }
        keeps
    }

    /// Half of what anybody in its list is beyond the range, since both may go.
    fn measure_rooms(&mut self) {
        // Two robots come nearer to each other by twice as much.
        self.keeps = 0.499 * SKIN * self.range;
        self.looks = 0;
        for (index, anchor) in self.anchors.iter().enumerate() {
            let apart = |mate: &u32| (self.anchors[*mate as usize] - anchor).norm();
            let nearest = self.of(index).iter().map(apart).fold(f64::INFINITY, f64::min);
            let room = self.keeps.min(0.499 * (nearest - self.range)) - ROUNDING * (1.0 + anchor.norm());
            self.rooms.push(room.max(0.0) * room.max(0.0));
        }
    }

    fn wake(&mut self) {
        self.awake.clear(self.anchors.len());
        self.looks += self.astray.len();
        let Self { astray, awake, others, ends, .. } = self;
        for index in astray.iter().map(|index| *index as usize) {
            awake.set(index);
            list(others, ends, index).iter().for_each(|mate| awake.set(*mate as usize));
        }
    }

    /// Who may have somebody within range: nobody else has.
    pub(super) fn awake(&self) -> &Marks {
        &self.awake
    }

    /// Makes the lists anew: of whoever is within `range` (m) of each other now, or somewhat farther ([`Self::reach`]).
    pub fn seek(&mut self, range: f64, robots: &[PointState]) {
        self.range = range;
        self.anchors.clear();
        self.anchors.extend(robots.iter().map(|robot| robot.position));
        self.rooms.clear();
        let reach = Self::reach(range);
        self.grid.fill(reach, self.anchors.iter().copied());
        self.others.clear();
        self.ends.clear();
        for (index, anchor) in self.anchors.iter().enumerate() {
            self.grid.near(*anchor, &mut self.found);
            let within = |other: &u32| {
                *other as usize != index && (self.anchors[*other as usize] - anchor).norm_squared() <= reach * reach
            };
            self.others.extend(self.found.iter().copied().filter(within));
            self.ends.push(self.others.len() as u32);
        }
    }

    /// How far lists of a range reach, m.
    pub fn reach(range: f64) -> f64 {
        (1.0 + SKIN) * range
    }

    /// Seeks all anew at the next update.
    pub(super) fn forget(&mut self) {
        self.rooms.clear();
    }

    /// No obstacle is nearer to a robot than this, m.
    #[inline]
    pub(super) fn clear(&self, index: usize) -> f64 {
        self.clear[index] - self.keeps
    }

    /// The others that may be within range of a robot, ascending.
    #[inline]
    pub fn of(&self, index: usize) -> &[u32] {
        list(&self.others, &self.ends, index)
    }
}

#[inline]
fn list<'a>(others: &'a [u32], ends: &[u32], index: usize) -> &'a [u32] {
    let begin = index.checked_sub(1).map_or(0, |before| ends[before]);
    &others[begin as usize..ends[index] as usize]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Nobody within range is missing, however the robots have moved since the lists were made.
        #[test]
        fn nobody_is_missing(
            starts in prop::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64), 2..40),
            moves in prop::collection::vec((-0.2..0.2_f64, -0.2..0.2_f64), 40),
        ) {
            let mut robots: Vec<PointState> =
                starts.iter().map(|(x, y)| PointState::at_rest(Vector2::new(*x, *y))).collect();
            let mut neighbours = Neighbours::default();
            for step in 0..30 {
                neighbours.update(1.2, &robots, &[]);
                for (index, robot) in robots.iter().enumerate() {
                    let near = |other: &usize| {
                        *other != index && (robots[*other].position - robot.position).norm() <= 1.2
                    };
                    let listed = neighbours.of(index);
                    prop_assert!(listed.is_sorted_by(|a, b| a < b));
                    prop_assert!((0..robots.len()).filter(near).all(|other| listed.contains(&(other as u32))));
                    prop_assert!(neighbours.awake().get(index) || !(0..robots.len()).any(|other| near(&other)));
                }
                for (robot, (x, y)) in robots.iter_mut().zip(&moves) {
                    robot.position += Vector2::new(*x, *y) * if step % 6 == 0 { 1.0 } else { 0.1 };
                }
            }
        }
    }
}
