//! A robot's way out of local minima (7.6, 7.7, Remark 6.4.1).
use super::Remedies;
use crate::Vector2;
use crate::avoidance::{Guard, Watch, auxiliary_arc, auxiliary_lines, escape};
use crate::curve::{Foot, Placed};
use crate::hull::{ApparentObstacle, Approach, Obstacle, Outline};
use crate::zoning::ObstaclePotential;

/// What one robot remembers.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Remedy {
    watch: Watch,
    state: State,
}

#[derive(Debug, Clone, PartialEq, Default)]
enum State {
    #[default]
    Free,
    /// A guard stands before an obstacle, still `sunk` (m) below its place.
    Guarded { obstacle: usize, guard: Guard, sunk: f64 },
    /// No attraction until a time, s (Remark 6.4.1).
    Suspended { until: f64 },
    /// Inside an obstacle's hull, after a `carrot` that goes along the way ahead.
    Escaping { obstacle: usize, carrot: Vector2<f64>, way: Vec<Vector2<f64>> },
}

/// What draws a robot that may be caught.
#[derive(Debug, Clone, Copy)]
pub(super) enum Drawn {
    /// A nearest point, which moves along with the robot or not.
    To(Foot),
    /// A goal point.
    Goal(Vector2<f64>),
}

/// Everything around a robot that remedies look at.
pub(super) struct Surroundings<'a> {
    pub(super) remedies: &'a Remedies,
    pub(super) time: f64,
    pub(super) step: f64,
    pub(super) segment: Placed<'a>,
    /// Real and apparent.
    pub(super) real: &'a [Obstacle],
    pub(super) apparent: &'a [ApparentObstacle],
    pub(super) potential: &'a ObstaclePotential,
}

/// What a remedy asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Asked {
    /// Nothing.
    Attraction,
    /// That the attraction be off.
    Suspension,
    /// That the robot go to this point.
    Point(Vector2<f64>),
}

impl Remedy {
    /// Distance and direction of an apparent obstacle with its guard; of its nearest member while the robot is on its way out.
    pub(super) fn approach(
        &self,
        (index, obstacle): (usize, &ApparentObstacle),
        real: &[Obstacle],
        robot: Vector2<f64>,
    ) -> Approach {
        let outline = obstacle.shape.outline();
        match &self.state {
            State::Guarded { obstacle, guard, sunk } if *obstacle == index => {
                guard.sunk(*sunk).approach(&outline, robot)
            }
            State::Escaping { obstacle: at, .. } if *at == index => {
                let members = real.iter().filter(|real| obstacle.members.contains(&real.id));
                let approaches = members.map(|real| real.shape.outline().approach(robot));
                approaches.min_by(|a, b| a.gap.total_cmp(&b.gap)).unwrap_or_else(|| outline.approach(robot))
            }
            _ => outline.approach(robot),
        }
    }

    /// Notices that a robot is caught or enclosed, chooses a remedy, and drops it when it has done its work.
    pub(super) fn update(&mut self, around: &Surroundings<'_>, robot: Vector2<f64>, drawn: Drawn) -> Asked {
        let gap = |index: usize| around.apparent[index].shape.outline().approach(robot).gap;
        match &mut self.state {
            State::Free => self.choose(around, robot, drawn),
            State::Guarded { guard, sunk, .. } => {
                *sunk = (*sunk - around.remedies.rising * around.step).max(0.0);
                if !guard.shields(robot) {
                    *self = Self::default();
                }
            }
            State::Suspended { until } if around.time >= *until => *self = Self::default(),
            State::Suspended { .. } => {}
            State::Escaping { obstacle, .. } if gap(*obstacle) >= around.potential.cut() => *self = Self::default(),
            State::Escaping { carrot, way, .. } => {
                let pace = around.remedies.rising * around.step;
                if let Some(next) = way.first().copied().filter(|_| (*carrot - robot).norm() < around.potential.cut()) {
                    let ahead = next - *carrot;
                    if ahead.norm() <= pace {
                        way.remove(0);
                    }
                    *carrot += ahead.cap_magnitude(pace);
                }
            }
        }
        match &self.state {
            State::Free | State::Guarded { .. } => Asked::Attraction,
            State::Suspended { .. } => Asked::Suspension,
            State::Escaping { carrot, .. } => Asked::Point(*carrot),
        }
    }

    fn choose(&mut self, around: &Surroundings<'_>, robot: Vector2<f64>, drawn: Drawn) {
        let gap = |obstacle: &ApparentObstacle| obstacle.shape.outline().approach(robot).gap;
        let nearest = around.apparent.iter().enumerate().min_by(|a, b| gap(a.1).total_cmp(&gap(b.1)));
        let Some((index, obstacle)) = nearest else { return };
        let outline = obstacle.shape.outline();
        let settings = &around.remedies.watch;
        let suspended = State::Suspended { until: around.time + settings.patience };
        if gap(obstacle) < 0.0 {
            let walls: Vec<Outline<'_>> = around.real.iter().map(|real| real.shape.outline()).collect();
            let way = escape(&outline, &walls, robot, around.potential.pole_with_margin(), around.potential.cut());
            self.state = way.map_or(suspended, |way| State::Escaping { obstacle: index, carrot: robot, way });
            return;
        }
        let target = match drawn {
            Drawn::To(foot) => foot.point,
            Drawn::Goal(goal) => goal,
        };
        let repelled = gap(obstacle) < around.potential.cut() + settings.radius;
        if self.watch.is_caught(settings, around.time, robot, (target - robot).norm(), repelled) {
            self.state = match guard(&around.segment, drawn, &outline, robot, settings.radius) {
                Some(guard) => {
                    let sunk = guard.protrusion(&outline, robot).max(0.0);
                    State::Guarded { obstacle: index, guard, sunk }
                }
                None => suspended,
            };
        }
    }
}

/// The arc where the nearest point follows a robot that moves by `aside` (m) along the obstacle, lines where it does not.
fn guard(segment: &Placed<'_>, drawn: Drawn, outline: &Outline<'_>, robot: Vector2<f64>, aside: f64) -> Option<Guard> {
    let foot = match drawn {
        Drawn::Goal(goal) => return auxiliary_lines(outline, robot, goal),
        Drawn::To(foot) => foot,
    };
    let towards = outline.approach(robot).towards;
    let beside = segment.track(robot + aside * Vector2::new(-towards.y, towards.x), foot.arc_length);
    let (arc, lines) = (|| auxiliary_arc(outline, robot, &foot), || auxiliary_lines(outline, robot, foot.point));
    if (beside.point - foot.point).norm() > 0.5 * aside { arc().or_else(lines) } else { lines().or_else(arc) }
}
