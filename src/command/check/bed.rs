//! What a launch file says of the test bed: what stands in its field, and where robots begin.

use super::gather::{CheckError, readable};
use trench_check::{Passing, Standing, Start};
use trench_config::Parameters;
use trench_core::Files;
use trench_formation::Vector2;
use trench_harness::{ChainOrder, Disk, Seating, organise, parse_obstacles};
use trench_plan::{Frame, Plan};

/// A file of obstacles, what stands in it, and what decides whether robots pass.
pub(super) type Field = (String, Vec<Standing>, Passing);

/// The obstacles of the test bed; nothing where it has none.
pub(super) fn field(
    bed: &Parameters,
    mapper: &Parameters,
    controller: &Parameters,
) -> Result<Option<Field>, CheckError> {
    let path = bed.str("obstacles_file")?;
    if path.is_empty() {
        return Ok(None);
    }
    let passing = Passing::read(mapper, controller)?;
    let [[low_x, high_x], [low_y, high_y]] = passing.field;
    // Whoever goes on for ever has left the field then.
    let out = (high_x - low_x).hypot(high_y - low_y);
    let standing = parse_obstacles(path, &Disk.read("obstacles_file", path)?)?.into_iter().filter_map(|obstacle| {
        let corners: Vec<Vector2<f64>> = obstacle.outline().corners.iter().copied().map(Vector2::from).collect();
        let velocity = Vector2::from(obstacle.velocity());
        let places: Vec<Vector2<f64>> = match obstacle.path() {
            Some(path) => path.places().into_iter().map(Vector2::from).collect(),
            None => velocity.try_normalize(0.0).map(|direction| out * direction).into_iter().collect(),
        };
        Standing::new(obstacle.id(), &corners, obstacle.outline().radius, &places)
    });
    Ok(Some((readable(path), standing.collect(), passing)))
}

/// The robots of the test bed as the assignment will seat them; none where their poses are left to chance, or the formation is not in the
/// map.
pub(super) fn starts(
    bed: &Parameters,
    assignment: &Parameters,
    controller: &Parameters,
    plan: &Plan,
) -> Result<Vec<Start>, CheckError> {
    let (names, poses) = (bed.str_list("robots")?, bed.f64_list("poses")?);
    if plan.frame != Frame::Map || poses.len() != 3 * names.len() {
        return Ok(Vec::new());
    }
    let ahead = controller.f64("look_ahead")?;
    let steered = |pose: &[f64]| Vector2::new(pose[0] + ahead * pose[2].cos(), pose[1] + ahead * pose[2].sin());
    let robots: Vec<(String, Vector2<f64>)> = names.iter().cloned().zip(poses.chunks_exact(3).map(steered)).collect();
    let order = match assignment.str("chain.order")? {
        "places" => ChainOrder::Places,
        _ => ChainOrder::Nearest,
    };
    let seating = Seating { keep_margin: assignment.f64("keep_margin")?, order };
    // More robots than places: the verdict on places says so.
    let Ok(seats) = organise(plan, &robots, &[], seating) else { return Ok(Vec::new()) };
    let at = |name: &str| robots.iter().find(|(robot, _)| robot == name).map(|(_, position)| *position);
    let start = |seat: trench_harness::Seated| {
        let position = at(&seat.robot)?;
        Some(Start { robot: seat.robot, queue: seat.queue, rank: seat.rank, position })
    };
    Ok(seats.into_iter().filter_map(start).collect())
}
