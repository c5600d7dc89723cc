//! A robot's way out of local minima (7.6, 7.7, Remark 6.4.1).
use super::surroundings::Moment;
use super::{Remedies, RemedyState, Surroundings};
use crate::Vector2;
use crate::avoidance::{Guard, Watch, auxiliary_arc, auxiliary_lines, escape, way_round};
use crate::curve::{Foot, Placed};
use crate::hull::{Approach, Outline};
use crate::zoning::{ObstaclePotential, Zone, Zoning};

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
    /// Round teammates ahead, after a `carrot` that goes along the way ahead, until a time at the latest, s.
    Led { until: f64, carrot: Vector2<f64>, way: Vec<Vector2<f64>> },
}

/// What draws a robot that may be caught.
#[derive(Debug, Clone, Copy)]
pub(super) enum Drawn {
    /// A nearest point, which moves along with the robot or not.
    To(Foot),
    /// A goal point.
    Goal(Vector2<f64>),
}

impl Drawn {
    pub(super) fn point(self) -> Vector2<f64> {
        match self {
            Self::To(foot) => foot.point,
            Self::Goal(goal) => goal,
        }
    }
}

/// What remedies look at: displacements of obstacles since the tick included.
#[derive(Clone, Copy)]
pub(super) struct Sight<'a> {
    pub(super) remedies: &'a Remedies,
    pub(super) potential: &'a ObstaclePotential,
    pub(super) zoning: &'a Zoning,
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

    /// Least distance from the zone 2 of a robot ahead, m; negative within.
    fn teammate_gap(&self, robot: Vector2<f64>) -> f64 {
        let near = self.teammates().map(|other| (other - robot).norm()).fold(f64::INFINITY, f64::min);
        near - self.zoning.radii().rho_hat
    }

    /// Whether the leader's attraction acts: the robot may be held by it, and a guard before an obstacle, which the nearest point moves
    /// along, is no help.
    fn is_pulled(&self, robot: Vector2<f64>) -> bool {
        let leader = self.around.leader.map(|leader| leader.state.coasted(self.moment.since).position);
        leader.is_some_and(|leader| self.zoning.zone((leader - robot).norm()) >= Zone::Attractive)
    }

    fn teammates(&self) -> impl Iterator<Item = Vector2<f64>> + '_ {
        let leader = self.around.leader.map(|leader| leader.state);
        self.around.ahead.iter().copied().chain(leader).map(|robot| robot.coasted(self.moment.since).position)
    }

    /// Moves a `carrot` along the way ahead of a robot that comes after it.
    fn lead(&self, robot: Vector2<f64>, carrot: &mut Vector2<f64>, way: &mut Vec<Vector2<f64>>) {
        let pace = self.remedies.rising * self.step;
        if let Some(next) = way.first().copied().filter(|_| (*carrot - robot).norm() < self.potential.cut()) {
            let ahead = next - *carrot;
            if ahead.norm() <= pace {
                way.remove(0);
            }
            *carrot += ahead.cap_magnitude(pace);
        }
    }

    /// A way to `target` that keeps out of the middle of the repulsion of teammates ahead and obstacles; a rest if there is none.
    fn led(&self, robot: Vector2<f64>, target: Vector2<f64>) -> State {
        let radii = self.zoning.radii();
        let (apart, room) = (0.5 * (radii.rho_underbar + radii.rho_hat), self.potential.pole_with_margin());
        let is_free = |point: Vector2<f64>| {
            self.teammates().all(|other| (other - point).norm() >= apart)
                && (0..self.around.apparent.len()).all(|index| self.approach(index, point).gap >= room)
        };
        let patience = self.remedies.watch.patience;
        match way_round(robot, target, (0.25 * apart, 4.0 * radii.rho_hat), is_free) {
            Some(way) => {
                let corners = core::iter::once(&robot).chain(&way).zip(&way);
                let length: f64 = corners.map(|(from, to)| (to - from).norm()).sum();
                // Twice what the way takes: what is in the way then may be somewhere else.
                let until = self.time() + patience + 2.0 * length / self.remedies.rising;
                State::Led { until, carrot: robot, way }
            }
            None => State::Suspended { until: self.time() + patience },
        }
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
            State::Led { .. } => RemedyState::Led,
        }
    }

    /// Whether it changes what [`Self::approach`] says of the obstacle of an id.
    pub(super) fn concerns(&self, id: u32) -> bool {
        matches!(&self.state, State::Guarded { obstacle, .. } | State::Escaping { obstacle, .. } if *obstacle == id)
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

    /// See [`Agent::way_out`](super::Agent::way_out).
    pub(super) fn way_out(&self, from: Vector2<f64>) -> Vec<Vector2<f64>> {
        match &self.state {
            State::Guarded { guard, sunk, .. } => guard.sunk(*sunk).outline().to_vec(),
            State::Escaping { carrot, way, .. } | State::Led { carrot, way, .. } => {
                [from, *carrot].into_iter().chain(way.iter().copied()).collect()
            }
            State::Free | State::Suspended { .. } => Vec::new(),
        }
    }

    /// The robot rests on purpose: what it was watched for begins anew.
    pub(super) fn pause(&mut self) {
        self.watch.restart();
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
        let target = drawn.point();
        let mut held = false;
        match &mut self.state {
            State::Free => self.choose(sight, robot, drawn),
            State::Guarded { obstacle, guard, sunk } => {
                *sunk = (*sunk - sight.remedies.rising * sight.step).max(0.0);
                let seen = sight.find(*obstacle).map_or(robot, |index| sight.seen_by(index, robot));
                if !guard.shields(seen) {
                    *self = Self::default();
                } else if *sunk > 0.0 {
                    self.watch.restart();
                } else {
                    // Guards have places of rest of their own.
                    let deviation = (target - robot).norm();
                    held = self.watch.is_caught(&sight.remedies.watch, sight.time(), robot, deviation, true);
                }
            }
            State::Suspended { until } if sight.time() >= *until => *self = Self::default(),
            State::Suspended { .. } => {}
            State::Escaping { obstacle, carrot, way } => {
                let cut = sight.potential.cut();
                if sight.find(*obstacle).is_none_or(|index| sight.approach(index, robot).gap >= cut) {
                    *self = Self::default();
                } else {
                    sight.lead(robot, carrot, way);
                }
            }
            State::Led { until, carrot, way } => {
                let there = way.is_empty() && (*carrot - robot).norm() <= sight.remedies.watch.arrived;
                // Another place was chosen meanwhile, or the segment has gone on.
                let astray = (way.last().unwrap_or(carrot) - target).norm() > sight.zoning.radii().rho_hat;
                if there || astray || sight.time() >= *until {
                    *self = Self::default();
                } else {
                    sight.lead(robot, carrot, way);
                }
            }
        }
        if held {
            self.state = sight.led(robot, target);
        }
        match &self.state {
            State::Free | State::Guarded { .. } => Asked::Attraction,
            State::Suspended { .. } => Asked::Suspension,
            State::Escaping { carrot, .. } | State::Led { carrot, .. } => Asked::Point(*carrot),
        }
    }

    fn choose(&mut self, sight: &Sight<'_>, robot: Vector2<f64>, drawn: Drawn) {
        let gap = |index: usize| sight.approach(index, robot).gap;
        let nearest = (0..sight.around.apparent.len()).map(|index| (gap(index), index));
        let target = drawn.point();
        let deviation = (target - robot).norm();
        let settings = &sight.remedies.watch;
        let crowded = sight.teammate_gap(robot) < settings.radius;
        let Some((gap, index)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            if self.watch.is_caught(settings, sight.time(), robot, deviation, crowded) {
                self.state = sight.led(robot, target);
            }
            return;
        };
        let obstacle = &sight.around.apparent[index];
        let outline = obstacle.shape.outline();
        let suspended = State::Suspended { until: sight.time() + settings.patience };
        if gap < 0.0 {
            let walls: Vec<Outline<'_>> = sight.around.real.iter().map(|real| real.shape.outline()).collect();
            let (room, cut) = (sight.potential.pole_with_margin(), sight.potential.cut());
            let way = escape(&outline, &walls, robot, room, cut);
            self.state = way.map_or(suspended, |way| State::Escaping { obstacle: obstacle.id, carrot: robot, way });
            return;
        }
        let repelled = gap < sight.potential.cut() + settings.radius;
        if self.watch.is_caught(settings, sight.time(), robot, deviation, repelled || crowded) {
            let seen = sight.seen_by(index, robot);
            let guard = || guard(&sight.moment.segment, drawn, &outline, seen, settings.radius);
            let guarded = repelled && !crowded && !sight.is_pulled(robot);
            self.state = match Some(()).filter(|()| guarded).and_then(|()| guard()) {
                Some(guard) => {
                    let sunk = guard.protrusion(&outline, seen).max(0.0);
                    State::Guarded { obstacle: obstacle.id, guard, sunk }
                }
                None => sight.led(robot, target),
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
