//! Whether followers that begin far from their leaders come to rest beside them, or whip their chain together.
//!
//! Zone 5 draws with the full acceleration of zones all the way to rho_check, and zone 4 with nearly as much beside it. What decides is how
//! near such a robot would come to a leader that rests: simulations bear that out (docs/check.md, "Starts").

use crate::Verdict;
use crate::drawn::{Drawn, Pair};
use crate::verdict::number;
use trench_formation::zoning::Zone;

const EQUATION: &str =
    "drawn to a leader that rests it stays outside of zone 2 (6.2.2; measured: docs/check.md, \"Starts\")";
/// Judges the followers that zones draw from the start: nothing where none begins in zone 5, and none in zone 4 comes to zone 2.
pub(crate) fn starts(subject: &str, drawn: &Drawn<'_>) -> Option<Verdict> {
    let (radii, full) = (drawn.zoning.radii(), drawn.zoning.full_acceleration());
    let told = |pair: &Pair| drawn.zone(pair) == Zone::Margin || !drawn.is_borne(pair, full);
    let all: Vec<Pair> = drawn.pairs().filter(told).collect();
    let approached = all.iter().map(|pair| (pair, drawn.approach(pair, full)));
    let (pair, (nearest, speed)) =
        approached.min_by(|(a, one), (b, other)| one.0.total_cmp(&other.0).then(b.distance.total_cmp(&a.distance)))?;
    let others = match all.len() - 1 {
        0 => String::new(),
        more => format!("; so do {more} more"),
    };
    let (far, full) = (number(pair.distance), number(full));
    let where_it_is = match drawn.zone(pair) {
        Zone::Margin => format!("beyond rho_check = {} m{others}", number(radii.rho_check)),
        _ => format!("close to the pole at rho_check = {} m{others}", number(radii.rho_check)),
    };
    let bounded = drawn.limits.filter(|limits| limits.acceleration < drawn.zoning.full_acceleration());
    let force = match bounded {
        Some(limits) => format!("limits.acceleration = {}", number(limits.acceleration)),
        None => format!("zoning.full_acceleration = {full}"),
    };
    let begins = format!(
        "r{} begins {far} m from its leader r{}, {where_it_is}: it is drawn with up to {force} m/s^2, which makes it {} m/s fast",
        pair.index + 1,
        pair.index,
        number(speed)
    );
    let near = number(nearest);
    if nearest >= radii.rho_hat {
        let finding = format!(
            "{begins}. Before a leader that rests it stops {near} m off, outside of zone 2: no chain that was measured so whipped"
        );
        return Some(Verdict::new("starts", subject, true, finding, EQUATION));
    }
    let mut remedies = Vec::new();
    if let Some(most) = drawn.bearable_distance(pair) {
        remedies.push(format!("begin within {} m", number(most)));
        let more = pair.distance - most;
        if radii.rho_check + more <= radii.rho_bar {
            remedies.push(format!("make rho and rho_check {} m larger", number(more)));
        }
    }
    remedies.extend(drawn.bearable_force(pair).map(|most| format!("make zoning.full_acceleration {}", number(most))));
    remedies.push("damp it more".to_owned());
    let remedy = remedies.join(", or ");
    Some(if nearest > radii.rho_underbar {
        let finding = format!(
            "{begins}. Before a leader that rests it bounces {near} m off, in zone 2; of chains that were measured so some whipped, into zone 1: \
             {remedy}"
        );
        Verdict::noted("starts", subject, finding, EQUATION)
    } else {
        let finding = format!(
            "{begins}. That takes it through zone 2 of a leader that rests; nearly all chains that were measured so whipped, with pairs as good as \
             in one place, or tore: {remedy}"
        );
        Verdict::new("starts", subject, false, finding, EQUATION)
    })
}
