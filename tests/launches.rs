//! The launch files of the thesis's chapters at test-bed scale, in lock-step: each with its verdict.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "the experiments use the rest")]
mod support;

use support::{Finished, drive, root};
use trench_bag::run::{SummaryOptions, summary};
use trench_harness::{Ending, load, plan};
use trench_journal::Disk;

/// Drives a launch file to its operator's verdict that all robots stand, and asks ground truth for contacts.
fn stands(file: &str, arguments: &[(&str, &str)]) -> Finished {
    let finished = drive(file, arguments);
    let summary = summary(&finished.run, &SummaryOptions::default());
    let end = Ending::Exit { node: "/operator".to_owned(), code: 0 };
    assert_eq!(finished.ending, end, "{file} {arguments:?}: {:?}\n{summary}", finished.complaints);
    assert!(finished.run.contacts.is_empty(), "{file} {arguments:?}: {:?}", finished.run.contacts);
    assert!(summary.closest.as_ref().unwrap().gap > 0.0, "{file} {arguments:?}: {summary}");
    finished
}

#[test]
fn fifteen_robots_track_their_goal_points_on_a_sinusoid() {
    let finished = stands("sinusoid.launch.yaml", &[]);
    assert_eq!(finished.run.robots.len(), 15);
    // While the goal points move, too: the centre is the look-ahead of 0.035 m behind, in the curves a little beside.
    for (robot, track) in &finished.run.robots {
        let late = track.poses.iter().filter(|pose| (12.0..20.0).contains(&pose.time));
        let far = late.map(|pose| {
            let [x, y] = track.goal_at(pose.time).unwrap();
            libm::hypot(pose.x - x, pose.y - y)
        });
        let far = far.fold(0.0, f64::max);
        assert!(far < 0.08, "{robot}: {far} m from its moving goal point");
    }
}

#[test]
fn a_chain_takes_up_a_diagonal_along_directions_of_attraction() {
    let chain = stands("chain.launch.yaml", &[]).conformity.finish();
    assert!(chain.at_the_end() <= 0.05, "{} m", chain.at_the_end());
}

#[test]
fn a_chain_is_drawn_to_its_nearest_points_with_and_without_obstacles() {
    for obstacles in [None, Some(("obstacles", ""))] {
        let finished = stands("nearest_chain.launch.yaml", obstacles.as_slice());
        let chain = finished.conformity.finish();
        assert!(chain.at_the_end() <= 0.05, "{obstacles:?}: {} m", chain.at_the_end());
        // Past all discs, the last of which lies 2.4 m up the diagonal.
        let behind = finished.run.robots.values().filter(|track| track.poses.last().unwrap().x < 2.5).count();
        assert_eq!(behind, 0, "{obstacles:?}");
    }
}

#[test]
fn three_robots_pass_a_long_corridor() {
    let finished = stands("corridor.launch.yaml", &[]);
    for (robot, track) in &finished.run.robots {
        let inside = track.poses.iter().filter(|pose| (1.1..2.7).contains(&pose.x));
        let widest = inside.map(|pose| (pose.y - 1.4).abs()).fold(0.0, f64::max);
        assert!(widest > 0.0 && widest < 0.27, "{robot} goes through: {widest} m beside the middle");
        assert!(track.poses.last().unwrap().x > 2.6, "{robot}");
    }
}

/// With its vertex within the walls the team rests there: who is ahead closes the corridor where it stands, not all of it.
#[test]
fn three_robots_rest_in_a_long_corridor() {
    let text = std::fs::read_to_string(root().join("config/formations/corridor.yaml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("corridor.yaml");
    std::fs::write(&file, text.replace("[[3.5, 1.4]]", "[[2.5, 1.4]]")).unwrap();
    // Formations are named beside those of the repository.
    let formation = format!("{}{}", "../".repeat(32), file.with_extension("").strip_prefix("/").unwrap().display());
    let finished = stands("corridor.launch.yaml", &[("formation", formation.as_str())]);
    let places: Vec<f64> = finished.run.robots.values().map(|track| track.poses.last().unwrap().x).collect();
    assert!(places.len() == 3 && places.iter().all(|x| (1.2..2.6).contains(x)), "{places:?}");
}

#[test]
fn a_formation_larger_than_the_field_is_refused_where_it_is_launched() {
    let refused = |file: &str, formation: &str| -> String {
        let arguments = [("formation".to_owned(), formation.to_owned())].into();
        let plan = plan(&root().join("launch").join(file), &arguments).unwrap();
        load(&plan, &Disk, 1).map(drop).map_err(|error| error.to_string()).err().unwrap_or_default()
    };
    // The swarm stands on 4 m x 2.8 m, the sinusoid on 7.6 m x 2.8 m.
    for (file, formation) in [("square.launch.yaml", "swarm"), ("chain.launch.yaml", "sinusoid")] {
        let said = refused(file, formation);
        assert!(said.contains("formation_file") && said.contains("is outside the field"), "{file}: {said}");
    }
    assert_eq!(refused("square.launch.yaml", "square_slow"), "");
    assert_eq!(refused("column.launch.yaml", "wings"), "", "the target's frame goes where the target goes");
}

#[test]
fn controllers_in_one_process_drive_as_separate_ones() {
    for file in ["square.launch.yaml", "column.launch.yaml"] {
        let run = |together| drive(file, &[("together", together), ("duration", "10.0")]).digest;
        assert_eq!(run("true"), run("false"), "{file}");
    }
}

/// Its mouth is towards the robots that come; its hull closes it.
#[test]
fn a_column_goes_round_a_crescent() {
    let crescent = root().join("config/obstacles/crescent.yaml").display().to_string();
    let finished = stands("column.launch.yaml", &[("obstacles", &crescent)]);
    let poses = finished.run.robots.values().flat_map(|track| &track.poses);
    let nearest = poses.map(|pose| libm::hypot(pose.x - 1.5, pose.y - 0.9)).fold(f64::INFINITY, f64::min);
    println!("{nearest:.3} m from its middle at the nearest");
    assert!(nearest < 0.2 + 0.08 + 0.3, "it is not in the way of anybody: {nearest} m from its middle at the nearest");
    assert!(finished.conformity.finish().at_the_end() <= 0.05);
}
