//! Who told of which obstacles.

use std::collections::BTreeMap;
use trench_formation::Vector2;
use trench_formation::hull::{ApparentObstacle, HullError, Obstacle, Shape, combine};
use trench_msgs::msg::{self, ObstacleArray, Point2};

/// Ids of the second source and later ones are moved by this much a source, so that sources need not agree on ids.
const IDS_A_SOURCE: u32 = 1 << 20;

struct Known {
    obstacle: Obstacle,
    velocity: Vector2<f64>,
}

/// The obstacles of all sources: a newer message of a source replaces its older one.
#[derive(Default)]
pub struct Sources {
    /// By the order in which sources were first heard.
    order: Vec<[u8; 16]>,
    known: BTreeMap<usize, Vec<Known>>,
}

impl Sources {
    /// Takes a message of the source `gid`. Gives the ids of obstacles that cannot be used, with the reason.
    pub fn take(&mut self, gid: [u8; 16], message: &ObstacleArray) -> Vec<(u32, String)> {
        let source = self.order.iter().position(|known| *known == gid).unwrap_or_else(|| {
            self.order.push(gid);
            self.order.len() - 1
        });
        let (mut usable, mut refused) = (BTreeMap::new(), Vec::new());
        for obstacle in &message.obstacles {
            match known(obstacle, source as u32) {
                Ok(known) if usable.contains_key(&known.obstacle.id) => {
                    refused.push((obstacle.id, "a second obstacle of this id".to_owned()));
                }
                Ok(known) => {
                    usable.insert(known.obstacle.id, known);
                }
                Err(reason) => refused.push((obstacle.id, reason)),
            }
        }
        self.known.insert(source, usable.into_values().collect());
        refused
    }

    /// How many obstacles there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.known.values().map(Vec::len).sum()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All obstacles combined with `clearance` (m), ordered by id.
    ///
    /// # Errors
    /// As [`combine`]; with ids kept apart and shapes checked, only for a clearance that is no length.
    pub fn combined(&self, clearance: f64) -> Result<Vec<msg::ApparentObstacle>, HullError> {
        let known: Vec<&Known> = self.known.values().flatten().collect();
        let obstacles: Vec<Obstacle> = known.iter().map(|known| known.obstacle.clone()).collect();
        let combined = combine(&obstacles, clearance)?;
        Ok(combined.iter().map(|apparent| to_message(apparent, &known)).collect())
    }
}

fn known(obstacle: &msg::Obstacle, source: u32) -> Result<Known, String> {
    let points: Vec<Vector2<f64>> = obstacle.polygon.iter().map(|point| Vector2::new(point.x, point.y)).collect();
    let velocity = Vector2::new(obstacle.velocity.x, obstacle.velocity.y);
    if !(velocity.x.is_finite() && velocity.y.is_finite()) {
        return Err("its velocity is not finite".to_owned());
    }
    let shape = Shape::new(&points, obstacle.radius).map_err(|error| error.to_string())?;
    let id = obstacle.id.wrapping_add(source.wrapping_mul(IDS_A_SOURCE));
    Ok(Known { obstacle: Obstacle { id, shape }, velocity })
}

/// An apparent obstacle with the velocity of its fastest member.
fn to_message(apparent: &ApparentObstacle, known: &[&Known]) -> msg::ApparentObstacle {
    let members = known.iter().filter(|known| apparent.members.contains(&known.obstacle.id));
    let velocity = members.map(|known| known.velocity).max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
    let velocity = velocity.unwrap_or_default();
    let outline = apparent.shape.outline();
    msg::ApparentObstacle {
        id: apparent.id,
        hull: outline.points.iter().map(|point| Point2 { x: point.x, y: point.y }).collect(),
        radius: outline.radius,
        velocity: Point2 { x: velocity.x, y: velocity.y },
        members: apparent.members.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(id: u32, x: f64, speed: f64) -> msg::Obstacle {
        msg::Obstacle { id, polygon: vec![Point2 { x, y: 0.0 }], radius: 0.1, velocity: Point2 { x: speed, y: 0.0 } }
    }

    fn array(obstacles: Vec<msg::Obstacle>) -> ObstacleArray {
        ObstacleArray { obstacles, ..Default::default() }
    }

    #[test]
    fn near_ones_are_combined_and_move_as_the_fastest() {
        let mut sources = Sources::default();
        sources.take([1; 16], &array(vec![disc(1, 0.0, 0.0), disc(2, 0.3, -0.2), disc(3, 2.0, 0.0)]));
        let combined = sources.combined(0.2).unwrap();
        assert_eq!(combined.len(), 2);
        assert_eq!((combined[0].members.as_slice(), combined[0].velocity.x), (&[1, 2][..], -0.2));
        assert_eq!(combined[1].members, [3]);
    }

    #[test]
    fn a_source_replaces_its_own_and_leaves_the_others() {
        let mut sources = Sources::default();
        sources.take([1; 16], &array(vec![disc(1, 0.0, 0.0), disc(2, 1.0, 0.0)]));
        sources.take([2; 16], &array(vec![disc(1, 3.0, 0.0)]));
        assert_eq!(sources.len(), 3);
        sources.take([1; 16], &array(vec![]));
        assert_eq!(sources.len(), 1);
        assert!((sources.combined(0.1).unwrap()[0].hull[0].x - 3.0).abs() < 1e-12);
    }

    #[test]
    fn what_cannot_be_used_is_named_and_the_rest_is_kept() {
        let mut sources = Sources::default();
        let corner = |x, y| Point2 { x, y };
        let crossing = vec![corner(0.0, 0.0), corner(1.0, 1.0), corner(1.0, 0.0), corner(0.0, 1.0)];
        let bad = [
            msg::Obstacle { radius: -1.0, ..disc(10, 0.0, 0.0) },
            msg::Obstacle { polygon: vec![], ..disc(11, 0.0, 0.0) },
            msg::Obstacle { polygon: crossing, ..disc(12, 0.0, 0.0) },
            disc(13, f64::NAN, 0.0),
            disc(14, 0.0, f64::INFINITY),
            disc(1, 0.5, 0.0),
        ];
        let refused = sources.take([1; 16], &array([vec![disc(1, 0.0, 0.0)], bad.to_vec()].concat()));
        assert_eq!(refused.iter().map(|(id, _)| *id).collect::<Vec<_>>(), [10, 11, 12, 13, 14, 1]);
        assert!(refused[0].1.contains("radius is -1"), "{refused:?}");
        assert_eq!(sources.len(), 1);
    }
}
