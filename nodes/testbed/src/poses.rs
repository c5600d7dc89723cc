//! Where the robots begin.

use trench_config::{ConfigError, Parameters};
use trench_optics::Pose2;
use trench_sim::{Body, Field, Obstacle, Overlap, Random, Thing, overlaps, scattered};

/// The poses that are written, or random ones.
///
/// # Errors
/// When there are too few or too many, and where bodies would be in each other, in an obstacle, or not in the field.
pub(crate) fn poses(
    parameters: &Parameters,
    field: Field,
    body: Body,
    obstacles: &[Obstacle],
    seed: u64,
) -> Result<Vec<Pose2>, ConfigError> {
    let (names, numbers) = (parameters.str_list("robots")?, parameters.f64_list("poses")?);
    let count = names.len();
    if numbers.is_empty() {
        let gap = parameters.f64("random.gap")?;
        return scattered(count, field, body, gap, obstacles, &mut Random::new(seed, 0)).ok_or_else(|| {
            let problem = format!("no room for {count} robots this far from each other");
            parameters.error("random.gap", problem, "write a smaller gap, or take a larger field")
        });
    }
    if numbers.len() != 3 * count {
        let problem = format!("has {} numbers for {count} robots", numbers.len());
        return Err(parameters.error("poses", problem, "write x, y and heading for each robot"));
    }
    if let Some(wrong) = numbers.iter().position(|number| !number.is_finite()) {
        let problem = format!("{} of {} is no number", ["x", "y", "the heading"][wrong % 3], names[wrong / 3]);
        return Err(parameters.error("poses", problem, "write x, y and heading for each robot"));
    }
    let poses: Vec<Pose2> =
        numbers.chunks_exact(3).map(|pose| Pose2 { x: pose[0], y: pose[1], theta: pose[2] }).collect();
    match overlaps(&poses, obstacles, field, body.radius).first() {
        Some(overlap) => {
            let (problem, remedy) = told(overlap, names, &poses, (field, body.radius), obstacles);
            // All poses beside the two that matter help nobody.
            let error = parameters.error("poses", problem, remedy);
            Err(ConfigError { value: String::new(), ..error })
        }
        None => Ok(poses),
    }
}

/// What is wrong, and what would be right.
fn told(
    overlap: &Overlap,
    names: &[String],
    poses: &[Pose2],
    (field, radius): (Field, f64),
    obstacles: &[Obstacle],
) -> (String, String) {
    let at = |robot: usize| format!("{} at ({:.3}, {:.3})", names[robot], poses[robot].x, poses[robot].y);
    let (one, depth) = (at(overlap.robot), overlap.depth);
    match overlap.thing {
        Thing::Robot(other) => {
            let least = 2.0 * radius;
            let (other, apart) = (at(other), (least - depth).max(0.0));
            let problem = format!("{one} is {apart:.4} m from {other}, and their bodies need {least:.4} m");
            (problem, format!("place them {least:.4} m apart or more"))
        }
        Thing::Obstacle(index) => {
            let id = obstacles.get(index).map_or(0, Obstacle::id);
            let problem = format!("the body of {one} reaches {depth:.4} m into obstacle {id}");
            (problem, format!("place it {radius:.4} m from the obstacle or more"))
        }
        Thing::Edge(_) => {
            let (high_x, high_y) = (field.width - radius, field.height - radius);
            let problem = format!("the body of {one} is {depth:.4} m out of the field");
            let remedy =
                format!("place it at x from {radius:.4} to {high_x:.4} m, y from {radius:.4} to {high_y:.4} m");
            (problem, remedy)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trench_config::{Origin, ParameterValue};
    use trench_sim::camera;

    fn read(numbers: &[f64]) -> Result<Vec<Pose2>, String> {
        let mut parameters = Parameters::default();
        let names = (1..=numbers.len() / 3).map(|robot| format!("robot{robot}")).collect();
        parameters.insert("robots", ParameterValue::StringArray(names), Origin::default());
        parameters.insert("poses", ParameterValue::DoubleArray(numbers.to_vec()), Origin::new("bed.yaml", 7));
        let disc = Obstacle::new(3, camera::Obstacle { corners: vec![[2.0, 1.0]], radius: 0.1 }, [0.0; 2]);
        let field = Field { width: 2.48, height: 1.83 };
        poses(&parameters, field, Body::MRKIT, &[disc], 1).map_err(|error| error.to_string())
    }

    #[test]
    fn bodies_beside_each_other_begin_where_it_is_written() {
        let poses = read(&[0.08, 0.08, 0.0, 0.24, 0.08, 1.0, 2.0, 1.18, 2.0]).unwrap();
        assert_eq!(poses[1], Pose2 { x: 0.24, y: 0.08, theta: 1.0 });
    }

    #[test]
    fn bodies_in_each_other_in_obstacles_or_out_of_the_field_are_refused() {
        let check = |numbers: &[f64], expected: &str| assert_eq!(read(numbers).unwrap_err(), expected);
        check(
            &[0.5, 0.5, 0.0, 1.0, 0.5, 0.0, 0.55, 0.5, 0.0],
            "bed.yaml:7: poses: robot3 at (0.550, 0.500) is 0.0500 m from robot1 at (0.500, 0.500), and their bodies need \
             0.1600 m; place them 0.1600 m apart or more",
        );
        check(
            &[0.5, 0.5, 0.0, 2.0, 1.15, 0.0],
            "bed.yaml:7: poses: the body of robot2 at (2.000, 1.150) reaches 0.0300 m into obstacle 3; place it 0.0800 m \
             from the obstacle or more",
        );
        check(
            &[50.0, 0.5, 0.0],
            "bed.yaml:7: poses: the body of robot1 at (50.000, 0.500) is 47.6000 m out of the field; place it at x from \
             0.0800 to 2.4000 m, y from 0.0800 to 1.7500 m",
        );
        check(
            &[0.5, 0.5, 0.0, 0.9, f64::NAN, 0.0],
            "bed.yaml:7: poses = [0.5, 0.5, 0.0, 0.9, NaN, 0.0]: y of robot2 is no number; write x, y and heading for each robot",
        );
    }
}
