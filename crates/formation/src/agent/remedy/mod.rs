//! A robot's way out of local minima (7.6, 7.7, Remark 6.4.1): what it remembers of one, and how that goes on.
//!
//! [`choose`] notices that a robot is caught or enclosed and chooses; [`sight`] is what there is to be seen.
mod choose;
mod sight;

pub(super) use sight::Sight;

use super::{RemedyState, Surroundings};
use crate::Vector2;
use crate::avoidance::{Guard, Watch};
use crate::curve::Foot;
use crate::hull::Approach;

/// What one robot remembers.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Remedy {
    watch: Watch,
    /// In the frame of a segment that moves.
    carried: Watch,
    /// In the frame of an obstacle that pushes the robot along, away from what draws it.
    drift: Watch,
    /// Rest in a zone where nobody may stay, on the segment or off it.
    rest: Watch,
    /// It was led along a way that it could not go: the attraction is bounded, and what stands on both sides of a gap may hold more than that.
    wary: bool,
    state: State,
}

#[derive(Debug, Clone, PartialEq, Default)]
enum State {
    #[default]
    Free,
    /// A guard stands before the obstacle of an id, still `sunk` (m) below its place.
    Guarded { obstacle: u32, guard: Guard, sunk: f64 },
    /// No attraction until a time, s (Remark 6.4.1); within the hull of an obstacle of an id, out of which there is no way.
    Suspended { until: f64, within: Option<u32> },
    /// Inside an obstacle's hull, after a `carrot` that goes along the way ahead.
    Escaping { obstacle: u32, carrot: Vector2<f64>, way: Vec<Vector2<f64>> },
    /// Round teammates ahead, after a `carrot` that goes along the way ahead, until a time at the latest, s; to a place that the robot has
    /// chosen on its `own`, or to what draws it.
    Led { until: f64, carrot: Vector2<f64>, way: Vec<Vector2<f64>>, own: bool },
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

/// What pushes a robot away.
#[derive(Debug, Clone, Copy)]
struct Pushed {
    /// The nearest obstacle, by its index.
    obstacle: Option<usize>,
    /// Teammates.
    crowded: bool,
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
        match &self.state {
            State::Guarded { obstacle, .. } | State::Escaping { obstacle, .. } => *obstacle == id,
            State::Suspended { within, .. } => *within == Some(id),
            State::Free | State::Led { .. } => false,
        }
    }

    /// Distance and direction of an apparent obstacle with its guard; of its nearest member while the robot is on its way out, or has none:
    /// the hull would throw a robot that it encloses through a wall.
    pub(super) fn approach(
        &self,
        around: &Surroundings<'_>,
        since: f64,
        index: usize,
        robot: Vector2<f64>,
    ) -> Approach {
        let obstacle = &around.apparent[index];
        let whole = || around.approach(index, since, robot);
        match &self.state {
            State::Guarded { obstacle: id, guard, sunk } if *id == obstacle.id => {
                guard.sunk(*sunk).approach(&obstacle.shape.outline(), robot - around.displacement(index, since))
            }
            State::Escaping { obstacle: id, .. } | State::Suspended { within: Some(id), .. } if *id == obstacle.id => {
                around.approach_of_members(index, since, robot).unwrap_or_else(whole)
            }
            _ => whole(),
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
        self.restart();
    }

    fn restart(&mut self) {
        self.watch.restart();
        self.carried.restart();
        self.drift.restart();
        self.rest.restart();
    }

    /// Whether the robot rests where zoning holds it, within somebody's zone 2 on the segment, or in the zone 4 of a leader that has arrived: the local minima
    /// of 6.4. Nearer than the watch's radius to the neutral zone it is as good as there.
    fn is_trapped(&mut self, sight: &Sight<'_>, robot: Vector2<f64>, drawn: Drawn) -> bool {
        let Drawn::To(foot) = drawn else { return false };
        let watch = &sight.remedies.watch;
        let arrived = (foot.point - robot).norm() <= watch.arrived;
        let held = (arrived && sight.teammate_gap(robot) < -watch.radius) || sight.leader_gap(robot) > watch.radius;
        let stands = sight.in_frame(robot).unwrap_or(robot);
        let rests = self.rest.is_caught(watch, sight.time(), stands, f64::INFINITY, held);
        if rests {
            self.rest.restart();
        }
        rests
    }

    /// Whether a robot that something pushes away stays where it is, or before an obstacle that drives it away from its target, or, held by
    /// teammates, where it is in the frame of the segment.
    fn is_caught(&mut self, sight: &Sight<'_>, robot: Vector2<f64>, target: Vector2<f64>, pushed: Pushed) -> bool {
        let (settings, time, deviation) = (&sight.remedies.watch, sight.time(), (target - robot).norm());
        let repelled = pushed.obstacle.is_some() || pushed.crowded;
        let stays = self.watch.is_caught(settings, time, robot, deviation, repelled);
        let carried = sight
            .in_frame(robot)
            .is_some_and(|stands| self.carried.is_caught(settings, time, stands, deviation, pushed.crowded));
        self.is_driven(sight, robot, target, pushed.obstacle) || stays || carried
    }

    /// Whether a robot stays before an obstacle that moves, and drives it away from its target.
    fn is_driven(&mut self, sight: &Sight<'_>, robot: Vector2<f64>, target: Vector2<f64>, by: Option<usize>) -> bool {
        let velocity = by.map(|index| sight.around.velocity(index));
        let Some(velocity) = velocity.filter(|velocity| velocity.dot(&(target - robot)) < 0.0) else {
            self.drift.restart();
            return false;
        };
        let (time, deviation) = (sight.time(), (target - robot).norm());
        self.drift.is_caught(&sight.remedies.watch, time, robot - time * velocity, deviation, true)
    }

    /// A tick: guards have gone on with their obstacles, and what is gone needs no remedy.
    pub(super) fn carry_on(&mut self, around: &Surroundings<'_>, elapsed: f64) {
        let (State::Guarded { obstacle, .. }
        | State::Escaping { obstacle, .. }
        | State::Suspended { within: Some(obstacle), .. }) = &self.state
        else {
            return;
        };
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
                let index = sight.find(*obstacle);
                let seen = index.map_or(robot, |index| sight.seen_by(index, robot));
                if !guard.shields(seen) {
                    *self = Self::default();
                } else if *sunk > 0.0 {
                    self.restart();
                } else {
                    // Guards have places of rest of their own.
                    held = self.is_caught(sight, robot, target, Pushed { obstacle: index, crowded: false });
                }
            }
            State::Suspended { until, .. } if sight.time() >= *until => {
                *self = Self::default();
                // A robot that is still enclosed looks for a way at once.
                self.choose(sight, robot, drawn);
            }
            State::Suspended { .. } => {}
            State::Escaping { obstacle, carrot, way } => {
                let cut = sight.potential.cut();
                match sight.find(*obstacle) {
                    Some(index) if sight.approach(index, robot).gap < cut => {
                        // The way out goes along with what encloses the robot.
                        let by = sight.step * sight.around.velocity(index);
                        *carrot += by;
                        way.iter_mut().for_each(|corner| *corner += by);
                        sight.lead(robot, carrot, way);
                        // A teammate may stand where the way ends, or a wall before it.
                        let (gap, deviation) = (sight.approach(index, robot).gap, (target - robot).norm());
                        let waits = sight.waits(robot, carrot) || way.is_empty();
                        let stays = self.watch.is_caught(&sight.remedies.watch, sight.time(), robot, deviation, waits);
                        if (stays && gap <= 0.0) || sight.has_gone(robot, carrot, way) {
                            // More of what is in the hull is known since: it has grown, or there is a wall in the way.
                            *self = Self::default();
                            self.choose(sight, robot, drawn);
                        } else {
                            held = stays && gap > 0.0;
                        }
                    }
                    out => {
                        *self = Self::default();
                        // Else it would come back at once.
                        held = out.is_some_and(|index| sight.is_pulled_into(index, robot));
                    }
                }
            }
            State::Led { until, carrot, way, own } => {
                let there = sight.has_gone(robot, carrot, way);
                // Another place was chosen meanwhile, or the segment has gone on.
                let astray = !*own && (way.last().unwrap_or(carrot) - target).norm() > sight.zoning.radii().rho_hat;
                if there || astray || sight.time() >= *until {
                    *self = Self { wary: !there && !astray, ..Self::default() };
                } else {
                    sight.carry(robot, carrot, way);
                    sight.lead(robot, carrot, way);
                    // Teammates may have taken places on the way since it was found.
                    let (waits, deviation) = (sight.waits(robot, carrot), (target - robot).norm());
                    held = self.watch.is_caught(&sight.remedies.watch, sight.time(), robot, deviation, waits);
                }
            }
        }
        if held {
            self.restart();
            self.wary |= matches!(self.state, State::Led { .. });
            self.state = sight.led(robot, drawn, self.wary);
        }
        match &self.state {
            State::Free | State::Guarded { .. } => Asked::Attraction,
            State::Suspended { .. } => Asked::Suspension,
            State::Escaping { carrot, .. } | State::Led { carrot, .. } => Asked::Point(*carrot),
        }
    }
}
