//! Teams for launch files made by tests: one queue a place, so that ways cross.

use crate::support::root;
use std::fmt::Write;
use trench_sim::Random;

/// Places at least this far from each other, m: bodies of 0.16 m and room to pass.
const APART: f64 = 0.36;

/// `count` places between 0.25 m and `far`, m.
pub(crate) fn places(count: usize, far: [f64; 2], seed: u64) -> Vec<[f64; 2]> {
    let mut random = Random::new(seed, 97);
    let mut places: Vec<[f64; 2]> = Vec::new();
    while places.len() < count {
        let place = [random.between(0.25, far[0]), random.between(0.25, far[1])];
        if places.iter().all(|other| libm::hypot(place[0] - other[0], place[1] - other[1]) > APART) {
            places.push(place);
        }
    }
    places
}

/// A formation file that sends one robot to each place.
pub(crate) fn formation(places: &[[f64; 2]]) -> String {
    let mut text = "name: anywhere\nframe: map\nqueues:\n".to_owned();
    for (index, [x, y]) in places.iter().enumerate() {
        let share = 1.0 / places.len() as f64;
        let end = y + 0.1;
        write!(
            text,
            "- name: place{index}\n  segment: {{kind: line, points: [[{x}, {y}], [{x}, {end}]]}}\n  \
             vertices: [[{x}, {y}]]\n  share: {share}\n  tolerance: 0.02\n"
        )
        .unwrap();
    }
    text
}

/// A launch file for that many robots and `seconds`; `bed` and `world` are more arguments of bed.launch.yaml, `world` one of
/// controller.launch.yaml too.
pub(crate) fn launch_file(
    robots: usize,
    seconds: f64,
    formation: &str,
    poses: &str,
    world: &str,
    bed: &[(&str, &str)],
) -> String {
    let launch = root().join("launch");
    let names: Vec<String> = (1..=robots).map(|robot| format!("robot{robot}")).collect();
    let team = format!("[{}]", names.join(", "));
    let more: String =
        bed.iter().map(|(name, value)| format!("    - {{name: {name}, value: \"{value}\"}}\n")).collect();
    let mut text = format!(
        "launch:\n\
         - include:\n    file: \"{bed}\"\n    arg:\n    - {{name: robots, value: \"{team}\"}}\n    \
         - {{name: poses, value: \"{poses}\"}}\n    - {{name: world, value: {world}}}\n{more}\
         - node:\n    exec: leader_assignment\n    name: leader_assignment\n    param:\n    \
         - {{name: robots, value: {team}}}\n    - {{name: formation_file, value: \"{formation}\"}}\n\
         - node:\n    exec: operator\n    name: operator\n    param:\n    - {{name: robots, value: {team}}}\n    \
         - {{name: duration, value: {seconds:?}}}\n",
        bed = launch.join("bed.launch.yaml").display(),
    );
    for name in names {
        write!(
            text,
            "- include:\n    file: \"{controller}\"\n    arg:\n    - {{name: robot, value: \"{name}\"}}\n    \
             - {{name: robots, value: \"{team}\"}}\n    - {{name: world, value: {world}}}\n",
            controller = launch.join("controller.launch.yaml").display(),
        )
        .unwrap();
    }
    text
}
