//! What a robot must not touch.
use super::SafetyParameters;
use crate::hull::Outline;
use nalgebra::Vector2;

/// Another robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbour {
    /// Centre, m.
    pub position: Vector2<f64>,
    /// Velocity, m/s.
    pub velocity: Vector2<f64>,
    /// Radius of its body, m.
    pub radius: f64,
    /// Whether it runs this filter and obeys it. A robot that deviates from its commands is a plain obstacle.
    pub cooperative: bool,
    /// Whether it has arrived and means to stay: nobody circles round it to get at its place.
    pub settled: bool,
}

/// An apparent obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingOutline<'a> {
    /// Its hull, m.
    pub outline: Outline<'a>,
    /// Velocity, m/s.
    pub velocity: Vector2<f64>,
}

/// Everything around a robot, in frame `map`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Scene<'a> {
    /// The other robots.
    pub neighbours: &'a [Neighbour],
    /// Obstacles.
    pub obstacles: &'a [MovingOutline<'a>],
    /// Convex polygon, corners counter-clockwise, that robots stay inside; empty if there is no limit.
    pub field: &'a [Vector2<f64>],
}

/// What the filter acted on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Constraint {
    /// The neighbour of this index.
    Neighbour(usize),
    /// The obstacle of this index.
    Obstacle(usize),
    /// The field's edge that begins at the corner of this index.
    Edge(usize),
    /// A number that is not finite: the robot stops.
    NotFinite,
}

/// A half-plane that the robot must not leave: its centre may travel at most `budget` along `towards`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Barrier {
    pub(super) constraint: Constraint,
    pub(super) towards: Vector2<f64>,
    pub(super) budget: f64,
}

impl Scene<'_> {
    pub(super) fn is_finite(&self) -> bool {
        let finite = |vector: &Vector2<f64>| vector.x.is_finite() && vector.y.is_finite();
        self.neighbours.iter().all(|n| finite(&n.position) && finite(&n.velocity) && n.radius.is_finite())
            && self.obstacles.iter().all(|o| {
                finite(&o.velocity)
                    && o.outline.radius.is_finite()
                    && !o.outline.points.is_empty()
                    && o.outline.points.iter().all(finite)
            })
            && self.field.iter().all(finite)
    }

    /// Barriers of everything, seen from `centre`. Half the gap is ours: a cooperative neighbour keeps to the other
    /// half, so the two half-planes never meet. What does not cooperate may use up the gap by itself, at its present
    /// speed in any direction, until we stand still after `stopping_time` (s).
    pub(super) fn barriers<'s>(
        &'s self,
        centre: Vector2<f64>,
        parameters: &'s SafetyParameters,
        stopping_time: f64,
    ) -> impl Iterator<Item = Barrier> + 's {
        let keep = parameters.radius + parameters.margin;
        let share = move |gap: f64, speed: f64| (0.5 * gap).min(gap - speed * stopping_time);
        let neighbours = self.neighbours.iter().enumerate().map(move |(index, neighbour)| {
            let approach = neighbour.outline().approach(centre);
            let gap = approach.gap - keep;
            let budget = if neighbour.cooperative { 0.5 * gap } else { share(gap, neighbour.velocity.norm()) };
            Barrier { constraint: Constraint::Neighbour(index), towards: approach.towards, budget }
        });
        let obstacles = self.obstacles.iter().enumerate().map(move |(index, obstacle)| {
            let approach = obstacle.outline.approach(centre);
            let budget = share(approach.gap - keep, obstacle.velocity.norm());
            Barrier { constraint: Constraint::Obstacle(index), towards: approach.towards, budget }
        });
        let edges = self.field_edges().map(move |(index, corner, outward)| {
            let gap = (corner - centre).dot(&outward) - keep;
            Barrier { constraint: Constraint::Edge(index), towards: outward, budget: 0.5 * gap }
        });
        neighbours.chain(obstacles).chain(edges)
    }

    /// Index, a corner, and the outward normal of each edge of the field.
    pub(super) fn field_edges(&self) -> impl Iterator<Item = (usize, Vector2<f64>, Vector2<f64>)> + '_ {
        self.field.iter().enumerate().map(|(index, corner)| {
            let edge = self.field[(index + 1) % self.field.len()] - corner;
            (index, *corner, Vector2::new(edge.y, -edge.x) / edge.norm())
        })
    }
}

impl Neighbour {
    pub(super) fn outline(&self) -> Outline<'_> {
        Outline { points: core::slice::from_ref(&self.position), radius: self.radius }
    }
}
