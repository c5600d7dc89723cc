//! What a test bed is made of.

use crate::{Body, Faults, Field, Laser, MediumSetup, Obstacle, Random};
use trench_optics::Pose2;
use trench_radio::Key;

/// When the camera looks and when its frames are to be had.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shutter {
    /// From frame to frame, ns.
    pub period: u64,
    /// How long it is open, ns.
    pub exposure: u64,
    /// From the middle of the exposure until the frame can be read, ns; at least until a millisecond after its end.
    pub delay: u64,
}

/// A test bed.
#[derive(Debug, Clone)]
pub struct BedSetup {
    /// Its time at the beginning, ns.
    pub start: u64,
    /// All chance comes from it.
    pub seed: u64,
    /// Radio ids and poses, at most one robot an id.
    pub robots: Vec<(u8, Pose2)>,
    /// The robots' bodies.
    pub body: Body,
    /// Where they stay.
    pub field: Field,
    /// What stands there.
    pub obstacles: Vec<Obstacle>,
    /// The air.
    pub medium: MediumSetup,
    /// The camera.
    pub shutter: Shutter,
    /// Indices of the robots with lasers.
    pub lasers: Vec<usize>,
    /// Their lasers. Scans are exact at whole milliseconds after the start.
    pub laser: Laser,
    /// Of the line between host and base station, bit/s.
    pub baud: u32,
    /// The robots' key, if they have one.
    pub key: Option<Key>,
    /// Of the numbers that robots with a key draw when they are switched on; another one in each process.
    pub nonces: u64,
    /// What goes wrong.
    pub faults: Faults,
}

/// Poses for `count` robots, drawn so that surfaces are at least `gap` m from each other, the obstacles and the edge.
/// `None` when the field is too full.
#[must_use]
pub fn scattered(
    count: usize,
    field: Field,
    body: Body,
    gap: f64,
    obstacles: &[Obstacle],
    random: &mut Random,
) -> Option<Vec<Pose2>> {
    let margin = body.radius + gap;
    let mut poses: Vec<Pose2> = Vec::with_capacity(count);
    for _ in 0..count {
        let pose = (0..10_000).find_map(|_| {
            let x = random.between(margin, field.width - margin);
            let y = random.between(margin, field.height - margin);
            let theta = random.between(-std::f64::consts::PI, std::f64::consts::PI);
            let far = |other: &Pose2| {
                let (dx, dy) = (other.x - x, other.y - y);
                (dx * dx + dy * dy).sqrt() >= 2.0 * body.radius + gap
            };
            let free = |obstacle: &Obstacle| obstacle.clearance([x, y]).0 >= margin;
            (poses.iter().all(far) && obstacles.iter().all(free)).then_some(Pose2 { x, y, theta })
        })?;
        poses.push(pose);
    }
    Some(poses)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scattered_robots_keep_their_distance() {
        let field = Field { width: 2.48, height: 1.83 };
        let poses = scattered(12, field, Body::MRKIT, 0.1, &[], &mut Random::new(3, 0)).unwrap();
        for (index, a) in poses.iter().enumerate() {
            assert!(a.x >= 0.18 && a.x <= 2.30 && a.y >= 0.18 && a.y <= 1.65);
            assert!(poses[..index].iter().all(|b| (a.x - b.x).hypot(a.y - b.y) >= 0.26));
        }
        assert_eq!(scattered(500, field, Body::MRKIT, 0.1, &[], &mut Random::new(3, 0)), None);
    }
}
