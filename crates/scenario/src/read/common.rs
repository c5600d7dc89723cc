//! What several kinds of scenarios have.

use crate::scenario::Timing;
use trench_config::ConfigError;
use trench_config::yaml::{Map, Node};
use trench_formation::Vector2;
use trench_formation::kinematics::PointState;
use trench_formation::laws::Capability;
use trench_formation::trench::{
    AnyDamping, AnyTrench, Conic, ConstantDamping, CriticallyDamped, Hyperbolic, HyperbolicDamping, Meaning, Quadratic,
    Saturated, SaturatedDamping, SlopeTable, SquareRoot, TableDamping, Written, WrittenDamping, check_admissibility,
};
use trench_formation::zoning::{Edge, Radii, RadiiError, Sharpness, Zoning};

/// Trenches are judged and written ones defined this far out, m.
const RANGE: f64 = 1000.0;

/// `full_acceleration` where the file says nothing, m/s^2: as good as none.
pub(super) const FULL: f64 = 1e4;

/// A number above 0.
pub(super) fn positive(map: &Map<'_>, key: &str) -> Result<f64, ConfigError> {
    let value = map.f64(key)?;
    if value > 0.0 { Ok(value) } else { Err(map.error(key, "is not positive", "write a number above 0")) }
}

/// A number of 0 or more.
pub(super) fn not_negative(map: &Map<'_>, key: &str, default: f64) -> Result<f64, ConfigError> {
    let value = map.get_or(key, default)?;
    if value >= 0.0 { Ok(value) } else { Err(map.error(key, "is negative", "write 0 or more")) }
}

/// Whether a time of a key (s) is not before the run.
pub(super) fn from_the_start(map: &Map<'_>, key: &str, time: f64) -> Result<(), ConfigError> {
    if time < 0.0 {
        return Err(map.error(key, format!("{time} s is before the run"), "write seconds from 0 on"));
    }
    Ok(())
}

/// A time of a key (s), if it is one of the run: what is to happen at another time would never happen, and nothing would tell.
pub(super) fn within_run(map: &Map<'_>, key: &str, time: f64, timing: &Timing) -> Result<f64, ConfigError> {
    from_the_start(map, key, time)?;
    let Timing { duration, step, .. } = timing;
    if time > duration + 0.5 * step {
        let remedy = format!("write seconds up to its end, {duration}, or make the `duration` longer");
        return Err(map.error(key, format!("{time} s is after the run"), remedy));
    }
    Ok(time)
}

/// Where robots conform where the file says nothing, m.
pub(super) const TOLERANCE: f64 = 0.05;

/// Distance within which a robot conforms, m.
pub(super) fn tolerance(map: &Map<'_>) -> Result<f64, ConfigError> {
    positive_or(map, "tolerance", TOLERANCE)
}

/// Whether robots without bodies begin in places of their own: two that are nearer to each other than `tolerance` are in one, as far as
/// the file tells places apart.
pub(super) fn apart(map: &Map<'_>, nodes: &[Node], robots: &[PointState]) -> Result<(), ConfigError> {
    let tolerance = tolerance(map)?;
    for (index, (robot, node)) in robots.iter().zip(nodes).enumerate() {
        for (other, mate) in robots[..index].iter().enumerate() {
            let distance = (mate.position - robot.position).norm();
            if distance < tolerance {
                let problem = format!(
                    "has r{} begin {distance} m from r{}, nearer than `tolerance`, {tolerance} m: in the same place",
                    index + 1,
                    other + 1
                );
                return Err(node.error(problem, "move one of them, or make the tolerance smaller"));
            }
        }
    }
    Ok(())
}

/// `[x, y]`.
pub(super) fn point(node: &Node) -> Result<Vector2<f64>, ConfigError> {
    node.get::<[f64; 2]>().map(Vector2::from)
}

/// A list of `[x, y]`.
pub(super) fn points(node: &Node) -> Result<Vec<Vector2<f64>>, ConfigError> {
    node.list()?.iter().map(point).collect()
}

/// `[x, y]` of a key, the origin where it is missing.
pub(super) fn point_or_zero(map: &Map<'_>, key: &str) -> Result<Vector2<f64>, ConfigError> {
    map.opt_node(key).map_or(Ok(Vector2::zeros()), point)
}

/// What robots can do (9.2), where the file says so.
pub(super) fn limits(map: &Map<'_>) -> Result<Option<Capability>, ConfigError> {
    let Some(map) = map.opt_map("limits")? else { return Ok(None) };
    let limits = Capability { speed: positive(&map, "speed")?, acceleration: positive(&map, "acceleration")? };
    map.finish()?;
    Ok(Some(limits))
}

/// Radius of bodies with their margin, m, where the law ends in the safety filter, and what robots can do, which it has to know.
pub(super) fn body(map: &Map<'_>, limits: Option<Capability>) -> Result<Option<(f64, Capability)>, ConfigError> {
    match (map.opt_map("safety")?, limits) {
        (None, _) => Ok(None),
        (Some(_), None) => Err(map.error("safety", "needs to know what the robots can do", "give limits, too")),
        (Some(safety), Some(limits)) => {
            let radius = positive(&safety, "body_radius")? + not_negative(&safety, "margin", 0.0)?;
            safety.finish()?;
            Ok(Some((radius, limits)))
        }
    }
}

/// A name that may stand in a topic.
pub(super) fn name(map: &Map<'_>) -> Result<String, ConfigError> {
    let name = map.str("name")?;
    let fits = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
    if name.starts_with(|first: char| first.is_ascii_lowercase()) && name.chars().all(fits) {
        return Ok(name.to_owned());
    }
    Err(map.error("name", "cannot be part of a topic", "begin with a letter; small letters, digits and _ alone"))
}

/// A number above 0, `default` where it is missing.
pub(super) fn positive_or(map: &Map<'_>, key: &str, default: f64) -> Result<f64, ConfigError> {
    if map.opt_node(key).is_some() { positive(map, key) } else { Ok(default) }
}

/// Items of a list that must have some.
pub(super) fn some<'a>(map: &Map<'a>, key: &str) -> Result<&'a [Node], ConfigError> {
    let nodes = map.list(key)?;
    if nodes.is_empty() { Err(map.error(key, "is empty", "give at least one")) } else { Ok(nodes) }
}

/// A damping function k(d) of A.9: from it follows the trench that it damps critically.
pub(super) fn damping(map: &Map<'_>, key: &str) -> Result<AnyDamping, ConfigError> {
    let map = map.map(key)?;
    let kinds = [("constant", 0), ("hyperbolic", 1), ("saturated", 2), ("expression", 3), ("table", 4)];
    let kind = map.one_of("kind", &kinds)?;
    let hyperbolic =
        || Ok::<_, ConfigError>(HyperbolicDamping { alpha: positive(&map, "alpha")?, a: positive(&map, "a")? });
    let damping = match kind {
        0 => AnyDamping::Constant(ConstantDamping { coefficient: positive(&map, "coefficient")? }),
        1 => AnyDamping::Hyperbolic(hyperbolic()?),
        3 => {
            let range = positive_or(&map, "range", RANGE)?;
            let written = WrittenDamping::new(trench_plan::expression(map.node("coefficient")?)?, range);
            let remedy = "write another formula of k in x, like 1 + 2*abs(x)";
            AnyDamping::Written(written.map_err(|error| map.error("coefficient", error.to_string(), remedy))?)
        }
        4 => {
            let rows: Vec<[f64; 2]> = map.get("coefficient")?;
            let table = TableDamping::new(rows.into_iter().map(|[x, k]| (x, k)).collect());
            AnyDamping::Table(table.map_err(|error| map.error("coefficient", error.to_string(), "rows are [x, k]"))?)
        }
        _ => AnyDamping::Saturated(SaturatedDamping(hyperbolic()?)),
    };
    map.finish()?;
    Ok(damping)
}

/// A trench function, admissible.
pub(super) fn trench(map: &Map<'_>, key: &str) -> Result<AnyTrench, ConfigError> {
    let map = map.map(key)?;
    let kinds = [
        ("hyperbolic", 0),
        ("conic", 1),
        ("quadratic", 2),
        ("saturated", 3),
        ("square_root", 4),
        ("table", 5),
        ("expression", 6),
        ("critical", 7),
    ];
    let trench = match map.one_of("kind", &kinds)? {
        0 => AnyTrench::Hyperbolic(Hyperbolic { alpha: positive(&map, "alpha")?, a: positive(&map, "a")? }),
        1 => AnyTrench::Conic(Conic { alpha: positive(&map, "alpha")? }),
        2 => AnyTrench::Quadratic(Quadratic { alpha: positive(&map, "alpha")? }),
        3 => AnyTrench::Saturated(Saturated { stiffness: positive(&map, "stiffness")?, edge: positive(&map, "edge")? }),
        4 => AnyTrench::SquareRoot(SquareRoot),
        5 => {
            let rows: Vec<[f64; 2]> = map.get("slope")?;
            let table = SlopeTable::new(rows.into_iter().map(|[x, slope]| (x, slope)).collect());
            AnyTrench::Table(table.map_err(|error| map.error("slope", error.to_string(), "rows are [x, slope]"))?)
        }
        7 => AnyTrench::Critical(CriticallyDamped(damping(&map, "damping")?)),
        _ => {
            let range = positive_or(&map, "range", RANGE)?;
            let (key, meaning) = match map.opt_node("potential") {
                Some(_) => ("potential", Meaning::Potential),
                None => ("slope", Meaning::Slope),
            };
            let written = Written::new(trench_plan::expression(map.node(key)?)?, meaning, range);
            let remedy = "write another formula, or how far it holds, for example range: 100.0 (m; beyond, the slope stays what it is there)";
            AnyTrench::Written(Box::new(written.map_err(|error| map.error(key, error.to_string(), remedy))?))
        }
    };
    map.finish()?;
    let judged = check_admissibility(&trench, RANGE);
    judged.map_err(|error| {
        let remedy = "choose a trench that is least and flat at 0 and rises from there (Definition 5.2.1), for example {kind: hyperbolic, \
                      alpha: 10.0, a: 1.0}";
        map.as_node().error(error.to_string(), remedy)
    })?;
    Ok(trench)
}

const EDGES: [(&str, Edge); 2] = [("jump", Edge::Jump), ("continuous", Edge::Continuous)];

/// How a barrier begins at its edge; as printed where nothing is said.
pub(super) fn edge(map: &Map<'_>) -> Result<Edge, ConfigError> {
    if map.opt_node("edge").is_some() { map.one_of("edge", &EDGES) } else { Ok(Edge::Jump) }
}

/// The exponent m.
pub(super) fn sharpness(map: &Map<'_>) -> Result<Sharpness, ConfigError> {
    match map.get_or("m", 2_i64)? {
        1 => Ok(Sharpness::One),
        2 => Ok(Sharpness::Two),
        _ => Err(map.error("m", "is no exponent of a zoning potential", "write 1 or 2 (6.4)")),
    }
}

/// Radii and zoning potentials.
pub(super) fn zoning(map: &Map<'_>) -> Result<Zoning, ConfigError> {
    let map = map.map("zoning")?;
    let [a, b, c, d, e] = ["rho_underbar", "rho_hat", "rho", "rho_check", "rho_bar"].map(|key| map.f64(key));
    let radii = Radii::new(a?, b?, c?, d?, e?).map_err(|error| {
        let (key, remedy) = match error {
            RadiiError::NotPositive { name, .. } => (name, "write a radius above 0"),
            RadiiError::Order { outer_name, .. } => {
                (outer_name, "order them: rho_underbar < rho_hat < rho < rho_check <= rho_bar")
            }
        };
        map.error(key, error.to_string(), remedy)
    })?;
    let strength = (positive(&map, "alpha")?, positive(&map, "beta")?);
    let full = positive_or(&map, "full_acceleration", FULL)?;
    let zoning = Zoning::new(radii, strength, sharpness(&map)?, edge(&map)?, full);
    let zoning = zoning.map_err(|error| map.as_node().error(error.to_string(), "write numbers above 0"))?;
    map.finish()?;
    Ok(zoning)
}
