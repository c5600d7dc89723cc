//! What remedies look at, and ways that are free.
use super::{Drawn, State};
use crate::Vector2;
use crate::agent::surroundings::Moment;
use crate::agent::{Remedies, Surroundings};
use crate::avoidance::way_round;
use crate::curve::Interval;
use crate::hull::Approach;
use crate::zoning::{ObstaclePotential, Zone, Zoning};

/// Pieces of a straight line that are looked at.
const LOOKS: u32 = 64;
/// How far beyond robot and target ways are looked for, of rho_hat.
const ASIDE: f64 = 4.0;
/// Places on the segment are looked at each so far, of rho_hat.
const STRIDE: f64 = 0.05;

/// What remedies look at: displacements of obstacles since the tick included.
#[derive(Clone, Copy)]
pub(in crate::agent) struct Sight<'a> {
    pub(in crate::agent) remedies: &'a Remedies,
    pub(in crate::agent) potential: &'a ObstaclePotential,
    pub(in crate::agent) zoning: &'a Zoning,
    /// The robot's qualified fragments, m of arc length.
    pub(in crate::agent) fragments: &'a [Interval],
    pub(in crate::agent) around: &'a Surroundings<'a>,
    pub(in crate::agent) moment: &'a Moment<'a>,
    /// Seconds since the last update.
    pub(in crate::agent) step: f64,
}

impl Sight<'_> {
    pub(super) fn time(&self) -> f64 {
        self.around.time + self.moment.since
    }

    /// `point` as the apparent obstacle sees it that was at the tick where it is given.
    pub(super) fn seen_by(&self, index: usize, point: Vector2<f64>) -> Vector2<f64> {
        point - self.around.displacement(index, self.moment.since)
    }

    pub(super) fn approach(&self, index: usize, robot: Vector2<f64>) -> Approach {
        self.around.apparent[index].shape.outline().approach(self.seen_by(index, robot))
    }

    /// Whether a `carrot` waits for a robot that does not come after it.
    pub(super) fn waits(&self, robot: Vector2<f64>, carrot: &Vector2<f64>) -> bool {
        (carrot - robot).norm() >= self.potential.cut()
    }

    /// Whether a robot has come to the end of the way that its `carrot` leads it.
    pub(super) fn has_gone(&self, robot: Vector2<f64>, carrot: &Vector2<f64>, way: &[Vector2<f64>]) -> bool {
        way.is_empty() && (carrot - robot).norm() <= self.remedies.watch.arrived
    }

    /// A way round what moves goes along with it while the robot is near it: else it would be overrun. Its end goes along with the segment, and so
    /// does all of it where only teammates are near.
    pub(super) fn carry(&self, robot: Vector2<f64>, carrot: &mut Vector2<f64>, way: &mut [Vector2<f64>]) {
        let reach = self.potential.cut() + self.remedies.watch.radius;
        let gaps = (0..self.around.apparent.len()).map(|index| (self.approach(index, robot).gap, index));
        let near = gaps.filter(|(gap, _)| *gap < reach).min_by(|a, b| a.0.total_cmp(&b.0));
        let with_segment = |point: &mut Vector2<f64>| *point += self.step * self.moment.motion.velocity_at(*point);
        let along = |point: &mut Vector2<f64>| match near {
            Some((_, index)) => *point += self.step * self.around.velocity(index),
            None => with_segment(point),
        };
        match way.split_last_mut() {
            Some((end, corners)) => {
                along(carrot);
                corners.iter_mut().for_each(along);
                with_segment(end);
            }
            None => with_segment(carrot),
        }
    }

    /// Where a robot is in the frame of a segment that moves: who is held by teammates stands there.
    pub(super) fn in_frame(&self, robot: Vector2<f64>) -> Option<Vector2<f64>> {
        (!self.moment.motion.rests()).then(|| self.moment.segment.to_curve(robot))
    }

    /// Least distance from the zone 2 of a robot ahead, m; negative within.
    pub(super) fn teammate_gap(&self, robot: Vector2<f64>) -> f64 {
        let near = self.teammates().map(|other| (other - robot).norm()).fold(f64::INFINITY, f64::min);
        near - self.zoning.radii().rho_hat
    }

    /// Whether the leader's attraction acts: the robot may be held by it, and a guard before an obstacle, which the nearest point moves
    /// along, is no help.
    pub(super) fn is_pulled(&self, robot: Vector2<f64>) -> bool {
        self.leader().is_some_and(|leader| self.zoning.zone((leader - robot).norm()) >= Zone::Attractive)
    }

    /// Whether the leader's attraction would draw the robot into a hull.
    pub(super) fn is_pulled_into(&self, index: usize, robot: Vector2<f64>) -> bool {
        let leader = self.leader();
        let through = |leader: Vector2<f64>| {
            (1..LOOKS).any(|look| {
                let share = f64::from(look) / f64::from(LOOKS);
                self.approach(index, robot + share * (leader - robot)).gap < 0.0
            })
        };
        self.is_pulled(robot) && leader.is_some_and(through)
    }

    fn leader(&self) -> Option<Vector2<f64>> {
        self.around.leader.map(|leader| leader.state.coasted(self.moment.since).position)
    }

    fn teammates(&self) -> impl Iterator<Item = Vector2<f64>> + '_ {
        let leader = self.around.leader.map(|leader| leader.state);
        self.around.ahead.iter().copied().chain(leader).map(|robot| robot.coasted(self.moment.since).position)
    }

    /// Moves a `carrot` along the way ahead of a robot that comes after it.
    pub(super) fn lead(&self, robot: Vector2<f64>, carrot: &mut Vector2<f64>, way: &mut Vec<Vector2<f64>>) {
        let pace = self.remedies.rising * self.step;
        if let Some(next) = way.first().copied().filter(|_| !self.waits(robot, carrot)) {
            let ahead = next - *carrot;
            if ahead.norm() <= pace {
                way.remove(0);
            }
            *carrot += ahead.cap_magnitude(pace);
        }
    }

    /// A way to what draws the robot; to a place of its own, if there is none to a point of the segment, or zoning would not let it stay there;
    /// else a rest.
    pub(super) fn led(&self, robot: Vector2<f64>, drawn: Drawn, wary: bool) -> State {
        let own = || matches!(drawn, Drawn::To(_)).then(|| self.led_to_place(robot, wary)).flatten();
        if !self.may_stay(drawn.point())
            && let Some(led) = own()
        {
            return led;
        }
        let rest = || State::Suspended { until: self.time() + self.remedies.watch.patience, within: None };
        let to_point = |wary: bool| self.way(robot, drawn.point(), (false, wary));
        let far_round = || (!wary && self.around.motion.rests()).then(|| to_point(true)).flatten();
        to_point(wary).or_else(own).or_else(far_round).unwrap_or_else(rest)
    }

    /// Whether a point lies in nobody's zone 2, nor in the zone 4 of a leader that has arrived. Nearer to the neutral zone than the watch's radius
    /// it is as good as there.
    pub(super) fn may_stay(&self, point: Vector2<f64>) -> bool {
        let radius = self.remedies.watch.radius;
        self.teammate_gap(point) >= -radius && self.leader_gap(point) <= radius
    }

    /// A way to the nearest place where the robot can rest; nothing if there is none.
    pub(super) fn led_to_place(&self, robot: Vector2<f64>, wary: bool) -> Option<State> {
        self.way(robot, self.place(robot)?, (true, wary))
    }

    /// How far beyond rho the leader is that has come to what draws it, m; negative within, and while the leader is under way.
    pub(super) fn leader_gap(&self, robot: Vector2<f64>) -> f64 {
        let settled = self.around.leader.is_some_and(|leader| leader.deviation <= self.remedies.watch.arrived);
        let distance = self.leader().filter(|_| settled).map_or(0.0, |leader| (leader - robot).norm());
        distance - self.zoning.radii().rho
    }

    /// The place on the robot's fragments, nearest to it, that lies in nobody's zone 2, in its leader's neutral zone and beyond the reach of
    /// obstacles: there nothing but the trench acts. Along the segment the leader may be far from what is nearest to the robot.
    fn place(&self, robot: Vector2<f64>) -> Option<Vector2<f64>> {
        let near = |point: Vector2<f64>| self.place_near(robot, self.moment.segment.nearest(point).arc_length);
        near(robot).or_else(|| self.leader().and_then(near))
    }

    /// Of those about an arc length of `middle` (m).
    fn place_near(&self, robot: Vector2<f64>, middle: f64) -> Option<Vector2<f64>> {
        let (radii, segment, margin) = (self.zoning.radii(), &self.moment.segment, self.remedies.watch.arrived);
        let reach = radii.rho + radii.rho_check;
        let fits = |point: Vector2<f64>| {
            // Of those farther off only the places are known.
            let places = self.around.places.iter().copied();
            self.teammates().chain(places).all(|other| (other - point).norm() >= radii.rho_hat + margin)
                && self.leader().is_none_or(|leader| (leader - point).norm() <= radii.rho - margin)
                && (0..self.around.apparent.len()).all(|index| self.approach(index, point).gap >= self.potential.cut())
        };
        let mut best: Option<(f64, Vector2<f64>)> = None;
        // Round a closed segment places lie on either side of where arc lengths begin.
        let curve = segment.curve();
        let rounds: &[f64] = if curve.is_closed() { &[-1.0, 0.0, 1.0] } else { &[0.0] };
        for ((low, high), round) in
            self.fragments.iter().flat_map(|fragment| rounds.iter().map(move |round| (fragment, round)))
        {
            let shift = round * curve.length();
            let (low, high) = (low.max(middle - reach - shift), high.min(middle + reach - shift));
            let count = libm::ceil((high - low) / (STRIDE * radii.rho_hat)).max(0.0) as u32;
            for index in 0..=count {
                let share = f64::from(index) / f64::from(count.max(1));
                let point = segment.at(low + share * (high - low)).point;
                let distance = (point - robot).norm();
                if low <= high && best.is_none_or(|(least, _)| distance < least) && fits(point) {
                    best = Some((distance, point));
                }
            }
        }
        best.map(|(_, point)| point)
    }

    /// A way to `target` that keeps out of the middle of the repulsion of teammates ahead and obstacles, if `wary` out of all of that of obstacles where
    /// there is one; `own` if the robot has chosen it.
    fn way(&self, robot: Vector2<f64>, target: Vector2<f64>, (own, wary): (bool, bool)) -> Option<State> {
        let radii = self.zoning.radii();
        let apart = 0.5 * (radii.rho_underbar + radii.rho_hat);
        // Who stands nearer to a teammate may leave it.
        let is_off = |other: Vector2<f64>, point: Vector2<f64>| {
            let distance = (other - point).norm();
            distance >= apart || (distance >= (other - robot).norm() && (point - robot).norm() <= apart)
        };
        let with = |(room, aside): (f64, f64)| {
            let is_free = |point: Vector2<f64>| {
                self.teammates().all(|other| is_off(other, point))
                    && (0..self.around.apparent.len()).all(|index| self.approach(index, point).gap >= room)
            };
            way_round(robot, target, (0.25 * apart, aside), is_free)
        };
        let patience = self.remedies.watch.patience;
        let aside = ASIDE * radii.rho_hat;
        // Where there is no way between them, there may be one round the end of long walls.
        // From a segment that moves on, the end of a long way is gone when the robot comes there.
        let goes_far = wary && self.around.motion.rests();
        let clear = goes_far.then(|| with((self.potential.cut(), 4.0 * aside))).flatten();
        // What is nearest to a robot that goes along a wall goes with it: that is no other place.
        let own = own || clear.is_some();
        let way = clear.or_else(|| with((self.potential.pole_with_margin(), aside)))?;
        let corners = core::iter::once(&robot).chain(&way).zip(&way);
        let length: f64 = corners.map(|(from, to)| (to - from).norm()).sum();
        // Twice what the way takes: what is in the way then may be somewhere else.
        let until = self.time() + patience + 2.0 * length / self.remedies.rising;
        Some(State::Led { until, carrot: robot, way, own })
    }

    pub(super) fn find(&self, id: u32) -> Option<usize> {
        self.around.apparent.iter().position(|obstacle| obstacle.id == id)
    }
}
