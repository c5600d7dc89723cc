//! Why a leader is not in its follower's neutral zone at the end of a run.

use crate::summary::OutsideSummary;
use crate::{Sample, Seat};
use trench_formation::zoning::{Zone, Zoning};

/// A follower that is slower than this stands, m/s.
const STANDS: f64 = 0.01;

/// What is to be said of a follower, if its leader is not in its neutral zone; `tolerance` (m) is that within which robots conform.
pub(crate) fn outside(
    (seat, follower): (&Seat, &Sample),
    (leader_seat, leader): (&Seat, &Sample),
    zoning: &Zoning,
    tolerance: f64,
) -> Option<OutsideSummary> {
    let (distance, radii) = ((leader.position - follower.position).norm(), zoning.radii());
    let (zone, edge) = match radii.zone(distance) {
        Zone::Neutral => return None,
        Zone::Forbidden => (1, radii.rho_underbar),
        Zone::Repulsive => (2, radii.rho_hat),
        Zone::Attractive => (4, radii.rho),
        Zone::Margin => (5, radii.rho_check),
        Zone::Beyond => (6, radii.rho_bar),
    };
    let relative = (follower.velocity - leader.velocity).norm();
    let near = (distance - edge).abs() <= tolerance;
    let conforms = follower.deviation <= tolerance;
    let why = if zone == 6 {
        "the link is lost: it hears no leader".to_owned()
    } else if !follower.deviation.is_finite() {
        "no qualified fragment is left that would draw it".to_owned()
    } else if relative > STANDS {
        format!("it still moves at {relative:.3} m/s against its leader")
    } else if matches!(zone, 2 | 4) && near {
        "it came to the edge of the neutral zone from outside, where nothing draws it farther".to_owned()
    } else if conforms {
        "it stands on its segment: what pushes it out of the zone is held by other forces or by the end of its fragment (Remark 6.4.1)".to_owned()
    } else {
        "it stands off its segment: forces cancel there, a local minimum (Remark 6.4.1)".to_owned()
    };
    Some(OutsideSummary { robot: seat.name.clone(), leader: leader_seat.name.clone(), zone, distance, why })
}
