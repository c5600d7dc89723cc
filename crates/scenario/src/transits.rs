//! Transits of robots' nearest points along a run (Definition 7.2.1).

use crate::summary::{TransitSummary, Transits};
use crate::{Scenario, Task};
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveShape, Placed};
use trench_formation::simulate::Carriage;

/// Transits that are told one by one, of a robot.
const TOLD: usize = 100;

/// The nearest points of a chain, seen after every step.
#[derive(Debug, Clone)]
pub(crate) struct Watch {
    segment: Curve,
    carriage: Carriage,
    /// Transit points are farther from each other than this, m: the tolerance within which robots conform.
    apart: f64,
    /// By seat.
    robots: Vec<Seen>,
}

/// A robot's nearest point.
#[derive(Debug, Clone, Default)]
struct Seen {
    /// Where the robot was, in the segment's frame, and its nearest point there, m.
    last: Option<(Vector2<f64>, Vector2<f64>)>,
    found: Transits,
}

impl Watch {
    /// Of chains along bent segments: on straight ones every place has one nearest point.
    pub(crate) fn new(scenario: &Scenario) -> Option<Self> {
        let Task::Nearest(chain, shape) = &scenario.task else { return None };
        if let CurveShape::Line(..) = shape {
            return None;
        }
        Some(Self {
            segment: chain.segment.clone(),
            carriage: chain.carriage,
            apart: scenario.tolerance,
            robots: vec![Seen::default(); chain.robots.len()],
        })
    }

    /// Looks at a robot of the chain at `time` (s); the others of the scenario have no segment.
    pub(crate) fn look(&mut self, index: usize, position: Vector2<f64>, time: f64) {
        let Self { segment, carriage, apart, robots } = self;
        let Some(seen) = robots.get_mut(index) else { return };
        let placed = Placed::new(segment, carriage.at(time).0);
        let place = placed.to_curve(position);
        let foot = segment.nearest(place).point;
        if let Some((before, last)) = seen.last.replace((place, foot))
            && (foot - last).norm() > *apart
            // A nearest point may go far on a short way without a jump.
            && let Some(transit) = segment.transit(before, place, *apart)
        {
            seen.found.count += 1;
            if seen.found.first.len() < TOLD {
                let at = placed.point_to_map(transit.place);
                let (from, to) = (transit.from.arc_length, transit.to.arc_length);
                seen.found.first.push(TransitSummary { time, place: [at.x, at.y], from, to });
            }
        }
    }

    /// Of a robot.
    pub(crate) fn of(&self, index: usize) -> Option<Transits> {
        self.robots.get(index).map(|seen| seen.found.clone())
    }
}
