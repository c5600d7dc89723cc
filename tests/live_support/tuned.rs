//! What the square and the triangle keep with the default profile, wherever their processes run.

use trench_bag::run::RunSummary;

/// Holds a run of 30 s against the bounds of the tuned profile.
pub(crate) fn keeps_its_bounds(summary: &RunSummary) {
    assert_eq!(summary.contacts, [], "{summary}");
    for robot in &summary.robots {
        assert!(robot.final_distance.unwrap() <= 0.02, "{}", robot.name);
    }
    let shape = summary.max_shape_error.unwrap();
    assert!(shape <= 0.02, "shape error {shape} m over the last third of the motion and at rest");
}
