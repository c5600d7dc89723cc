//! What is measured of the robots of a case.

use crate::closest::Closest;
use crate::course::LANES;
use crate::divergence::Divergence;
use crate::four::{Four, Now, Times};
use crate::gaps::Gaps;
use crate::robots::{Robots, bits};
use crate::transits::Watch;
use crate::{LyapunovSummary, Seat};
use std::ops::Range;
use trench_formation::hull::Obstacle;
use trench_formation::kinematics::PointState;
use trench_formation::zoning::Zoning;

/// Robots that stand together.
#[derive(Debug, Clone)]
pub(crate) struct Team {
    /// Theirs, among all.
    seats: Range<usize>,
    fours: Vec<Four>,
    times: Vec<Times>,
    /// Who has to be looked at more closely.
    astray: Vec<u32>,
    pub(crate) closest: Closest,
    pub(crate) gaps: Gaps,
    /// When a robot was last outside its leader's neutral zone, s; negative: never.
    pub(crate) last_outside: f64,
    /// s.
    pub(crate) in_zone_1: f64,
}

/// What robots are among.
pub(crate) struct Among<'a> {
    pub(crate) seats: &'a [Seat],
    pub(crate) zoning: Option<&'a Zoning>,
    pub(crate) obstacles: &'a [Obstacle],
}

impl Team {
    /// Of the robots in some of all seats.
    pub(crate) fn new(all: &[Seat], seats: Range<usize>) -> Self {
        let fours = all[seats.clone()].chunks(LANES).map(|four| {
            Four::new(bits(core::array::from_fn(|lane| four.get(lane).is_some_and(|seat| seat.leader.is_some()))))
        });
        Self {
            fours: fours.collect(),
            times: vec![Times::never(); seats.len()],
            seats,
            astray: Vec::new(),
            closest: Closest::default(),
            gaps: Gaps::default(),
            last_outside: -1.0,
            in_zone_1: 0.0,
        }
    }

    /// Looks at all robots, and more closely at those that went farther than was foreseen when they were last looked at so.
    pub(crate) fn look(
        &mut self,
        robots: &(impl Robots + ?Sized),
        (among, now): (&Among<'_>, &Now),
        divergence: &mut Divergence,
        transits: Option<&mut Watch>,
        copies: &mut Vec<PointState>,
    ) {
        self.astray.clear();
        let (mut leader, mut is_outside) = ([0.0; 2], false);
        let groups = self.fours.iter_mut().zip(self.times.chunks_mut(LANES));
        for (number, (four, times)) in groups.enumerate() {
            let (first, count) = (number * LANES, times.len());
            let seen = robots.seen(self.seats.start + first, self.seats.end);
            let told = four.look(&seen, leader, now, times);
            leader = [seen.x.as_array()[LANES - 1], seen.y.as_array()[LANES - 1]];
            is_outside |= told.outside;
            if told.astray != 0 {
                let lanes = (0..count).filter(|lane| told.astray & (1 << lane) != 0);
                self.astray.extend(lanes.map(|lane| (first + lane) as u32));
            }
        }
        if is_outside {
            self.last_outside = now.time;
        }
        let points = robots.points(self.seats.start, self.seats.end, copies);
        let transits = transits.and_then(|transits| {
            let Some(mut look) = transits.moving(now.time) else { return Some(transits) };
            // Whether a robot stays where it is says nothing then.
            for (seat, robot) in self.seats.clone().zip(points) {
                look.look(seat, robot.position);
            }
            None
        });
        let changed = self.gaps.prepare(among.obstacles, points);
        if changed || !self.astray.is_empty() {
            self.look_closely(points, (among, now), changed, divergence, transits);
        }
        self.gaps.remember(points);
    }

    /// Looks at those who are `astray`, or at all where obstacles have `changed` or robots near each other have to be sought anew.
    #[inline(never)]
    fn look_closely(
        &mut self,
        points: &[PointState],
        (among, now): (&Among<'_>, &Now),
        changed: bool,
        divergence: &mut Divergence,
        transits: Option<&mut Watch>,
    ) {
        let Self { seats, fours, astray, closest, gaps, in_zone_1, .. } = self;
        if closest.prepare(points, astray, among.zoning) || changed {
            astray.clear();
            astray.extend(0..points.len() as u32);
        }
        let mut transits = transits.map(|transits| transits.at(now.time));
        for &index in astray.iter() {
            let index = index as usize;
            let (seat, position) = (seats.start + index, points[index].position);
            let apart = closest.look(points, index, among.zoning, || *in_zone_1 += now.step);
            let room =
                divergence.look(&among.seats[seat], position, now.time).min(gaps.look(index, position, now.time));
            let stays = transits.as_mut().map_or(f64::INFINITY, |transits| transits.look(seat, position));
            fours[index / LANES].rooms.set(index % LANES, position, room.min(apart).min(stays));
        }
    }

    /// The seats of its robots.
    pub(crate) fn seats(&self) -> Range<usize> {
        self.seats.clone()
    }

    /// From now on V of the robot of an index in the team is another function.
    pub(crate) fn begin_anew(&mut self, index: usize) {
        if let Some(four) = self.fours.get_mut(index / LANES) {
            four.begin_anew(index % LANES);
        }
    }

    /// See [`Four::lyapunov`].
    pub(crate) fn lyapunov(&self, index: usize, last: f64, step: f64) -> LyapunovSummary {
        self.fours[index / LANES].lyapunov(index % LANES, last, step)
    }

    /// See [`Four::leader_range`].
    pub(crate) fn leader_range(&self, index: usize) -> [f64; 2] {
        self.fours[index / LANES].leader_range(index % LANES)
    }

    /// See [`Four::last`].
    pub(crate) fn last(&self, index: usize, time: f64) -> [f64; 2] {
        self.fours[index / LANES].last(index % LANES, self.times[index], time)
    }
}
