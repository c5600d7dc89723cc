//! The gaps of a field with obstacles: which robots pass, which hulls close, which are too narrow though no hull closes them (7.8).

use crate::Verdict;
use crate::standing::{Place, Standing};
use crate::verdict::number;
use trench_config::{ConfigError, Parameters};
use trench_formation::hull::{Obstacle, Shape, combine};

const EQUATION: &str = "gap < rho_clearance: one hull (7.8); else gap >= 2 (R + margin), and twice the pole to pass it";

/// Gaps that miss what is needed by no more than this (m) do not.
const ROUNDING: f64 = 1e-9;

/// What decides whether robots pass a gap; m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passing {
    /// Hulls nearer to each other are combined.
    pub clearance: f64,
    /// 2 (R + margin).
    pub width: f64,
    /// From an outline to the pole of its potential; 0 for laws without one.
    pub pole: f64,
    /// Low and high x, low and high y of the field.
    pub field: [[f64; 2]; 2],
}

impl Passing {
    /// From the parameters of the obstacle_mapper and of one formation_controller.
    ///
    /// # Errors
    /// When one is missing that they declare.
    pub fn read(mapper: &Parameters, controller: &Parameters) -> Result<Self, ConfigError> {
        let [low_x, low_y, high_x, high_y] = controller.f64_array("field")?;
        let is_pushed = !matches!(controller.str("law")?, "robust" | "nominal" | "direct" | "family");
        Ok(Self {
            clearance: mapper.f64("clearance")?,
            width: 2.0 * (controller.f64("body.radius")? + controller.f64("safety.margin")?),
            pole: if is_pushed { controller.f64("obstacles.pole")? } else { 0.0 },
            field: [[low_x, high_x], [low_y, high_y]],
        })
    }
}

/// What is to be said of a gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Passable,
    Closed,
    /// No hull closes it, and the potentials of both sides are at their full force in all of it.
    Poles,
    /// No hull closes it, and a body does not fit.
    Narrow,
    /// The same before the edge of the field, which has no hull.
    NarrowEdge,
}

/// Judges every gap between neighbours, obstacles and edges of the field, and says of each what it is.
pub fn gaps(subject: &str, standing: &[Standing], passing: &Passing) -> Vec<Verdict> {
    let mut found: Vec<(Kind, String)> = standing.iter().filter_map(mouth).collect();
    let hulls = hulls(standing, passing.clearance);
    for (index, one) in standing.iter().enumerate() {
        for (other_index, other) in standing.iter().enumerate().skip(index + 1) {
            let (least, most) = one.gap_range(other);
            let middle = one.middle_of_gap(other);
            let others = standing.iter().enumerate().filter(|(third, _)| *third != index && *third != other_index);
            if others.map(|(_, third)| third).any(|third| third.is_within(middle, 0.5 * least)) {
                continue;
            }
            let together = hulls.iter().any(|members| members.contains(&index) && members.contains(&other_index));
            let kind = kind((least, most), together, passing);
            found.push((kind, format!("{} and {}, {}", one.name, other.name, range(least, most, passing, kind))));
        }
        for (edge, place) in Place::edges(passing.field) {
            let (least, most) = one.edge_gap(place);
            let middle = one.middle_before(place);
            let others = standing.iter().enumerate().filter(|(third, _)| *third != index);
            if least <= 0.0 || others.map(|(_, third)| third).any(|third| third.is_within(middle, 0.5 * least)) {
                continue;
            }
            let needed = passing.pole.max(0.5 * passing.width) + 0.5 * passing.width;
            let kind = if most >= needed { Kind::Passable } else { Kind::NarrowEdge };
            found.push((kind, format!("{} and the {edge} edge, {}", one.name, range(least, most, passing, kind))));
        }
    }
    said(subject, &found, passing)
}

/// Which obstacles are of one hull, where they begin.
fn hulls(standing: &[Standing], clearance: f64) -> Vec<Vec<usize>> {
    let obstacle = |(id, one): (u32, &Standing)| Obstacle { id, shape: one.shape.clone() };
    let obstacles: Vec<Obstacle> = (0..).zip(standing).map(obstacle).collect();
    let combined = combine(&obstacles, clearance).unwrap_or_default();
    combined.into_iter().map(|hull| hull.members.into_iter().map(|id| id as usize).collect()).collect()
}

fn kind((least, most): (f64, f64), together: bool, passing: &Passing) -> Kind {
    // What of the range no hull closes.
    let open = least.max(passing.clearance);
    if together || most < passing.clearance {
        Kind::Closed
    } else if open < passing.width - ROUNDING {
        Kind::Narrow
    } else if open < 2.0 * passing.pole - ROUNDING {
        Kind::Poles
    } else {
        Kind::Passable
    }
}

fn range(least: f64, most: f64, passing: &Passing, kind: Kind) -> String {
    if most - least < 1e-9 {
        return format!("{} m", number(least));
    }
    let closed = if kind == Kind::Passable && least < passing.clearance {
        format!(", closed while below {} m", number(passing.clearance))
    } else {
        String::new()
    };
    format!("{} to {} m as they move{closed}", number(least), number(most))
}

/// What a concave obstacle's own hull closes.
fn mouth(one: &Standing) -> Option<(Kind, String)> {
    let mouth = one.mouth()?;
    Some((Kind::Closed, format!("the mouth of {}, {} m, by its own hull", one.name, number(mouth))))
}

/// A verdict for each kind that there is.
fn said(subject: &str, found: &[(Kind, String)], passing: &Passing) -> Vec<Verdict> {
    let Passing { clearance, width, pole, .. } = *passing;
    let of = |kind: Kind| {
        let texts: Vec<&str> = found.iter().filter(|(one, _)| *one == kind).map(|(_, text)| text.as_str()).collect();
        (!texts.is_empty()).then(|| texts.join("; "))
    };
    let mut verdicts = Vec::new();
    let mut say = |kind, holds, note, before: String, after: String| {
        if let Some(texts) = of(kind) {
            let finding = format!("{before}: {texts}{after}");
            verdicts.push(Verdict { note, ..Verdict::new("clearance", subject, holds, finding, EQUATION) });
        }
    };
    let wide = format!("for bodies that need {} m", number(width));
    say(Kind::Passable, true, false, format!("passable {wide}"), String::new());
    say(
        Kind::Closed,
        true,
        false,
        format!("closed by hulls, which combine below {} m", number(clearance)),
        String::new(),
    );
    say(
        Kind::Poles,
        true,
        true,
        format!("open and wide enough {wide}, but narrower than both poles, {} m", number(2.0 * pole)),
        format!(
            ": the potentials push at full force from both sides, and arrival behind is not proved; make the mapper's clearance {} m to \
             close such gaps",
            number(2.0 * pole)
        ),
    );
    let mend = format!(
        ": hulls {} m apart are not combined; make the mapper's clearance {} m, or move them",
        number(clearance),
        number(width)
    );
    say(Kind::Narrow, false, false, format!("too narrow {wide}, and no hull closes it"), mend);
    say(
        Kind::NarrowEdge,
        true,
        true,
        format!("too narrow {wide}, before an edge, which has no hull"),
        ": the safety filter keeps robots out".to_owned(),
    );
    verdicts
}

/// Hulls of shapes that may be wrong are nobody's: files have been read before.
pub(crate) fn shape(corners: &[trench_formation::Vector2<f64>], radius: f64) -> Option<Shape> {
    Shape::new(corners, radius).or_else(|_| Shape::enclosing(corners, radius)).ok()
}
