//! Transits of robots' nearest points along a run (Definition 7.2.1).

use crate::robots::Robots;
use crate::summary::{TransitSummary, Transits};
use crate::{Scenario, Task};
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape, Placed, Transit};
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
    /// Where each robot of the chain was looked at, in the segment's frame, m.
    places: Vec<Vector2<f64>>,
    found: Vec<Transits>,
}

impl Watch {
    /// Of chains along bent segments: on straight ones every place has one nearest point.
    pub(crate) fn new(scenario: &Scenario) -> Option<Self> {
        let Task::Nearest(chain, shape) = &scenario.task else { return None };
        if let CurveShape::Line(..) = shape {
            return None;
        }
        let placed = Placed::new(&chain.segment, chain.carriage.at(0.0).0);
        Some(Self {
            places: chain.robots.iter().map(|robot| placed.to_curve(robot.position)).collect(),
            found: vec![Transits::default(); chain.robots.len()],
            segment: chain.segment.clone(),
            carriage: chain.carriage,
            apart: scenario.tolerance,
        })
    }

    /// Looks at the robots of the chain, which are the first, at `time` (s); the others of the scenario have no segment.
    pub(crate) fn look(&mut self, robots: &(impl Robots + ?Sized), time: f64) {
        let placed = Placed::new(&self.segment, self.carriage.at(time).0);
        let apart_squared = self.apart * self.apart;
        for (index, (last, found)) in self.places.iter_mut().zip(&mut self.found).enumerate() {
            let place = placed.to_curve(robots.position(index));
            if (place - *last).norm_squared() >= apart_squared {
                found.add(transit(&placed, *last, place, self.apart), time);
                *last = place;
            }
        }
    }

    /// Of a robot that is at a position (m, frame `map`) at `time` (s), the end.
    pub(crate) fn of(&self, index: usize, position: Vector2<f64>, time: f64) -> Option<Transits> {
        let placed = Placed::new(&self.segment, self.carriage.at(time).0);
        let (last, mut found) = (*self.places.get(index)?, self.found.get(index)?.clone());
        found.add(transit(&placed, last, placed.to_curve(position), self.apart), time);
        Some(found)
    }
}

/// The first transit on a way in the segment's frame, told in `map`.
fn transit(placed: &Placed<'_>, from: Vector2<f64>, to: Vector2<f64>, apart: f64) -> Option<Transit> {
    let segment = placed.curve();
    // Mostly the nearest point has hardly moved.
    if (segment.nearest(from).point - segment.nearest(to).point).norm() <= apart {
        return None;
    }
    let found = segment.transit(from, to, apart)?;
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
