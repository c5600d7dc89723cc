//! Giving way to what comes and does not brake.
//!
//! A robot that stands still is safe from everything but what comes at it. Where something that does not run this filter would be
//! at the robot within [`HORIZON`], the law's wish is put aside, and the robot drives where it will then be farthest from it,
//! as far as everything else leaves room. It drives backwards where that needs the smaller turn.
use super::SafetyParameters;
use super::scene::{Barrier, Constraint, Scene};
use crate::hull::Outline;
use core::f64::consts::TAU;
use nalgebra::Vector2;

/// Time to contact below which a robot gives way, s: a half turn, and then some way.
const HORIZON: f64 = 3.0;
/// Slower than this nothing comes, m/s: what vision and lasers err by.
const STILL: f64 = 0.01;
/// Directions that are tried.
const DIRECTIONS: u32 = 24;
/// Robots one behind the other that make room.
const ROW: usize = 3;
/// Most robots that are looked at for it.
const MOST_ROBOTS: usize = 64;

/// Where to drive, and what comes.
pub(super) struct Evasion {
    pub(super) direction: Vector2<f64>,
    pub(super) threat: Constraint,
    /// How fast it comes, m/s.
    pub(super) speed: f64,
}

/// A body that does not brake.
#[derive(Clone, Copy)]
struct Comer<'a> {
    constraint: Constraint,
    outline: Outline<'a>,
    velocity: Vector2<f64>,
}

impl Comer<'_> {
    /// Time until it is at a robot at `centre`, s; infinite where it does not come.
    fn arrives(&self, parameters: &SafetyParameters, centre: Vector2<f64>) -> f64 {
        let approach = self.outline.approach(centre);
        let closing = -approach.towards.dot(&self.velocity);
        let gap = approach.gap - parameters.radius - parameters.margin;
        if closing > STILL { gap.max(0.0) / closing } else { f64::INFINITY }
    }
}

/// The way out for a robot at `centre` that can do `pace` (m/s), if anything comes at it.
pub(super) fn evasion(
    parameters: &SafetyParameters,
    scene: &Scene<'_>,
    centre: Vector2<f64>,
    pace: f64,
) -> Option<Evasion> {
    let comer =
        first(parameters, centre, comers(scene)).or_else(|| first(parameters, centre, pushed(parameters, scene)))?;
    let barriers = || scene.barriers(centre, parameters, 0.0).filter(|barrier| barrier.constraint != comer.constraint);
    let later = |direction: Vector2<f64>| {
        let travel = room(barriers(), direction).min(pace * HORIZON);
        comer.outline.approach(centre + travel * direction - HORIZON * comer.velocity).gap
    };
    // Not towards it: there is no time to pass before its front.
    let towards = comer.outline.approach(centre).towards;
    let directions = (0..DIRECTIONS).map(|index| {
        let (sine, cosine) = libm::sincos(TAU * f64::from(index) / f64::from(DIRECTIONS));
        Vector2::new(cosine, sine)
    });
    let away = directions.filter(|direction| towards.dot(direction) <= 0.0);
    let valued = away.map(|direction| (direction, later(direction)));
    let (direction, _) = valued.max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Evasion { direction, threat: comer.constraint, speed: comer.velocity.norm() })
}

/// Of those that will be at a robot at `centre` in time, the first.
fn first<'s>(
    parameters: &SafetyParameters,
    centre: Vector2<f64>,
    comers: impl Iterator<Item = Comer<'s>>,
) -> Option<Comer<'s>> {
    let timed = comers.map(|comer| (comer.arrives(parameters, centre), comer));
    let (time, comer) = timed.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (time < HORIZON).then_some(comer)
}

/// Obstacles that move, and robots that do not do what they are told.
fn comers<'s>(scene: &'s Scene<'_>) -> impl Iterator<Item = Comer<'s>> {
    let obstacles = scene.obstacles.iter().enumerate().map(|(index, obstacle)| Comer {
        constraint: Constraint::Obstacle(index),
        outline: obstacle.outline,
        velocity: obstacle.velocity,
    });
    let robots = scene.neighbours.iter().enumerate().filter(|(_, neighbour)| !neighbour.cooperative);
    let robots = robots.map(|(index, neighbour)| Comer {
        constraint: Constraint::Neighbour(index),
        outline: neighbour.outline(),
        velocity: neighbour.velocity,
    });
    // What rests is most of it, and need not be looked at by everybody at every tick.
    obstacles.chain(robots).filter(|comer| comer.velocity.norm() > STILL)
}

/// Robots that will be reached, by what comes or by robots that will be, with the velocity of what comes.
fn pushed<'s>(parameters: &SafetyParameters, scene: &'s Scene<'_>) -> impl Iterator<Item = Comer<'s>> {
    let mut velocities = [None; MOST_ROBOTS];
    let robots = || scene.neighbours.iter().enumerate().take(MOST_ROBOTS).filter(|(_, robot)| robot.cooperative);
    for _ in 0..ROW {
        let before = velocities;
        for (index, robot) in robots().filter(|(index, _)| before[*index].is_none()) {
            let from_robots = robots().filter_map(|(other, body)| Some((body, before[other]?)));
            let from_robots = from_robots.map(|(body, velocity)| Comer {
                constraint: Constraint::Neighbour(index),
                outline: body.outline(),
                velocity,
            });
            let reached =
                comers(scene).chain(from_robots).find(|comer| comer.arrives(parameters, robot.position) < HORIZON);
            velocities[index] = reached.map(|comer| comer.velocity);
        }
        if velocities == before {
            break;
        }
    }
    robots().filter_map(move |(index, robot)| {
        let velocity = velocities[index]?;
        Some(Comer { constraint: Constraint::Neighbour(index), outline: robot.outline(), velocity })
    })
}

/// How far one can go in a direction, m.
fn room(barriers: impl Iterator<Item = Barrier>, direction: Vector2<f64>) -> f64 {
    let along = |barrier: Barrier| {
        let closing = barrier.towards.dot(&direction);
        if closing > 0.0 { barrier.budget.max(0.0) / closing } else { f64::INFINITY }
    };
    barriers.map(along).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::super::{MovingOutline, Neighbour, SafetyFilter, Wish};
    use super::*;
    use crate::kinematics::{Pose, Twist};

    const PARAMETERS: SafetyParameters = SafetyParameters {
        radius: 0.08,
        half_axle: 0.05,
        delay: 0.06,
        period: 0.04,
        braking: 0.4,
        margin: 0.01,
        detour_speed: 0.08,
    };
    const DISC: f64 = 0.07;

    fn filtered(robots: &[Pose], index: usize, now: Twist, disc: Vector2<f64>, velocity: Vector2<f64>) -> Twist {
        let obstacles = [MovingOutline { outline: Outline { points: &[disc], radius: DISC }, velocity }];
        let others = robots.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, pose)| Neighbour {
            position: pose.position(),
            velocity: Vector2::zeros(),
            radius: PARAMETERS.radius,
            cooperative: true,
            settled: false,
        });
        let neighbours: Vec<Neighbour> = others.collect();
        let field = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.8], [0.0, 2.8]].map(|[x, y]| Vector2::new(x, y));
        let scene = Scene { neighbours: &neighbours, obstacles: &obstacles, field: &field };
        let wish = Wish { twist: Twist::ZERO, goal: None, kept: None, pace: 0.1 };
        SafetyFilter::new(PARAMETERS).unwrap().apply(robots[index], now, wish, &scene).twist
    }

    /// Least gap between the disc and any robot, and between robots, while it goes 0.6 m through robots that want to stay.
    fn pushed_through(mut robots: Vec<Pose>, start: Vector2<f64>, speed: f64) -> [f64; 2] {
        let velocity = Vector2::new(speed, 0.0);
        let (mut disc, mut twists, mut least) = (start, vec![Twist::ZERO; robots.len()], [f64::INFINITY; 2]);
        while disc.x < start.x + 0.6 {
            let wished: Vec<Twist> =
                (0..robots.len()).map(|index| filtered(&robots, index, twists[index], disc, velocity)).collect();
            for (twist, wished) in twists.iter_mut().zip(wished) {
                let change = PARAMETERS.braking * PARAMETERS.period;
                *twist = Twist { v: twist.v + (wished.v - twist.v).clamp(-change, change), omega: wished.omega };
            }
            for (pose, twist) in robots.iter_mut().zip(&twists) {
                let (sine, cosine) = libm::sincos(pose.theta);
                pose.x += PARAMETERS.period * twist.v * cosine;
                pose.y += PARAMETERS.period * twist.v * sine;
                pose.theta += PARAMETERS.period * twist.omega;
            }
            disc += PARAMETERS.period * velocity;
            for (index, pose) in robots.iter().enumerate() {
                least[0] = least[0].min((pose.position() - disc).norm() - PARAMETERS.radius - DISC);
                for other in &robots[..index] {
                    least[1] = least[1].min((pose.position() - other.position()).norm() - 2.0 * PARAMETERS.radius);
                }
            }
        }
        least
    }

    /// Robots at rest in the way of a disc, alone and in a row with 3 cm between bodies, whatever their headings.
    #[test]
    fn who_stands_in_the_way_gives_way() {
        for speed in [0.02, 0.03, 0.05, 0.1] {
            for heading in 0..12 {
                for row in [1, 2, 3] {
                    let pose = |index: u32| Pose {
                        x: 1.5 + 0.19 * f64::from(index),
                        y: 1.4,
                        theta: 0.53 * f64::from(heading),
                    };
                    let robots = (0..row).map(pose).collect();
                    let [disc, between] = pushed_through(robots, Vector2::new(1.1, 1.41), speed);
                    assert!(disc > 0.0 && between > 0.0, "{speed} m/s, heading {heading}, {row}: {disc} {between}");
                }
            }
        }
    }

    /// A robot walled in by others, all at rest, with a disc that comes: they make room.
    #[test]
    fn who_stands_beside_one_in_the_way_makes_room() {
        for heading in 0..12 {
            let around = [0.0_f64, 1.0, -1.0, 2.0, -2.0].map(|angle| {
                let (sine, cosine) = libm::sincos(angle);
                Pose { x: 1.5 + 0.185 * cosine, y: 1.4 + 0.185 * sine, theta: angle + 0.53 * f64::from(heading) }
            });
            let middle = Pose { x: 1.5, y: 1.4, theta: 0.53 * f64::from(heading) };
            let robots = [&[middle], &around[..]].concat();
            let [disc, between] = pushed_through(robots, Vector2::new(1.1, 1.4), 0.03);
            assert!(disc > 0.0 && between > 0.0, "heading {heading}: {disc} {between}");
        }
    }

    #[test]
    fn what_rests_or_goes_away_lets_the_law_have_its_way() {
        let robot = [Pose { x: 1.5, y: 1.4, theta: 0.3 }];
        for velocity in [Vector2::zeros(), Vector2::new(-0.05, 0.0), Vector2::new(0.005, 0.0)] {
            assert_eq!(filtered(&robot, 0, Twist::ZERO, Vector2::new(1.33, 1.4), velocity), Twist::ZERO);
        }
        let twist = filtered(&robot, 0, Twist::ZERO, Vector2::new(1.33, 1.4), Vector2::new(0.05, 0.0));
        assert!(twist.v > 0.05, "{twist:?}");
    }
}
