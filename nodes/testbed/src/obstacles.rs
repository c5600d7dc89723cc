//! Files that say what stands in the field.
//!
//! ```yaml
//! obstacles:
//!   - polygon: [[1.0, 0.5]]          # m, corners in order; one is the centre of a disc
//!     radius: 0.1                    # m, of the disc, or by which the polygon is grown; optional
//!     velocity: [0.0, 0.02]          # m/s, for ever; optional
//!   - polygon: [[0.2, 0.2], [0.4, 0.2], [0.3, 0.4]]
//!     path:                          # instead of a velocity; optional
//!       places: [[0.5, 0.0], [0.5, 0.5]]  # m, from where it begins
//!       speed: 0.05                  # m/s
//!       ending: back                 # stay, back or round; optional: stay
//!       wait: 2.0                    # s, until it goes; optional
//! ```

use nalgebra::Vector2;
use trench_config::{ConfigError, yaml, yaml::Map};
use trench_formation::hull::Shape;
use trench_sim::{Ending, Obstacle, Path, camera};

/// No obstacle has more corners: more would slow the world down for nothing.
const MOST_CORNERS: usize = 1000;

/// Reads the text of such a file; `file` names it in errors. Obstacles are numbered from 1 in its order.
///
/// # Errors
/// The first thing that is wrong, with file, line, key and remedy.
pub fn parse(file: &str, text: &str) -> Result<Vec<Obstacle>, ConfigError> {
    let root = yaml::parse(file, text)?;
    root.bounded()?;
    let top = root.map()?;
    let mut obstacles = Vec::new();
    for (id, node) in (1..).zip(top.list("obstacles")?) {
        obstacles.push(obstacle(id, &node.map()?)?);
    }
    top.finish()?;
    Ok(obstacles)
}

fn obstacle(id: u32, map: &Map<'_>) -> Result<Obstacle, ConfigError> {
    let corners: Vec<[f64; 2]> = map.get("polygon")?;
    let radius = map.get_or("radius", 0.0)?;
    let velocity: [f64; 2] = map.get_or("velocity", [0.0; 2])?;
    let path = map.opt_map("path")?.map(|map| path(&map)).transpose()?;
    map.finish()?;
    if corners.is_empty() {
        return Err(map.error("polygon", "has no corner", "write one corner for a disc, three or more for a polygon"));
    }
    if corners.len() > MOST_CORNERS {
        let problem = format!("has {} corners", corners.len());
        return Err(map.error("polygon", problem, format!("write at most {MOST_CORNERS}")));
    }
    if radius.is_nan() || radius < 0.0 || (radius == 0.0 && corners.len() < 3) {
        return Err(map.error("radius", "leaves nothing of the obstacle", "write a positive radius"));
    }
    let points: Vec<Vector2<f64>> = corners.iter().map(|[x, y]| Vector2::new(*x, *y)).collect();
    Shape::new(&points, radius)
        .map_err(|error| map.error("polygon", error.to_string(), "write corners in order around the obstacle"))?;
    if !velocity.iter().all(|speed| speed.is_finite()) {
        return Err(map.error("velocity", "is not finite", "write two speeds in m/s"));
    }
    if path.is_some() && velocity != [0.0; 2] {
        return Err(map.error("velocity", "is there beside a path", "write one of them"));
    }
    let obstacle = Obstacle::new(id, camera::Obstacle { corners, radius }, velocity);
    Ok(match path {
        Some(path) => obstacle.on(path),
        None => obstacle,
    })
}

fn path(map: &Map<'_>) -> Result<Path, ConfigError> {
    let places: Vec<[f64; 2]> = map.get("places")?;
    let (speed, wait) = (map.f64("speed")?, map.get_or("wait", 0.0)?);
    let words = [("stay", Ending::Stay), ("back", Ending::Back), ("round", Ending::Round)];
    let ending = if map.opt_node("ending").is_some() { map.one_of("ending", &words)? } else { Ending::Stay };
    map.finish()?;
    if places.is_empty() || !places.iter().flatten().all(|number| number.is_finite()) {
        return Err(map.error("places", "are no way", "write one place or more, x and y in m each"));
    }
    if !(speed.is_finite() && speed > 0.0) {
        return Err(map.error("speed", "is no speed", "write more than 0 m/s"));
    }
    if wait.is_nan() || wait < 0.0 {
        return Err(map.error("wait", "is no time", "write 0 s or more"));
    }
    Ok(Path::new(&places, speed, ending, wait))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn discs_and_polygons() {
        let text = "obstacles:\n  - {polygon: [[1.0, 0.5]], radius: 0.1, velocity: [0.0, 0.02]}\n  \
                    - polygon: [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]\n";
        let obstacles = parse("field.yaml", text).unwrap();
        assert_eq!((obstacles.len(), obstacles[0].outline().radius, obstacles[0].velocity()), (2, 0.1, [0.0, 0.02]));
        assert_eq!((obstacles[1].id(), obstacles[1].outline().corners.len()), (2, 3));
    }

    #[test]
    fn paths() {
        let text =
            "obstacles:\n  - polygon: [[1.0, 0.5]]\n    radius: 0.1\n    path: {places: [[1.0, 0.0]], speed: 0.5}\n";
        let mut obstacles = parse("field.yaml", text).unwrap();
        obstacles[0].advance(1.0);
        assert_eq!((&obstacles[0].outline().corners[..], obstacles[0].velocity()), (&[[1.5, 0.5]][..], [0.5, 0.0]));
    }

    #[test]
    fn errors_name_line_and_key() {
        let check = |entry: &str, expected: &str| {
            let error = parse("field.yaml", &format!("obstacles:\n  - {entry}\n")).unwrap_err().to_string();
            assert!(error.contains("field.yaml:2") && error.contains(expected), "{error}");
        };
        check("{polygon: []}", "has no corner");
        check("{polygon: [[1.0, 0.5]]}", "radius");
        check("{polygon: [[1.0, 0.5]], radius: -0.1}", "leaves nothing");
        check("{polygon: [[1.0, 0.5]], radius: 0.1, speed: 3}", "speed");
        check("{polygon: [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]}", "polygon");
        check("{polygon: [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]}", "polygon");
        check("{polygon: [[0.0, .nan]], radius: 0.1}", "polygon");
        check("{polygon: [[0.0, 1.0e+308]], radius: 0.1}", "obstacles[0].polygon[0][1] = 1.0e+308: is beyond");
        check(
            "{polygon: [[0.0, 0.0]], radius: 0.1, velocity: [1.0e+308, 0.0]}",
            "obstacles[0].velocity[0] = 1.0e+308: is beyond",
        );
        check("{polygon: [[0.0, 0.0]], radius: .nan}", "radius");
        check("{polygon: [[0.0, 0.0]], radius: 0.1, path: {places: [], speed: 1.0}}", "path.places");
        check("{polygon: [[0.0, 0.0]], radius: 0.1, path: {places: [[1.0, 1.0]], speed: 0.0}}", "path.speed");
        check("{polygon: [[0.0, 0.0]], radius: 0.1, path: {places: [[1.0, 1.0]], speed: 1.0, ending: up}}", "ending");
        check(
            "{polygon: [[0.0, 0.0]], radius: 0.1, velocity: [1.0, 0.0], path: {places: [[1.0, 1.0]], speed: 1.0}}",
            "beside a path",
        );
    }
}
