//! Choosing places from the start: which fragments a robot may choose where those ahead tell what they have chosen.

use super::encroach::is_near;
use super::{Agent, Surroundings};
use crate::Vector2;
use crate::curve::{Interval, encroached};
use crate::hull::Outline;
use crate::seek::Fragments;
use crate::trench::Trench;

impl<T: Trench> Agent<T> {
    /// The places that robots ahead have chosen, each as it was until it has moved: the hulls of the others stay the same to the last bit.
    pub(super) fn places_held(&self, around: &Surroundings<'_>) -> Vec<Vector2<f64>> {
        let known = self.encroachers.as_ref().map_or(&[][..], |known| &known.robots);
        let held = |(index, now): (usize, &Vector2<f64>)| {
            known.get(index).copied().filter(|then| is_near(*then, *now)).unwrap_or(*now)
        };
        around.places.iter().enumerate().map(held).collect()
    }

    /// Where the leader is going to stand, if it tells.
    pub(super) fn leaders_place(&self, around: &Surroundings<'_>) -> Option<Vector2<f64>> {
        let tells = self.settings.encroaching.tells_places();
        around.leader.and(around.places.last().copied()).filter(|_| tells)
    }

    /// What of the fragments is in the leader's neutral zone once it stands at its place, and leaves room within reach for the robots
    /// behind; where there is nowhere such room, where there is most. All fragments where none is in the zone. A robot that has come to
    /// its place leaves it to nobody behind: obstacles that pass take room for a while only.
    pub(super) fn within_reach(&self, around: &Surroundings<'_>, fragments: Fragments) -> Fragments {
        let Some(place) = self.leaders_place(around) else { return fragments };
        let disc = [place];
        let outline = Outline { points: &disc, radius: 0.0 };
        let (segment, whole) = (around.moment(0.0).segment, around.curve.domain());
        let (radii, room) = (self.settings.zoning.radii(), self.settings.seeking.room);
        let near = encroached(&segment, whole, &[outline], radii.rho);
        let Some(within) = fragments.meeting(around.curve, &near, room) else { return fragments };
        if self.arrived {
            return within;
        }
        let groups = fragments.groups(around.curve, radii.rho - 2.0 * radii.rho_hat, radii.rho_hat).into_iter();
        let reached: Vec<(Interval, usize)> =
            // What lies in it is long enough already: a span may have half of a fragment.
            groups.filter(|(span, _)| within.meeting(around.curve, &[*span], 0.0).is_some()).collect();
        let most = reached.iter().map(|(_, places)| *places).max().unwrap_or(0);
        let enough = most.min(around.behind + 1);
        let spans: Vec<Interval> =
            reached.into_iter().filter(|(_, places)| *places >= enough).map(|(span, _)| span).collect();
        within.meeting(around.curve, &spans, room).unwrap_or(within)
    }
}
