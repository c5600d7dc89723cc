//! What a pursuit (Figure 1.5) has to show, in lock-step and as processes alike.

use super::conformity::Conformed;

/// m: what counts as formed.
pub(crate) const FORMED: f64 = 0.05;

/// s: how soon after a disturbance the formation has to stand, for good.
const PATIENCE: f64 = 15.0;

/// s: when the target sets out (`target.depart`).
const DEPARTURE: f64 = 20.0;

/// rad: how well robots at rest face as their formation does (`face`), which looks where the target went.
const FACING: f64 = 0.25;

/// How many obstacles the field has (config/obstacles/pursuit.yaml).
const OBSTACLES: usize = 7;

/// m: where neither repulsion nor attraction acts between a robot and the one ahead (`zones.radii` in config/profiles/chain.yaml),
/// and what a robot is off by where it stands.
const NEUTRAL: [f64; 2] = [0.26 - FORMED, 0.34 + FORMED];

/// Holds a pursuit against its bounds and gives what it shows in a line. Two things disturb: the start, from anywhere, and the field,
/// as long as an obstacle is within reach of some robot's way to its segment. In the field the segments sweep over obstacles
/// without a pause: how often a single robot was back on its segment in time when nothing was in its own way any more (those of
/// others still detain it) is told, not demanded.
pub(crate) fn judge(conformed: &Conformed, what: &str) -> String {
    let field = conformed.hindrance.until;
    let disturbances = [("start", [0.0, DEPARTURE]), ("field", [field, f64::INFINITY])];
    let formed = disturbances.map(|(name, time)| (name, conformed.formed_after(time, FORMED)));
    let told = |(name, after): &(&str, f64)| format!("{after:.1} s after the {name}");
    let spacings = conformed.spacings();
    let [least, most] = [f64::min, f64::max].map(|pick| spacings.iter().copied().reduce(pick).unwrap());
    let hindered = &conformed.hindrance.by;
    assert_eq!(hindered.len(), OBSTACLES, "{what}: each obstacle was in somebody's way: {hindered:?}");
    for after in &formed {
        assert!(after.1 <= PATIENCE, "{what}: formed {}", told(after));
    }
    let [free, back] = conformed.recoveries(FORMED, PATIENCE);
    assert!(conformed.at_the_end() <= FORMED, "{what}: {} m: lost or trapped", conformed.at_the_end());
    let askew = conformed.askew();
    assert!(askew <= FACING, "{what}: a robot looks {askew} rad past the way of the formation");
    assert_eq!(spacings.len(), 6, "{what}: two queues of four");
    assert!(least >= NEUTRAL[0] && most <= NEUTRAL[1], "{what}: {spacings:?} m apart");
    format!(
        "worst at the end {:.4} m, formed {}; the field hindered until {field:.1} s; {back} of {free} times a robot was back in time after its own last obstacle; {least:.3} to {most:.3} m apart, within {askew:.2} rad of the formation's way: {what}",
        conformed.at_the_end(),
        formed.each_ref().map(told).join(", "),
    )
}
