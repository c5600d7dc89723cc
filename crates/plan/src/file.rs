//! Formation files.

use crate::expression::expression;
use crate::plan::{Frame, Motion, Place, Plan, QueuePlan};
use crate::{ChainPlaces, LEAST_TOLERANCE, MOST_ROBOTS, NO_VERTEX, ON_SEGMENT, ONE_VERTEX, SHARES};
use trench_config::ConfigError;
use trench_config::yaml::{self, Map, Node};
use trench_formation::Vector2;
use trench_formation::curve::{Curve, CurveError, CurveShape};

/// Reads a formation file; `file` names it in errors.
///
/// # Errors
/// The first thing that is wrong, with file, line, key, value and remedy.
pub fn parse(file: &str, text: &str) -> Result<Plan, ConfigError> {
    let root = yaml::parse(file, text)?;
    root.bounded()?;
    let map = root.map()?;
    let plan = Plan {
        name: map.str("name")?.to_owned(),
        frame: frame(&map)?,
        motion: motion(&map)?,
        queues: queues(map.node("queues")?)?,
    };
    map.finish()?;
    Ok(plan)
}

fn frame(map: &Map<'_>) -> Result<Frame, ConfigError> {
    match map.opt_node("frame") {
        None => Ok(Frame::Map),
        Some(node) => match node.str()? {
            "map" => Ok(Frame::Map),
            "target" => Ok(Frame::Target),
            _ => Err(node.error("is no frame", "write map (fixed on the field) or target (moves with the target)")),
        },
    }
}

fn motion(map: &Map<'_>) -> Result<Motion, ConfigError> {
    let Some(node) = map.opt_node("motion") else { return Ok(Motion { approach: 0.0, speed: 0.0 }) };
    let map = node.map()?;
    let motion = Motion { approach: not_negative(&map, "approach")?, speed: not_negative(&map, "speed")? };
    map.finish()?;
    Ok(motion)
}

fn queues(node: &Node) -> Result<Vec<QueuePlan>, ConfigError> {
    let mut queues: Vec<QueuePlan> = node.list()?.iter().map(queue).collect::<Result<_, _>>()?;
    if queues.is_empty() {
        return Err(node.error("a formation without segments", "give at least one queue"));
    }
    for (index, item) in node.list()?.iter().enumerate() {
        let name = &queues[index].name;
        if queues[..index].iter().any(|earlier| earlier.name == *name) {
            return Err(item.map()?.error(
                "name",
                "is the name of an earlier queue too",
                "give each queue its own name",
            ));
        }
    }
    let total: f64 = queues.iter().map(|queue| queue.share).sum();
    if (total - 1.0).abs() > SHARES {
        return Err(node.error(format!("the shares add up to {total}"), "make them add up to 1"));
    }
    queues.iter_mut().for_each(|queue| queue.share /= total);
    Ok(queues)
}

fn queue(node: &Node) -> Result<QueuePlan, ConfigError> {
    let map = node.map()?;
    let (shape, curve) = segment(map.node("segment")?)?;
    let vertices = map.node("vertices")?;
    let ends = on_curve(&curve, vertices)?;
    if ends.is_empty() {
        return Err(vertices.error(NO_VERTEX, "give one or two points of the segment"));
    }
    let chain = map.opt_node("chain").map(|node| Ok((node, chain(&node.map()?)?))).transpose()?;
    if chain.is_some() && ends.len() > 1 {
        let remedy = "leave out the others, or leave out chain to have a place at each";
        return Err(vertices.error(format!("{} vertices, but {ONE_VERTEX}", ends.len()), remedy));
    }
    let starts = map.opt_node("starts").map(|node| Ok((node, on_curve(&curve, node)?))).transpose()?;
    let places = match starts {
        None if chain.is_some() => chain_places(&curve, ends[0], chain)?,
        Some((node, _)) if chain.is_some() => {
            return Err(node.error("a chain has no starts", "leave out starts, or chain"));
        }
        None => ends.iter().map(|&end| Place { start: end, end }).collect(),
        Some((node, starts)) if starts.len() != ends.len() => {
            let problem = format!("{} starts for {} vertices", starts.len(), ends.len());
            return Err(node.error(problem, "give one start for each vertex, in the same order"));
        }
        Some((_, starts)) => starts.iter().zip(&ends).map(|(&start, &end)| Place { start, end }).collect(),
    };
    let plan = QueuePlan {
        name: map.str("name")?.to_owned(),
        shape,
        curve,
        vertices: points(vertices)?,
        share: share(&map)?,
        tolerance: tolerance(&map)?,
        chain: chain.map(|(_, chain)| chain),
        places,
    };
    map.finish()?;
    Ok(plan)
}

fn chain(map: &Map<'_>) -> Result<ChainPlaces, ConfigError> {
    let (robots, spacing) = (map.get::<i64>("robots")?, map.f64("spacing")?);
    let robots = u32::try_from(robots).ok().filter(|robots| (1..=MOST_ROBOTS).contains(robots));
    let remedy = format!("write 1 to {MOST_ROBOTS}");
    let robots = robots.ok_or_else(|| map.error("robots", "is no number of robots", remedy))?;
    if spacing <= 0.0 {
        return Err(map.error("spacing", "leaves no room between robots", "write metres of segment, more than 0"));
    }
    map.finish()?;
    Ok(ChainPlaces { robots, spacing })
}

fn chain_places(curve: &Curve, vertex: f64, chain: Option<(&Node, ChainPlaces)>) -> Result<Vec<Place>, ConfigError> {
    let Some((node, chain)) = chain else { return Ok(Vec::new()) };
    chain.along(curve, vertex).map_err(|room| node.error(room.to_string(), room.remedy()))
}

fn tolerance(map: &Map<'_>) -> Result<f64, ConfigError> {
    let tolerance = map.f64("tolerance")?;
    if tolerance >= LEAST_TOLERANCE {
        return Ok(tolerance);
    }
    let remedy = format!("write {LEAST_TOLERANCE} m or more; 0.02 suits the test bed");
    Err(map.node("tolerance")?.error("is nearer to its segment than any robot can know that it is", remedy))
}

fn share(map: &Map<'_>) -> Result<f64, ConfigError> {
    let share = map.f64("share")?;
    if (0.0..=1.0).contains(&share) {
        return Ok(share);
    }
    Err(map.node("share")?.error("is no fraction", "write a number from 0 to 1"))
}

/// Reads a segment's description and curve: a map with the kind, its numbers, and open ends.
///
/// # Errors
/// The first thing that is wrong, with file, line, key, value and remedy.
pub fn segment(node: &Node) -> Result<(CurveShape, Curve), ConfigError> {
    let map = node.map()?;
    let shape = match map.str("kind")? {
        "line" => match points(map.node("points")?)?.as_slice() {
            &[from, to] => CurveShape::Line(from, to),
            other => {
                let problem = format!("a line with {} points", other.len());
                return Err(map.node("points")?.error(problem, "give two, or kind: polyline"));
            }
        },
        "polyline" => CurveShape::Polyline(points(map.node("points")?)?),
        "spline" => CurveShape::Spline(points(map.node("points")?)?),
        "bezier" => CurveShape::Bezier(points(map.node("points")?)?),
        "arc" => CurveShape::Arc {
            centre: point(map.node("centre")?)?,
            radius: map.f64("radius")?,
            start_angle: match angle(&map, "start_angle")? {
                Some(angle) => angle,
                None => map.f64("start_angle")?,
            },
            sweep: map.f64("sweep")?,
        },
        // The whole turn, to the last digit, which nobody writes.
        "circle" => CurveShape::Arc {
            centre: point(map.node("centre")?)?,
            radius: map.f64("radius")?,
            start_angle: angle(&map, "start_angle")?.unwrap_or(0.0),
            sweep: core::f64::consts::TAU,
        },
        "ellipse" => CurveShape::Ellipse {
            centre: point(map.node("centre")?)?,
            semi_axes: map.get("semi_axes")?,
            rotation: angle(&map, "rotation")?.unwrap_or(0.0),
        },
        "sinusoid" => CurveShape::Sinusoid {
            origin: point(map.node("origin")?)?,
            direction: angle(&map, "direction")?.unwrap_or(0.0),
            length: map.f64("length")?,
            amplitude: map.f64("amplitude")?,
            wavelength: map.f64("wavelength")?,
            phase: map.opt_f64("phase")?.unwrap_or(0.0),
        },
        "graph" => {
            let function = expression(map.node("expression")?)?;
            CurveShape::Graph { function, from: map.f64("from")?, to: map.f64("to")? }
        }
        _ => {
            let remedy = "write line, polyline, spline, bezier, arc, circle, ellipse, sinusoid or graph";
            return Err(map.node("kind")?.error("is no kind of segment", remedy));
        }
    };
    let open = |key| Ok::<_, ConfigError>(map.opt::<bool>(key)?.unwrap_or(false));
    let (open_start, open_end) = (open("open_start")?, open("open_end")?);
    map.finish()?;
    let curve = Curve::new(&shape, open_start, open_end).map_err(|error| refused(&map, &error))?;
    Ok((shape, curve))
}

/// The error about a segment, at the expression if that is to blame.
fn refused(map: &Map<'_>, error: &CurveError) -> ConfigError {
    match error {
        CurveError::NotSmooth { problem, x, cause, column, remedy, .. } => {
            map.error("expression", format!("{problem} at x = {x} (`{cause}` at column {column})"), *remedy)
        }
        CurveError::Range { .. } => map.error("to", error.to_string(), "write a greater one"),
        CurveError::Sweep(_) => map.error("sweep", error.to_string(), "write kind: circle for a whole turn"),
        CurveError::NotPositive { what, .. } => {
            map.error(key_of(what), error.to_string(), "write a number of metres above 0")
        }
        CurveError::PointCount { .. } => map.error("points", error.to_string(), "add points, or take some away"),
        CurveError::RepeatedPoint(..) => map.error("points", error.to_string(), "remove one of them"),
        _ => map.as_node().error(error.to_string(), "mend the segment"),
    }
}

/// The key that stands for a length of a curve.
fn key_of(what: &str) -> &'static str {
    match what {
        "the radius" => "radius",
        "the length" => "length",
        "the wavelength" => "wavelength",
        _ => "semi_axes",
    }
}

/// An angle of a key, rad, if it is there: more than a turn is one in degrees.
///
/// # Errors
/// When it is there and no angle.
pub fn angle(map: &Map<'_>, key: &str) -> Result<Option<f64>, ConfigError> {
    let angle = map.opt_f64(key)?;
    match angle.filter(|angle| angle.abs() > core::f64::consts::TAU) {
        None => Ok(angle),
        Some(beyond) => {
            let remedy = format!("write radians: {beyond} degrees are {:.6}", beyond.to_radians());
            Err(map.error(key, "is more than a turn", remedy))
        }
    }
}

/// Arc lengths of the points of a list, all of which must lie on the curve.
fn on_curve(curve: &Curve, node: &Node) -> Result<Vec<f64>, ConfigError> {
    let arc_length = |node: &Node| {
        let foot = curve.nearest(point(node)?);
        if foot.distance > ON_SEGMENT {
            let problem = format!("is {:.4} m away from the segment", foot.distance);
            let remedy = format!("the nearest point of the segment is [{:.4}, {:.4}]", foot.point.x, foot.point.y);
            return Err(node.error(problem, remedy));
        }
        Ok(foot.arc_length)
    };
    node.list()?.iter().map(arc_length).collect()
}

fn points(node: &Node) -> Result<Vec<Vector2<f64>>, ConfigError> {
    node.list()?.iter().map(point).collect()
}

fn point(node: &Node) -> Result<Vector2<f64>, ConfigError> {
    let [x, y]: [f64; 2] = node.get()?;
    Ok(Vector2::new(x, y))
}

fn not_negative(map: &Map<'_>, key: &str) -> Result<f64, ConfigError> {
    let value = map.f64(key)?;
    if value >= 0.0 { Ok(value) } else { Err(map.node(key)?.error("is negative", "write 0 or more")) }
}
