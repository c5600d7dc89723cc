//! Where the robots of a random team begin.
use super::chance::Chance;
use super::obstacles::{Boundary, Field};
use super::{CAPABILITY, CUT};
use crate::Vector2;
use crate::chain::{Robot, organise};
use crate::curve::Placed;
use crate::zoning::Radii;

/// Draws of all starts before a team is left as it is: disconnected.
const DRAWS: u32 = 50;
/// Part of the teams that are left as they are drawn first.
const LEFT: f64 = 0.05;

/// Starts by rank. Nothing where no place is found for the robots.
pub(super) fn random_starts(
    chance: &mut Chance,
    count: usize,
    field: &Field,
    (segment, goal, radii): (&Placed<'_>, Vector2<f64>, &Radii),
) -> Option<Vec<Vector2<f64>>> {
    let names: Vec<String> = (0..count).map(|index| format!("{index:02}")).collect();
    let draws = if chance.fraction() < LEFT { 1 } else { DRAWS };
    let mut drawn = None;
    for _ in 0..draws {
        let Some(places) = random_places(chance, count, field) else { continue };
        let robots: Vec<Robot<'_>> =
            names.iter().zip(&places).map(|(name, position)| Robot { name, position: *position }).collect();
        let chain = organise(&robots, goal, segment).ok()?;
        let place = |name: &String| names.iter().position(|other| other == name).map(|index| places[index]);
        let ranked: Vec<Vector2<f64>> = chain.names().iter().filter_map(place).collect();
        let connected = ranked.windows(2).all(|pair| radii.is_coordinated((pair[0] - pair[1]).norm()));
        drawn = Some(ranked);
        if connected {
            break;
        }
    }
    drawn
}

/// Places a metre apart and clear of all obstacles, in no order; one of them in the mouth of a concave obstacle, where there is one wide
/// enough.
fn random_places(chance: &mut Chance, count: usize, field: &Field) -> Option<Vec<Vector2<f64>>> {
    let half = 3.0 + 0.35 * count as f64;
    let stopping = CAPABILITY.speed * CAPABILITY.speed / (2.0 * CAPABILITY.acceleration);
    let mut places: Vec<Vector2<f64>> = Vec::with_capacity(count);
    let mut middle = chance.point(5.0);
    if let Some(mouth) = field.mouth(chance, CUT + stopping) {
        places.push(mouth);
        middle = mouth + chance.point(2.0);
    }
    for _ in 0..1000 {
        let point = middle + chance.point(half);
        let clear = field.gap(point, Boundary::Real, false, 2.0) > CUT + stopping;
        if clear && places.iter().all(|other| (other - point).norm() > 1.0) {
            places.push(point);
        }
        if places.len() == count {
            return Some(places);
        }
    }
    None
}
