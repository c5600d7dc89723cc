//! What the mapper tells of.

use super::vector;
use crate::refusal::Refusal;
use std::borrow::Cow;
use trench_core::RosTime;
use trench_formation::Vector2;
use trench_formation::hull::{ApparentObstacle, HullError, Obstacle, Outline, Shape};
use trench_formation::safety::MovingOutline;
use trench_msgs::msg::{self, ApparentObstacleArray, Point2};

/// Obstacles are believed to go on for so long, s: older ones stop robots.
const CARRIED: f64 = 1.0;

/// Apparent obstacles and the real ones inside them, at one time.
#[derive(Debug, Clone, Default)]
pub(crate) struct Hulls {
    pub(crate) stamp: RosTime,
    pub(crate) apparent: Vec<ApparentObstacle>,
    /// Of the apparent ones, m/s.
    pub(crate) velocities: Vec<Vector2<f64>>,
    pub(crate) real: Vec<Obstacle>,
    real_velocities: Vec<Vector2<f64>>,
}

impl Hulls {
    /// Those of a message.
    ///
    /// # Errors
    /// A hull that is none: nobody knows then where not to go.
    pub(crate) fn of(message: &ApparentObstacleArray) -> Result<Self, Refusal> {
        let shape = |points: &[Point2], radius: f64| {
            let points: Vec<Vector2<f64>> = points.iter().map(vector).collect();
            Shape::enclosing(&points, radius).map_err(|_| Refusal::NotFinite)
        };
        let velocity = |point: &Point2| {
            let velocity = vector(point);
            (velocity.x + velocity.y).is_finite().then_some(velocity).ok_or(Refusal::NotFinite)
        };
        let apparent = |obstacle: &msg::ApparentObstacle| {
            let shape = shape(&obstacle.hull, obstacle.radius)?;
            Ok(ApparentObstacle { id: obstacle.id, members: obstacle.members.clone(), shape })
        };
        let real = |obstacle: &msg::Obstacle| {
            Ok(Obstacle { id: obstacle.id, shape: shape(&obstacle.polygon, obstacle.radius)? })
        };
        Ok(Self {
            stamp: RosTime::from(&message.header.stamp),
            apparent: message.obstacles.iter().map(apparent).collect::<Result<_, _>>()?,
            velocities: message.obstacles.iter().map(|one| velocity(&one.velocity)).collect::<Result<_, _>>()?,
            real: message.members.iter().map(real).collect::<Result<_, _>>()?,
            real_velocities: message.members.iter().map(|one| velocity(&one.velocity)).collect::<Result<_, _>>()?,
        })
    }

    /// The same at `time`: everything has gone on as it moved.
    pub(crate) fn at(&self, time: RosTime) -> Cow<'_, Self> {
        let elapsed = time.seconds_since(self.stamp).clamp(0.0, CARRIED);
        let rest = |velocity: &Vector2<f64>| *velocity == Vector2::zeros();
        if elapsed == 0.0 || (self.velocities.iter().all(rest) && self.real_velocities.iter().all(rest)) {
            return Cow::Borrowed(self);
        }
        match self.moved(elapsed) {
            Ok(moved) => Cow::Owned(moved),
            // At no place that numbers can say: where it was is the best there is.
            Err(_) => Cow::Borrowed(self),
        }
    }

    /// A body that no mapper tells of, as an obstacle of its own at rest.
    pub(crate) fn add_body(&mut self, centre: Vector2<f64>, radius: f64) {
        // What is at no place is seen nowhere.
        let Ok(shape) = Shape::new(&[centre], radius) else { return };
        let id = self.apparent.iter().flat_map(|hull| &hull.members).max().map_or(0, |id| id.saturating_add(1));
        self.apparent.push(ApparentObstacle { id, members: vec![id], shape: shape.clone() });
        self.velocities.push(Vector2::zeros());
        self.real.push(Obstacle { id, shape });
        self.real_velocities.push(Vector2::zeros());
    }

    fn moved(&self, elapsed: f64) -> Result<Self, HullError> {
        let apparent = |(one, velocity): (&ApparentObstacle, &Vector2<f64>)| {
            let shape = one.shape.moved(elapsed * velocity)?;
            Ok(ApparentObstacle { id: one.id, members: one.members.clone(), shape })
        };
        let real = |(one, velocity): (&Obstacle, &Vector2<f64>)| {
            Ok(Obstacle { id: one.id, shape: one.shape.moved(elapsed * velocity)? })
        };
        Ok(Self {
            apparent: self.apparent.iter().zip(&self.velocities).map(apparent).collect::<Result<_, _>>()?,
            real: self.real.iter().zip(&self.real_velocities).map(real).collect::<Result<_, _>>()?,
            ..self.clone()
        })
    }

    /// What the body of a robot at `centre` must not touch: the apparent obstacles, the members, too, of one that is nearer than `reach` (m),
    /// and the members alone of one that has closed around it (7.7).
    ///
    /// A hull that moves or comes into being may reach into a body. Whoever then goes along its face, and so no nearer to it, may
    /// still run into a member behind that face.
    pub(crate) fn bodies(&self, centre: Vector2<f64>, reach: f64) -> Vec<MovingOutline<'_>> {
        let mut bodies = Vec::with_capacity(self.apparent.len());
        for (hull, velocity) in self.apparent.iter().zip(&self.velocities) {
            let outline = hull.shape.outline();
            let gap = outline.approach(centre).gap;
            let members =
                || self.real.iter().zip(&self.real_velocities).filter(|(real, _)| hull.members.contains(&real.id));
            let is_combined = hull.members.len() > 1 && members().count() == hull.members.len();
            if is_combined && gap < reach {
                bodies.extend(members().map(|(real, velocity)| moving(real.shape.outline(), velocity)));
            }
            if !is_combined || gap >= 0.0 {
                bodies.push(moving(outline, velocity));
            }
        }
        bodies
    }
}

fn moving<'a>(outline: Outline<'a>, velocity: &Vector2<f64>) -> MovingOutline<'a> {
    MovingOutline { outline, velocity: *velocity }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two walls with a corridor between them, one hull.
    fn walls() -> ApparentObstacleArray {
        let point = |[x, y]: [f64; 2]| Point2 { x, y };
        let wall = |id: u32, y: f64| msg::Obstacle {
            id,
            polygon: [[0.0, y], [1.0, y]].map(point).to_vec(),
            radius: 0.02,
            velocity: Point2 { x: 0.1, y: 0.0 },
        };
        let hull = msg::ApparentObstacle {
            id: 1,
            hull: [[0.0, 0.0], [1.0, 0.0], [1.0, 0.4], [0.0, 0.4]].map(point).to_vec(),
            radius: 0.02,
            velocity: Point2 { x: 0.1, y: 0.0 },
            members: vec![1, 2],
        };
        ApparentObstacleArray { obstacles: vec![hull], members: vec![wall(1, 0.0), wall(2, 0.4)], ..Default::default() }
    }

    #[test]
    fn a_robot_that_is_enclosed_goes_by_the_members() {
        let hulls = Hulls::of(&walls()).unwrap();
        assert_eq!(hulls.bodies(Vector2::new(0.5, 1.0), 0.16).len(), 1);
        assert_eq!(hulls.bodies(Vector2::new(0.5, 0.5), 0.16).len(), 3, "hull and members");
        let inside = hulls.bodies(Vector2::new(0.5, 0.2), 0.16);
        assert_eq!(inside.len(), 2);
        assert!((inside[0].outline.approach(Vector2::new(0.5, 0.2)).gap - 0.18).abs() < 1e-12);
    }

    #[test]
    fn obstacles_go_on() {
        let hulls = Hulls::of(&walls()).unwrap();
        let later = hulls.at(RosTime(0).plus_seconds(0.5));
        let gap = |hulls: &Hulls| hulls.apparent[0].shape.outline().approach(Vector2::new(2.0, 0.2)).gap;
        assert!((gap(&hulls) - gap(&later) - 0.05).abs() < 1e-12);
        assert!(matches!(hulls.at(RosTime(0)), Cow::Borrowed(_)));
    }

    #[test]
    fn what_is_no_hull_is_refused() {
        let spoilt = |spoil: &dyn Fn(&mut ApparentObstacleArray)| {
            let mut message = walls();
            spoil(&mut message);
            Hulls::of(&message).map(drop)
        };
        assert_eq!(spoilt(&|_| {}), Ok(()));
        assert_eq!(spoilt(&|message| message.obstacles[0].hull[0].x = f64::NAN), Err(Refusal::NotFinite));
        assert_eq!(spoilt(&|message| message.obstacles[0].hull.clear()), Err(Refusal::NotFinite));
        assert_eq!(spoilt(&|message| message.obstacles[0].radius = -1.0), Err(Refusal::NotFinite));
        assert_eq!(spoilt(&|message| message.members[0].velocity.y = f64::INFINITY), Err(Refusal::NotFinite));
    }
}
