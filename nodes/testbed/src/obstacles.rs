//! Files that say what stands in the field.
//!
//! ```yaml
//! obstacles:
//!   - polygon: [[1.0, 0.5]]          # m, corners in order; one is the centre of a disc
//!     radius: 0.1                    # m, of the disc, or by which the polygon is grown; optional
//!     velocity: [0.0, 0.02]          # m/s; optional
//! ```

use trench_config::yaml;
use trench_config::{ConfigError, yaml::Map};
use trench_sim::{Obstacle, camera};

/// Reads the text of such a file; `file` names it in errors. Obstacles are numbered from 1 in its order.
pub(crate) fn parse(file: &str, text: &str) -> Result<Vec<Obstacle>, ConfigError> {
    let root = yaml::parse(file, text)?;
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
    let velocity = map.get_or("velocity", [0.0; 2])?;
    map.finish()?;
    if corners.is_empty() {
        return Err(map.error("polygon", "has no corner", "write one corner for a disc, three or more for a polygon"));
    }
    if radius < 0.0 || (radius == 0.0 && corners.len() < 3) {
        return Err(map.error("radius", "leaves nothing of the obstacle", "write a positive radius"));
    }
    Ok(Obstacle { id, outline: camera::Obstacle { corners, radius }, velocity })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn discs_and_polygons() {
        let text = "obstacles:\n  - {polygon: [[1.0, 0.5]], radius: 0.1, velocity: [0.0, 0.02]}\n  \
                    - polygon: [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]\n";
        let obstacles = parse("field.yaml", text).unwrap();
        assert_eq!((obstacles.len(), obstacles[0].outline.radius, obstacles[0].velocity), (2, 0.1, [0.0, 0.02]));
        assert_eq!((obstacles[1].id, obstacles[1].outline.corners.len()), (2, 3));
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
    }
}
