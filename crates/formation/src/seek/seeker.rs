//! Steps (4) to (6) of 7.5.2 and the decision on transits.
use super::{Fragments, LeaderRule, SeekSettings};
use crate::Vector2;
use crate::curve::{Foot, Interval, Placed, Warm};
use crate::zoning::{Radii, Zone};

/// Distances that differ by less than this (m) make a tie.
const TIE: f64 = 1e-9;

/// What a robot knows of its leader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeaderView {
    /// m, frame `map`.
    pub position: Vector2<f64>,
    /// Distance from its nearest point, m.
    pub distance: f64,
    /// Speed relative to the segment, m/s.
    pub speed: f64,
}

/// The outcome of a round of seeking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sought {
    /// The nearest point that draws the robot; its distance is that from the robot.
    Point(Foot),
    /// Step (5): a tie while the leader is still under way; the attraction is off.
    Tie,
    /// No fragment has room for a robot.
    NoFragment,
}

/// One robot's memory of its nearest point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Seeker {
    kept: Option<f64>,
    warm: Warm,
}

impl Seeker {
    /// The nearest point for a robot at `robot` that follows `leader` (none for a chain leader, who decides ties by arc length).
    /// `whole` is the segment's interval without encroachment.
    ///
    /// A robot follows the local minimum of the distance that it has, until another is nearer by more than the margin: so a
    /// nearest point is unique (Assumption 7.2.1), and noise at a transit point moves nobody to and fro.
    pub fn seek(
        &mut self,
        settings: &SeekSettings,
        segment: &Placed<'_>,
        (whole, fragments): (Interval, &Fragments),
        robot: Vector2<f64>,
        leader: Option<(LeaderView, &Radii)>,
    ) -> Sought {
        let far =
            |(leader, radii): (LeaderView, &Radii)| radii.zone((leader.position - robot).norm()) >= Zone::Attractive;
        let whole = [whole];
        let free = settings.leader_rule == LeaderRule::WholeSegmentWhileFar && leader.is_some_and(far);
        let intervals = if free { &whole } else { fragments.intervals() };
        let unrestricted = segment.nearest_again(robot, &mut self.warm);
        let search = Search { segment, robot, margin: settings.transit_margin, kept: self.kept, unrestricted };
        let Some(best) = search.nearest(intervals, |_| true) else {
            self.kept = None;
            return Sought::NoFragment;
        };
        let settled = leader.filter(|(leader, _)| {
            leader.distance <= settings.settled_distance && leader.speed <= settings.settled_speed
        });
        let in_zone = |(leader, radii): (LeaderView, &Radii), foot: &Foot| {
            (leader.position - foot.point).norm() < radii.rho_check
        };
        let mut chosen = match search.keep(intervals, best) {
            Some(kept) => kept,
            None => match leader {
                None => best,
                Some(view) => {
                    let mut tied = search.tied(intervals, best, view.0.position);
                    match (tied.next(), settled) {
                        (None, _) => best,
                        (Some(_), None) => return Sought::Tie,
                        (Some(other), Some(view)) => {
                            let mut all = [best, other].into_iter().chain(tied);
                            all.find(|foot| in_zone(view, foot)).unwrap_or(best)
                        }
                    }
                }
            },
        };
        if let Some(view) = settled.filter(|view| !in_zone(*view, &chosen)) {
            let near = |part: Interval| in_zone(view, &segment.nearest_within(view.0.position, part));
            let reaches = |interval: Interval| segment.curve().fragment_of(intervals, interval).any(near);
            chosen = search.nearest(intervals, reaches).unwrap_or(chosen);
        }
        self.kept = Some(chosen.arc_length);
        Sought::Point(chosen)
    }

    /// What it knows of the segment.
    #[inline]
    pub(crate) fn warm(&self) -> &Warm {
        &self.warm
    }

    /// Whether [`Self::seek`] would take the nearest point of the whole segment, at `arc_length`, for the one that it keeps.
    #[inline]
    pub(crate) fn keeps(&self, settings: &SeekSettings, fragments: &Fragments, arc_length: f64) -> bool {
        self.kept.is_some_and(|kept| (arc_length - kept).abs() <= settings.transit_margin)
            && fragments.intervals().iter().any(|(from, to)| *from <= arc_length && arc_length <= *to)
    }

    /// Keeps it.
    #[inline]
    pub(crate) fn keep(&mut self, arc_length: f64) {
        self.kept = Some(arc_length);
        self.warm.thank();
    }

    /// Arc length of the nearest point that the robot keeps, m.
    pub fn kept(&self) -> Option<f64> {
        self.kept
    }
}

struct Search<'a> {
    segment: &'a Placed<'a>,
    robot: Vector2<f64>,
    margin: f64,
    kept: Option<f64>,
    /// The nearest point of the whole curve.
    unrestricted: Foot,
}

impl Search<'_> {
    /// (7.2) on those of the intervals that count; the first of equals.
    fn nearest(&self, intervals: &[Interval], counts: impl Fn(Interval) -> bool) -> Option<Foot> {
        let unrestricted = self.unrestricted;
        let holds = |(from, to): Interval| from <= unrestricted.arc_length && unrestricted.arc_length <= to;
        if intervals.iter().any(|interval| holds(*interval) && counts(*interval)) {
            return Some(unrestricted);
        }
        let mut best: Option<Foot> = None;
        for interval in intervals.iter().copied().filter(|interval| counts(*interval)) {
            let foot = self.segment.nearest_within(self.robot, interval);
            if best.is_none_or(|best| foot.distance < best.distance) {
                best = Some(foot);
            }
        }
        best
    }

    /// The minimum that the robot follows already, unless it is gone or `best` is nearer by more than the margin. A step
    /// along the segment that is shorter than the margin is not worth the question.
    fn keep(&self, intervals: &[Interval], best: Foot) -> Option<Foot> {
        let kept = self.kept?;
        if (best.arc_length - kept).abs() <= self.margin {
            return Some(best);
        }
        let interval = *intervals.iter().find(|(from, to)| from - TIE <= kept && kept <= to + TIE)?;
        let tracked = self.segment.track(self.robot, kept.clamp(interval.0, interval.1));
        let arc_length = tracked.arc_length;
        let holds = |(from, to): Interval| from <= arc_length && arc_length <= to;
        let curve = self.segment.curve();
        let foot = if curve.fragment_of(intervals, interval).any(holds) {
            tracked
        } else {
            let end = self.segment.at(if curve.is_closed() {
                self.end_round(intervals, interval, (kept, arc_length))
            } else {
                arc_length.clamp(interval.0, interval.1)
            });
            Foot { distance: (end.point - self.robot).norm(), ..end }
        };
        (foot.distance <= best.distance + self.margin).then_some(foot)
    }

    /// Of a closed curve the end of the fragment of an interval towards an arc length beyond it, that was come to from `kept` on the interval:
    /// by the shorter way round.
    fn end_round(&self, intervals: &[Interval], interval: Interval, (kept, beyond): (f64, f64)) -> f64 {
        let (curve, (from, to)) = (self.segment.curve(), interval);
        let is_half = from <= 0.0 || to >= curve.length();
        match curve.across(intervals).filter(|_| is_half) {
            Some(across) => {
                let kept = if to >= curve.length() { kept - curve.length() } else { kept };
                curve.next_to(kept, beyond).clamp(across.0, across.1)
            }
            None => curve.next_to(kept, beyond).clamp(from, to),
        }
    }

    /// All other points as near as `best`, on its own fragment or on others. Of an arc that is nearest as a whole the point that is nearest to
    /// the leader stands for all.
    fn tied(&self, intervals: &[Interval], best: Foot, leader: Vector2<f64>) -> impl Iterator<Item = Foot> {
        let ties = move |foot: &Foot| {
            (foot.point - best.point).norm() > TIE && foot.distance <= best.distance + TIE * (1.0 + best.distance)
        };
        let on_others = intervals.iter().map(|interval| self.segment.nearest_within(self.robot, *interval));
        // Where a closed curve begins is no end of a fragment across it: if it is nearest, it is so among all.
        let (joined, end) = (self.segment.curve().joins(intervals), self.segment.curve().length() - TIE);
        let on_others = on_others.filter(move |foot| !joined || TIE < foot.arc_length && foot.arc_length < end);
        // Asked for where they come to it alone: this search is the longer one.
        let all = core::iter::once_with(move || self.segment.nearest_all(self.robot)).flat_map(move |all| {
            let inside = |foot: &Foot| intervals.iter().any(|(a, b)| *a <= foot.arc_length && foot.arc_length <= *b);
            let meet = |range: Interval| intervals.iter().map(move |(a, b)| (range.0.max(*a), range.1.min(*b)));
            let arcs = all.ranges.into_iter().flat_map(meet).filter(|(from, to)| from < to);
            let on_arcs = arcs.map(|arc| {
                let foot = self.segment.nearest_within(leader, arc);
                Foot { distance: (foot.point - self.robot).norm(), ..foot }
            });
            all.feet.into_iter().filter(inside).chain(on_arcs).collect::<Vec<_>>()
        });
        on_others.chain(all).filter(ties)
    }
}
