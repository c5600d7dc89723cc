//! Steps (1) to (3) of 7.5.2: what obstacles and robots ahead leave of the segment.
use super::settings::RobotsAhead;
use super::{Agent, Encroaching, Surroundings};
use crate::Vector2;
use crate::curve::{Interval, encroached};
use crate::hull::{ApparentObstacle, HullError, Obstacle, Outline, Shape};
use crate::seek::{Fragments, apparent_obstacles, apparent_obstacles_apart};
use crate::trench::Trench;
use nalgebra::Isometry2;

/// As many hulls about the same place of a list are looked at for one that is known: lists hardly change.
const ABOUT: usize = 8;
/// Fragments are sought anew once a robot on the segment has moved this far, m.
const MOVED: f64 = 0.005;

/// What fragments were found for, where robots encroach.
#[derive(Debug, Clone)]
pub(super) struct Encroachers {
    map_from_segment: Isometry2<f64>,
    real: Vec<Obstacle>,
    pub(super) robots: Vec<Vector2<f64>>,
    /// What each hull takes of the segment: the next time most hulls are the same.
    hulls: Vec<(Shape, Vec<Interval>)>,
}

impl Encroachers {
    fn still_hold(&self, around: &Surroundings<'_>, robots: &[Vector2<f64>]) -> bool {
        self.map_from_segment == around.map_from_segment
            && self.robots.len() == robots.len()
            && self.robots.iter().zip(robots).all(|(then, now)| is_near(*then, *now))
            && self.real == around.real
    }
}

/// Hulls that are known, gone through in order.
struct Known<'a> {
    hulls: &'a [(Shape, Vec<Interval>)],
    next: usize,
}

impl<'a> Known<'a> {
    /// Of a robot's fragments, if the segment is where it was then.
    fn of(known: Option<&'a Encroachers>, map_from_segment: &Isometry2<f64>) -> Self {
        let known = known.filter(|known| known.map_from_segment == *map_from_segment);
        Self { hulls: known.map_or(&[], |known| &known.hulls), next: 0 }
    }

    /// What a hull takes of the segment, if it is known. The next one is looked for behind it.
    fn taken_by(&mut self, shape: &Shape) -> Option<&'a Vec<Interval>> {
        let from = self.next.saturating_sub(ABOUT / 2).min(self.hulls.len());
        let about = &self.hulls[from..self.hulls.len().min(from + ABOUT)];
        let found = about.iter().position(|(other, _)| other == shape);
        self.next = found.map_or(self.next, |found| from + found) + 1;
        found.map(|found| &about[found].1)
    }
}

/// Whether a robot has hardly moved.
pub(super) fn is_near(then: Vector2<f64>, now: Vector2<f64>) -> bool {
    (now - then).norm_squared() < MOVED * MOVED
}

impl<T: Trench> Agent<T> {
    /// `teammate` is the robot ahead of it, if it has sought already: most hulls are those that it found.
    pub(super) fn find_fragments(
        &mut self,
        around: &Surroundings<'_>,
        teammate: Option<&Encroachers>,
    ) -> Result<(), HullError> {
        let encroaching = self.settings.encroaching;
        let Some(ahead) = encroaching.robots_ahead() else {
            self.fragments = match encroaching {
                Encroaching::Nothing => Fragments::whole(around.curve.domain()),
                _ => self.left_by(around, around.apparent),
            };
            return Ok(());
        };
        let robots = if ahead.places { self.places_held(around) } else { self.robots_there(around, ahead.radius) };
        self.find_among(around, robots, ahead, teammate)
    }

    fn find_among(
        &mut self,
        around: &Surroundings<'_>,
        robots: Vec<Vector2<f64>>,
        ahead: RobotsAhead,
        teammate: Option<&Encroachers>,
    ) -> Result<(), HullError> {
        if self.encroachers.as_ref().is_some_and(|known| known.still_hold(around, &robots)) {
            return Ok(());
        }
        let all = self.merge(around, &robots, ahead)?;
        let (map_from_segment, real) = (around.map_from_segment, around.real.to_vec());
        let mut own = Known::of(self.encroachers.as_deref(), &map_from_segment);
        let mut others = Known::of(teammate, &map_from_segment);
        let (segment, whole) = (around.moment(0.0).segment, around.curve.domain());
        let taken = |ApparentObstacle { shape, .. }: ApparentObstacle| {
            // Both lists are gone through, whichever knows the hull.
            let known = (own.taken_by(&shape), others.taken_by(&shape));
            let intervals = known
                .0
                .or(known.1)
                .cloned()
                .unwrap_or_else(|| encroached(&segment, whole, &[shape.outline()], self.settings.potential.cut()));
            (shape, intervals)
        };
        let hulls: Vec<(Shape, Vec<Interval>)> = all.into_iter().map(taken).collect();
        let fragments =
            Fragments::beside(around.curve, whole, hulls.iter().flat_map(|hull| &hull.1), self.settings.seeking.room);
        self.fragments = self.within_reach(around, fragments);
        self.encroachers = Some(Box::new(Encroachers { map_from_segment, real, robots, hulls }));
        Ok(())
    }

    /// Step (1) of 7.5.2: the apparent obstacles with the robots ahead merged in, where these encroach; none where they do not.
    ///
    /// # Errors
    /// Robots ahead whose position is not finite.
    pub fn merged(&self, around: &Surroundings<'_>) -> Result<Vec<ApparentObstacle>, HullError> {
        match self.settings.encroaching.robots_ahead() {
            None => Ok(Vec::new()),
            Some(ahead) if ahead.places => self.merge(around, around.places, ahead),
            Some(ahead) => self.merge(around, &self.robots_there(around, ahead.radius), ahead),
        }
    }

    fn merge(
        &self,
        around: &Surroundings<'_>,
        robots: &[Vector2<f64>],
        RobotsAhead { radius, apart, .. }: RobotsAhead,
    ) -> Result<Vec<ApparentObstacle>, HullError> {
        let clearance = self.settings.clearance;
        if apart {
            return apparent_obstacles_apart(around.apparent, robots, radius, clearance);
        }
        apparent_obstacles(around.real, robots, radius, clearance, |a, b| around.parted(a, b, clearance))
    }

    fn left_by(&self, around: &Surroundings<'_>, obstacles: &[ApparentObstacle]) -> Fragments {
        let outlines: Vec<Outline<'_>> = obstacles.iter().map(|obstacle| obstacle.shape.outline()).collect();
        let (whole, settings) = (around.curve.domain(), &self.settings);
        Fragments::find(&around.moment(0.0).segment, whole, &outlines, settings.potential.cut(), settings.seeking.room)
    }

    /// The robots ahead that have come to the segment: the others are under way, and what they encroach on now says nothing.
    fn robots_there(&self, around: &Surroundings<'_>, radius: f64) -> Vec<Vector2<f64>> {
        let segment = around.moment(0.0).segment;
        let reach = radius + self.settings.potential.cut();
        let leader = around.leader.map(|leader| leader.state.position);
        let ahead = around.ahead.iter().map(|robot| robot.position).chain(leader);
        // A position that is not a number is kept, for the hulls to refuse.
        let there = |position: &Vector2<f64>| {
            !(position.x.is_finite() && position.y.is_finite()) || segment.nearest(*position).distance < reach
        };
        ahead.filter(there).collect()
    }
}
