//! Transits of robots' nearest points along a run (Definition 7.2.1).

use crate::summary::{TransitSummary, Transits};
use crate::{Scenario, Task};
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape, Placed, Transit, Warm};
use trench_formation::simulate::Carriage;

/// Transits that are told one by one, of a robot.
const TOLD: usize = 100;

/// The nearest points of a chain. A robot is looked at again once it has gone as far as nearest points may go without a transit, and at
/// the end: two transits on a shorter way, there and back, are none.
#[derive(Debug, Clone)]
pub(crate) struct Watch {
    segment: Curve,
    carriage: Carriage,
    /// Transit points are farther from each other than this, m: the tolerance within which robots conform.
    apart: f64,
    /// Where each robot of the chain was looked at.
    places: Vec<Place>,
    found: Vec<Transits>,
}

/// A place in the segment's frame and the nearest point of the segment, m, and what that tells of the next.
#[derive(Debug, Clone, Copy)]
struct Place {
    at: Vector2<f64>,
    foot: Vector2<f64>,
    warm: Warm,
}

impl Place {
    fn new(at: Vector2<f64>, segment: &Curve, mut warm: Warm) -> Self {
        Self { at, foot: segment.nearest_again(at, &mut warm).point, warm }
    }
}

impl Watch {
    /// Of chains along bent segments: on straight ones every place has one nearest point.
    pub(crate) fn new(scenario: &Scenario) -> Option<Self> {
        let Task::Nearest(chain, shape) = &scenario.task else { return None };
        if let CurveShape::Line(..) = shape {
            return None;
        }
        let placed = Placed::new(&chain.segment, chain.carriage.at(0.0).0);
        let first = |at: Vector2<f64>| Place::new(at, &chain.segment, Warm::default());
        Some(Self {
            places: chain.robots.iter().map(|robot| first(placed.to_curve(robot.position))).collect(),
            found: vec![Transits::default(); chain.robots.len()],
            segment: chain.segment.clone(),
            carriage: chain.carriage,
            apart: scenario.tolerance,
        })
    }

    /// The segment at `time` (s), to look at robots then.
    pub(crate) fn at(&mut self, time: f64) -> Look<'_> {
        let Self { segment, carriage, apart, places, found } = self;
        Look { placed: Placed::new(segment, carriage.at(time).0), apart: *apart, places, found, time }
    }

    /// The same of a segment that moves.
    pub(crate) fn moving(&mut self, time: f64) -> Option<Look<'_>> {
        (!self.carriage.is_parked()).then(|| self.at(time))
    }

    /// Of a robot that is at a position (m, frame `map`) at `time` (s), the end.
    pub(crate) fn of(&self, index: usize, position: Vector2<f64>, time: f64) -> Option<Transits> {
        let placed = Placed::new(&self.segment, self.carriage.at(time).0);
        let (last, mut found) = (*self.places.get(index)?, self.found.get(index)?.clone());
        let place = Place::new(placed.to_curve(position), &self.segment, last.warm);
        found.add(transit(&placed, &last, &place, self.apart), time);
        Some(found)
    }
}

/// A look at robots at one time, s.
pub(crate) struct Look<'a> {
    placed: Placed<'a>,
    apart: f64,
    places: &'a mut [Place],
    found: &'a mut [Transits],
    time: f64,
}

impl Look<'_> {
    /// Of the robot at an index, which is at a position (m, frame `map`). As far as it may go in the segment's frame until it has to be
    /// looked at again, m: without end where it is not of the chain, whose robots are the first of a scenario.
    pub(crate) fn look(&mut self, index: usize, position: Vector2<f64>) -> f64 {
        let Some((last, found)) = self.places.get_mut(index).zip(self.found.get_mut(index)) else {
            return f64::INFINITY;
        };
        let place = self.placed.to_curve(position);
        let squared = (place - last.at).norm_squared();
        if squared >= self.apart * self.apart {
            let place = Place::new(place, self.placed.curve(), last.warm);
            found.add(transit(&self.placed, last, &place, self.apart), self.time);
            *last = place;
            return self.apart;
        }
        self.apart - squared.sqrt()
    }
}

/// The first transit on a way in the segment's frame, told in `map`.
fn transit(placed: &Placed<'_>, from: &Place, to: &Place, apart: f64) -> Option<Transit> {
    // Mostly the nearest point has hardly moved.
    if (from.foot - to.foot).norm() <= apart {
        return None;
    }
    let found = placed.curve().transit(from.at, to.at, apart)?;
    Some(Transit { place: placed.point_to_map(found.place), ..found })
}

impl Transits {
    fn add(&mut self, found: Option<Transit>, time: f64) {
        let Some(Transit { place, from, to, .. }) = found else { return };
        self.count += 1;
        if self.first.len() < TOLD {
            let (from, to) = (from.arc_length, to.arc_length);
            self.first.push(TransitSummary { time, place: [place.x, place.y], from, to });
        }
    }
}
