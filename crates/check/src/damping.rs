//! Whether a chain with zones is damped enough not to whip: measured, and promised no farther than measured (docs/check.md, "Damping").
//!
//! No theorem decides. What does, in simulations of 7.10, is the way that a robot runs on which the trench alone has made fast, against the
//! walls that have to stop it: it has pull/k, and loses it at the rate k + c.

use crate::Verdict;
use crate::verdict::number;
use trench_formation::zoning::{ObstaclePotential, Zoning};

const EQUATION: &str =
    "pull/(k (k + c)) against the width of zones and obstacles, as measured (docs/check.md; ERRATA on 6.5 and 7.10)";

/// What decides; m, m/s, m/s^2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Damped {
    /// k, 1/s.
    pub(crate) damping: f64,
    /// c, 1/s.
    pub(crate) leader_damping: f64,
    /// The largest pull of the trench that robots follow.
    pub(crate) pull: f64,
    /// The speed that they never exceed, infinite where nothing says one.
    pub(crate) speed: f64,
    /// Robots of the chain; none where nobody knows.
    pub(crate) robots: Option<usize>,
    pub(crate) zones: Zoning,
    pub(crate) obstacles: Option<ObstaclePotential>,
}

/// Up to which share of a width the way may be as long, in a chain of so many robots whose walls push back halfway to their poles with this
/// much of the pull, and obstacles with that much.
struct Measured {
    share: f64,
    robots: usize,
    zones: [f64; 2],
    obstacles: [f64; 2],
    /// The largest c/k.
    leader: f64,
}

/// Among zones alone.
const AMONG_ROBOTS: [Measured; 3] = [
    Measured { share: 1.0, robots: 10, zones: [0.003, 30.0], obstacles: [0.0, 0.0], leader: 100.0 },
    Measured { share: 0.5, robots: 10, zones: [0.001, 300.0], obstacles: [0.0, 0.0], leader: 0.0 },
    // What each adds to what came from ahead is passed on: strong walls add more.
    Measured { share: 0.5, robots: 60, zones: [0.003, 0.35], obstacles: [0.0, 0.0], leader: 0.0 },
];
/// With obstacles between; against weaker zones these tear chains apart.
const AMONG_OBSTACLES: [Measured; 1] =
    [Measured { share: 0.4, robots: 10, zones: [0.25, 300.0], obstacles: [0.7, 90.0], leader: 1.8 }];
/// Walls whose largest force is less than this many pulls have not been measured.
const FULL: f64 = 10.0;
/// Beyond so many widths of zones, and of obstacles, chains whipped.
const WHIPS: [f64; 2] = [3.0, 1.1];

impl Damped {
    /// How far a robot runs on, m.
    fn way(&self) -> f64 {
        (self.pull / self.damping).min(self.speed) / (self.damping + self.leader_damping)
    }

    /// The narrower of both zones, and the width of obstacles' potentials, m.
    fn widths(&self) -> (f64, Option<f64>) {
        let radii = self.zones.radii();
        let narrow = (radii.rho_hat - radii.rho_underbar).min(radii.rho_check - radii.rho);
        (narrow, self.obstacles.map(|potential| potential.cut() - potential.pole()))
    }

    /// The longest way that was measured not to whip, m; of chains like no other, with which most did not.
    fn enough_way(&self) -> f64 {
        let all = self.all_measured();
        let share = self.measured().or(all.last()).map_or(0.0, |measured| measured.share);
        let (zones, obstacles) = self.widths();
        share * zones.min(obstacles.unwrap_or(f64::INFINITY))
    }

    /// The k that makes the way as short as that, with c as it is: k (k + c) = pull/way.
    fn enough(&self) -> f64 {
        let half = 0.5 * self.leader_damping;
        libm::sqrt(half * half + self.pull / self.enough_way()) - half
    }

    /// Whether a chain like this one, with walls like these, has been measured.
    fn is_like(&self, measured: &Measured) -> bool {
        let radii = self.zones.radii();
        let within = |force: f64, [least, most]: [f64; 2]| (least * self.pull..=most * self.pull).contains(&force);
        let halfway = |from: f64, to: f64| self.zones.force(0.5 * (from + to)).abs();
        let of_obstacles = self.obstacles.is_none_or(|potential| {
            let force = -potential.force(0.5 * (potential.pole() + potential.cut()));
            within(force, measured.obstacles) && potential.full_acceleration() >= FULL * self.pull
        });
        within(halfway(radii.rho_underbar, radii.rho_hat), measured.zones)
            && within(halfway(radii.rho, radii.rho_check), measured.zones)
            && self.zones.full_acceleration() >= FULL * self.pull
            && self.robots.is_none_or(|robots| robots <= measured.robots)
            && self.leader_damping <= measured.leader * self.damping
            && of_obstacles
    }

    /// What was measured of chains like this one, with the longest way that did not whip.
    fn measured(&self) -> Option<&'static Measured> {
        self.all_measured().iter().find(|measured| self.is_like(measured))
    }

    fn all_measured(&self) -> &'static [Measured] {
        if self.obstacles.is_some() { &AMONG_OBSTACLES } else { &AMONG_ROBOTS }
    }
}

/// Judges the damping of a chain: it holds where chains like it did not whip, fails where they did, and is a note where nobody knows.
pub(crate) fn chain_damping(name: &str, of: &Damped) -> Verdict {
    let (k, c) = (number(of.damping), number(of.leader_damping));
    if of.robots.is_some_and(|robots| robots < 2) {
        let finding = format!("k = {k}: V' = -k |r'|^2, and one robot is no chain that could whip");
        return Verdict::new("damping", name, of.damping > 0.0, finding, "k > 0 (A.18)");
    }
    // Nothing ends a way without damping.
    if !(of.damping > 0.0 && of.damping + of.leader_damping > 0.0) {
        let finding = format!("k = {k}, c = {c}: nothing slows robots down; make k {} or more", number(of.enough()));
        return Verdict::new("damping", name, false, finding, "k > 0 (A.12, A.18)");
    }
    let (zones, obstacles) = of.widths();
    let (zones, obstacles) = (of.way() / zones, obstacles.map(|width| of.way() / width));
    let told = obstacles.map_or(String::new(), |share| format!(" and {} of those of obstacles", number(share)));
    let finding = format!(
        "k = {k}, c = {c}: who is drawn by {} m/s^2 runs on for {} m, {} widths of zones{told}",
        number(of.pull),
        number(of.way()),
        number(zones)
    );
    if zones > WHIPS[0] || obstacles.is_some_and(|share| share > WHIPS[1]) {
        let finding = format!(
            "{finding}: walls act as elastic ones, and of the chains that were measured with as much nearly all whipped, into zone 1 or past rho_check; make k {}, and the way {} m",
            number(of.enough()),
            number(of.enough_way())
        );
        return Verdict::new("damping", name, false, finding, EQUATION);
    }
    let worst = zones.max(obstacles.unwrap_or(0.0));
    match of.measured() {
        Some(measured) if worst <= measured.share => {
            let (share, robots) = (number(measured.share), measured.robots);
            let unknown = if of.robots.is_none() { " (how many there will be is not known here)" } else { "" };
            let finding = format!(
                "{finding}: up to {share} chains of up to {robots} robots{unknown} that were measured did not whip"
            );
            Verdict::new("damping", name, true, finding, EQUATION)
        }
        Some(measured) => {
            let finding = format!(
                "{finding}: chains were measured not to whip up to {}, and to whip far beyond; of what is between nothing is known: run it, or make k {}, and the way {} m",
                number(measured.share),
                number(of.enough()),
                number(of.enough_way())
            );
            Verdict::noted("damping", name, finding, EQUATION)
        }
        None => {
            let finding = format!(
                "{finding}: nothing like it was measured, for its walls push back weaker or stronger against this pull, it has more robots, or more c beside k; whether it whips is not known: run it"
            );
            Verdict::noted("damping", name, finding, EQUATION)
        }
    }
}
