//! Step (1) of 7.5.2 where robots are to rest in corridors (9.2, Fig. 9.1): robots ahead join what of obstacles is near to them.
use super::apparent_obstacles;
use crate::Vector2;
use crate::hull::{ApparentObstacle, HullError, Shape};

/// The apparent obstacles as they are, and behind them the robots ahead, discs of `body_radius` (m), each group of them with what of the
/// obstacles is nearer than the clearance (m) to its hull.
///
/// By (7.8) a robot that stands between two obstacles makes one of them, and of two long walls with a robot between them a hull that takes
/// all of the corridor: nobody would find a place behind it. Of what is no larger than the clearance all is near: there the hulls are the
/// same as by (7.8), and nobody passes where the robot stands.
///
/// # Errors
/// Robots ahead whose position is not finite, a radius or clearance that is no length.
pub fn apparent_obstacles_apart(
    apparent: &[ApparentObstacle],
    ahead: &[Vector2<f64>],
    body_radius: f64,
    clearance: f64,
) -> Result<Vec<ApparentObstacle>, HullError> {
    let first = apparent.iter().flat_map(|obstacle| &obstacle.members).max().map_or(0, |id| id.saturating_add(1));
    let mut found = apparent.to_vec();
    for group in apparent_obstacles(&[], ahead, body_radius, clearance, |_, _| false)? {
        let robots = group.shape.outline();
        let (middle, half) = robots.disc_around();
        let near = apparent.iter().filter(|obstacle| obstacle.shape.outline().is_nearer_than(&robots, clearance));
        let parts: Vec<Shape> = near.filter_map(|obstacle| obstacle.shape.within(middle, half + clearance)).collect();
        found.push(ApparentObstacle {
            id: first.saturating_add(group.id),
            members: group.members.iter().map(|id| first.saturating_add(*id)).collect(),
            shape: Shape::around(core::iter::once(&group.shape).chain(&parts)),
        });
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hull::{Obstacle, combine};

    fn wall(id: u32, y: f64) -> Obstacle {
        Obstacle { id, shape: Shape::new(&[Vector2::new(0.0, y), Vector2::new(40.0, y)], 0.0).unwrap() }
    }

    fn disc(id: u32, x: f64, y: f64) -> Obstacle {
        Obstacle { id, shape: Shape::new(&[Vector2::new(x, y)], 0.3).unwrap() }
    }

    /// Whether a point is covered.
    fn covered(hulls: &[ApparentObstacle], x: f64, y: f64) -> bool {
        hulls.iter().any(|hull| hull.shape.outline().approach(Vector2::new(x, y)).gap <= 0.0)
    }

    #[test]
    fn a_robot_closes_a_corridor_where_it_is_and_nowhere_else() {
        let walls = [wall(1, -2.0), wall(2, 2.0)];
        let robot = [Vector2::new(20.0, 0.0)];
        let printed = apparent_obstacles(&walls, &robot, 0.5, 2.0, |_, _| false).unwrap();
        assert!(printed.len() == 1 && covered(&printed, 5.0, 0.0), "{printed:?}");
        let apart = apparent_obstacles_apart(&combine(&walls, 2.0).unwrap(), &robot, 0.5, 2.0).unwrap();
        assert_eq!(apart.iter().map(|hull| hull.id).collect::<Vec<_>>(), [1, 2, 3]);
        for x in [5.0, 17.0, 23.0, 39.0] {
            assert!([-1.5, 0.0, 1.5].iter().all(|y| !covered(&apart, x, *y)), "{x}");
        }
        assert!([-1.9, -1.0, 0.0, 1.0, 1.9].iter().all(|y| covered(&apart, 20.0, *y)));
    }

    #[test]
    fn between_small_obstacles_it_is_as_printed() {
        let real = [disc(3, 0.0, -1.6), disc(5, 0.0, 1.6)];
        let robot = [Vector2::new(0.2, 0.1)];
        let printed = apparent_obstacles(&real, &robot, 0.5, 2.0, |_, _| false).unwrap();
        let apart = apparent_obstacles_apart(&combine(&real, 2.0).unwrap(), &robot, 0.5, 2.0).unwrap();
        assert_eq!((printed.len(), apart.len()), (1, 3));
        for index in 0..400 {
            let (x, y) = (f64::from(index % 20) * 0.1 - 1.0, f64::from(index / 20) * 0.21 - 2.1);
            assert_eq!(covered(&printed, x, y), covered(&apart, x, y), "({x}, {y})");
        }
    }

    #[test]
    fn robots_near_each_other_are_one_and_others_their_own() {
        let robots = [(20.0, 0.0), (20.0, 2.5), (60.0, 9.0)].map(|(x, y)| Vector2::new(x, y));
        let found = apparent_obstacles_apart(&combine(&[wall(7, -2.0)], 2.0).unwrap(), &robots, 0.5, 2.0).unwrap();
        let told: Vec<(u32, usize)> = found.iter().map(|hull| (hull.id, hull.members.len())).collect();
        assert_eq!(told, [(7, 1), (8, 2), (10, 1)]);
        assert!(covered(&found, 20.0, -1.0) && covered(&found, 20.0, 1.2) && !covered(&found, 30.0, -1.0));
    }
}
