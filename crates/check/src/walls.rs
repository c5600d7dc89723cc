//! Whether walls (repulsive and attractive zones, obstacles) hold robots that the trench draws into them.

use crate::Verdict;
use crate::verdict::number;
use trench_formation::zoning::{ObstaclePotential, Zoning};

const EQUATION: &str = "full acceleration > Phi'/sin alpha, and v^2/2 + w Phi'/sin alpha <= Psi at the pole (9.2, chapter 7 of docs/theory)";

/// A wall in front of a pole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wall {
    /// What it is, for people.
    pub(crate) name: &'static str,
    /// The key that says how strong it is.
    pub(crate) key: &'static str,
    /// The force at and beyond the pole, which is the largest, m/s^2.
    pub(crate) force: f64,
    /// What it takes from v^2/2 on the way from its edge to its pole, m^2/s^2.
    pub(crate) depth: f64,
    /// From its edge to its pole, m.
    pub(crate) width: f64,
    /// How fast it may come at a robot by itself, m/s.
    pub(crate) speed: f64,
}

impl Wall {
    /// Zone 2, about robots that rest.
    pub(crate) fn zones(zoning: &Zoning, key: &'static str) -> Self {
        let radii = zoning.radii();
        Self {
            name: "zones",
            key,
            force: zoning.full_acceleration(),
            depth: zoning.repulsive_value(radii.rho_underbar),
            width: radii.rho_hat - radii.rho_underbar,
            speed: 0.0,
        }
    }

    /// About obstacles of which the fastest moves at `speed` (m/s).
    pub(crate) fn obstacles(potential: &ObstaclePotential, key: &'static str, speed: f64) -> Self {
        Self {
            name: "obstacles",
            key,
            force: potential.full_acceleration(),
            depth: potential.value(potential.pole()),
            width: potential.cut() - potential.pole(),
            speed,
        }
    }
}

/// What comes at walls.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Coming {
    /// The largest pull of the trench, m/s^2; along a direction at an angle alpha to the segment Phi'/sin alpha.
    pub(crate) pull: f64,
    /// m/s: what the trench alone makes of a robot, which is pull over damping, up to the limit of speed; or what it begins with, if that is
    /// more: limits brake, but do not undo.
    pub(crate) speed: f64,
    /// Which of them, for people.
    pub(crate) because: String,
}

/// Judges walls. One whose largest force the trench outdoes fails: whoever is drawn into it goes through. One that a robot may pass by its speed
/// makes a note: damping, which is not counted, and the safety filter may stop it.
pub(crate) fn walls(subject: &str, coming: &Coming, walls: &[Wall]) -> Option<Verdict> {
    if walls.is_empty() {
        return None;
    }
    let pull = coming.pull;
    let weak: Vec<&Wall> = walls.iter().filter(|wall| wall.force <= pull).collect();
    if !weak.is_empty() {
        let told: Vec<String> =
            weak.iter().map(|wall| format!("{} push back with {}", wall.name, number(wall.force))).collect();
        let keys: Vec<&str> = weak.iter().map(|wall| wall.key).collect();
        let finding = format!(
            "the trench pulls with up to {} m/s^2, {}: robots are drawn through them; make {} more than {}, or the trench less steep",
            number(pull),
            told.join(", "),
            keys.join(" and "),
            number(pull)
        );
        return Some(Verdict::new("walls", subject, false, finding, EQUATION));
    }
    let told: Vec<String> = walls.iter().map(|wall| format!("{} {}", wall.name, number(wall.force))).collect();
    let stronger =
        format!("{} m/s^2 at most, the trench less: robots that stand before them are held", told.join(", "));
    let thin: Vec<String> = walls.iter().filter_map(|wall| passed(wall, coming)).collect();
    Some(if thin.is_empty() {
        let (speed, because) = (number(coming.speed), &coming.because);
        let finding = format!(
            "{stronger}, and so is who comes at {speed} m/s ({because}) and is not pushed or pulled by other robots besides"
        );
        Verdict::new("walls", subject, true, finding, EQUATION)
    } else {
        let finding = format!(
            "{stronger}. {}. What damping, which is not counted, makes of that is measured, not proved",
            thin.join(". ")
        );
        Verdict::noted("walls", subject, finding, EQUATION)
    })
}

/// What is to be said of a wall that a robot may pass by its speed.
fn passed(wall: &Wall, coming: &Coming) -> Option<String> {
    let speed = coming.speed + wall.speed;
    let (brought, drawn) = (0.5 * speed * speed, wall.width * coming.pull);
    (brought + drawn > wall.depth).then(|| {
        format!(
            "Who comes at {} at {} m/s ({}{}) has {} m^2/s^2, the trench adds up to {} on {} m, and they take {}",
            wall.name,
            number(speed),
            coming.because,
            if wall.speed > 0.0 { "; the obstacle's own speed included" } else { "" },
            number(brought),
            number(drawn),
            number(wall.width),
            number(wall.depth)
        )
    })
}
