//! A robot's way out of local minima (7.6, 7.7, Remark 6.4.1).
use super::surroundings::Moment;
use super::{Remedies, RemedyState, Surroundings};
use crate::Vector2;
use crate::avoidance::{Guard, Watch, auxiliary_arc, auxiliary_lines, escape};
use crate::curve::{Foot, Placed};
use crate::hull::{Approach, Outline};
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
    /// A guard stands before the obstacle of an id, still `sunk` (m) below its place.
    Guarded { obstacle: u32, guard: Guard, sunk: f64 },
    /// No attraction until a time, s (Remark 6.4.1).
    Suspended { until: f64 },
    /// Inside an obstacle's hull, after a `carrot` that goes along the way ahead.
    Escaping { obstacle: u32, carrot: Vector2<f64>, way: Vec<Vector2<f64>> },
}

/// What draws a robot that may be caught.
#[derive(Debug, Clone, Copy)]
pub(super) enum Drawn {
    /// A nearest point, which moves along with the robot or not.
    To(Foot),
    /// A goal point.
    Goal(Vector2<f64>),
}

/// What remedies look at: displacements of obstacles since the tick included.
#[derive(Clone, Copy)]
pub(super) struct Sight<'a> {
    pub(super) remedies: &'a Remedies,
    pub(super) potential: &'a ObstaclePotential,
    pub(super) around: &'a Surroundings<'a>,
    pub(super) moment: &'a Moment<'a>,
    /// Seconds since the last update.
    pub(super) step: f64,
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

impl Sight<'_> {
    fn time(&self) -> f64 {
        self.around.time + self.moment.since
    }

    /// `point` as the apparent obstacle sees it that was at the tick where it is given.
    fn seen_by(&self, index: usize, point: Vector2<f64>) -> Vector2<f64> {
        point - self.around.displacement(index, self.moment.since)
    }

    fn approach(&self, index: usize, robot: Vector2<f64>) -> Approach {
        self.around.apparent[index].shape.outline().approach(self.seen_by(index, robot))
    }

    fn find(&self, id: u32) -> Option<usize> {
        self.around.apparent.iter().position(|obstacle| obstacle.id == id)
    }
}

impl Remedy {
    /// What it does.
    pub(super) fn state(&self) -> RemedyState {
        match &self.state {
            State::Free => RemedyState::None,
            State::Guarded { obstacle, .. } => RemedyState::Guarded(*obstacle),
            State::Suspended { .. } => RemedyState::Suspended,
            State::Escaping { obstacle, .. } => RemedyState::Escaping(*obstacle),
        }
    }

    /// Distance and direction of an apparent obstacle with its guard; of its nearest member while the robot is on its way out.
    pub(super) fn approach(
        &self,
        around: &Surroundings<'_>,
        since: f64,
        index: usize,
        robot: Vector2<f64>,
    ) -> Approach {
        let obstacle = &around.apparent[index];
        let outline = obstacle.shape.outline();
        let robot = robot - around.displacement(index, since);
        match &self.state {
            State::Guarded { obstacle: id, guard, sunk } if *id == obstacle.id => {
                guard.sunk(*sunk).approach(&outline, robot)
            }
            State::Escaping { obstacle: id, .. } if *id == obstacle.id => {
                let members = around.real.iter().filter(|real| obstacle.members.contains(&real.id));
                let approaches = members.map(|real| real.shape.outline().approach(robot));
                approaches.min_by(|a, b| a.gap.total_cmp(&b.gap)).unwrap_or_else(|| outline.approach(robot))
            }
            _ => outline.approach(robot),
        }
    }

    /// A tick: guards have gone on with their obstacles, and what is gone needs no remedy.
    pub(super) fn carry_on(&mut self, around: &Surroundings<'_>, elapsed: f64) {
        let (State::Guarded { obstacle, .. } | State::Escaping { obstacle, .. }) = &self.state else { return };
        let Some(index) = around.apparent.iter().position(|other| other.id == *obstacle) else {
            *self = Self::default();
            return;
        };
        if let State::Guarded { guard, .. } = &mut self.state {
            *guard = guard.moved(around.displacement(index, elapsed));
        }
    }

    /// Notices that a robot is caught or enclosed, chooses a remedy, and drops it when it has done its work.
    pub(super) fn update(&mut self, sight: &Sight<'_>, robot: Vector2<f64>, drawn: Drawn) -> Asked {
        match &mut self.state {
            State::Free => self.choose(sight, robot, drawn),
            State::Guarded { obstacle, guard, sunk } => {
                *sunk = (*sunk - sight.remedies.rising * sight.step).max(0.0);
                let seen = sight.find(*obstacle).map_or(robot, |index| sight.seen_by(index, robot));
                if !guard.shields(seen) {
                    *self = Self::default();
                }
            }
            State::Suspended { until } if sight.time() >= *until => *self = Self::default(),
            State::Suspended { .. } => {}
            State::Escaping { obstacle, carrot, way } => {
                let cut = sight.potential.cut();
                let out = sight.find(*obstacle).is_none_or(|index| sight.approach(index, robot).gap >= cut);
                let pace = sight.remedies.rising * sight.step;
                if out {
                    *self = Self::default();
                } else if let Some(next) = way.first().copied().filter(|_| (*carrot - robot).norm() < cut) {
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

    fn choose(&mut self, sight: &Sight<'_>, robot: Vector2<f64>, drawn: Drawn) {
        let gap = |index: usize| sight.approach(index, robot).gap;
        let nearest = (0..sight.around.apparent.len()).map(|index| (gap(index), index));
        let Some((gap, index)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0)) else { return };
        let obstacle = &sight.around.apparent[index];
        let outline = obstacle.shape.outline();
        let settings = &sight.remedies.watch;
        let suspended = State::Suspended { until: sight.time() + settings.patience };
        if gap < 0.0 {
            let walls: Vec<Outline<'_>> = sight.around.real.iter().map(|real| real.shape.outline()).collect();
            let (room, cut) = (sight.potential.pole_with_margin(), sight.potential.cut());
            let way = escape(&outline, &walls, robot, room, cut);
            self.state = way.map_or(suspended, |way| State::Escaping { obstacle: obstacle.id, carrot: robot, way });
            return;
        }
        let target = match drawn {
            Drawn::To(foot) => foot.point,
            Drawn::Goal(goal) => goal,
        };
        let repelled = gap < sight.potential.cut() + settings.radius;
        if self.watch.is_caught(settings, sight.time(), robot, (target - robot).norm(), repelled) {
            let seen = sight.seen_by(index, robot);
            self.state = match guard(&sight.moment.segment, drawn, &outline, seen, settings.radius) {
                Some(guard) => {
                    let sunk = guard.protrusion(&outline, seen).max(0.0);
                    State::Guarded { obstacle: obstacle.id, guard, sunk }
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
