//! Teams in pursuit of a moving target (Figure 1.5), in lock-step: the cores, launch files and honest bed of the live runs.
//!
//! `TRENCH_SEEDS` sets how many of twenty random starts the pursuit takes: all in scripts/acceptance, else three, others every day. There are
//! as many more as are asked for.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "the experiments use the rest")]
mod support;

use std::time::SystemTime;
use support::{Finished, by_lasers, drive, named_seeds, pursued, root, starts};
use trench_bag::run::{SummaryOptions, summary};
use trench_harness::Ending;

/// As many of the twenty starts as `TRENCH_SEEDS` says, others every day.
fn seeds() -> Vec<u64> {
    let today = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap().as_secs() / 86_400;
    let count = named_seeds().unwrap_or(3);
    (0..count).map(|index| 1 + (today * count + index) % count.max(20)).collect()
}

fn stands_without_contact(finished: &Finished, what: &str) {
    assert_eq!(
        finished.ending,
        Ending::Exit { node: "/operator".to_owned(), code: 0 },
        "{what}: {:?}",
        finished.complaints
    );
    let summary = summary(&finished.run, &SummaryOptions::default());
    assert!(summary.ground_truth, "judged by ground truth");
    assert!(finished.run.contacts.is_empty(), "{what}: {:?}", finished.run.contacts);
    let closest = summary.closest.unwrap();
    assert!(closest.gap > 0.0, "{what}: {closest:?}");
}

#[test]
fn a_column_follows_its_target_over_an_empty_field() {
    stands_without_contact(&drive("column.launch.yaml", &[]), "column");
}

#[test]
fn eight_robots_pursue_their_target_through_traps_and_gaps() {
    // All starts are tried, whatever comes of one.
    let failed: Vec<u64> =
        seeds().into_iter().filter(|seed| std::panic::catch_unwind(|| pursue(*seed)).is_err()).collect();
    assert!(failed.is_empty(), "seeds {failed:?}");
}

fn pursue(seed: u64) {
    let (poses, number) = (starts(seed), seed.to_string());
    let finished = drive("pursuit.launch.yaml", &[("poses", &poses), ("seed", &number)]);
    let what = format!("seed {seed}, poses {poses}");
    print!("seed {seed}: ");
    stands_without_contact(&finished, &what);
    println!("{}", pursued::judge(&finished.conformity.finish(), &what));
    energy_is_accounted_for(&finished, &what);
}

/// Nobody tells of the field: what robots do not see with their lasers, or have not seen in the last seconds, is not there. What moves is not
/// among it: how fast it does, nobody sees.
#[test]
fn the_pursuit_finds_its_obstacles_by_lasers_alone() {
    let folder = tempfile::tempdir().unwrap();
    let by_lasers = by_lasers(folder.path());
    let given = by_lasers.each_ref().map(|(name, value)| (*name, value.as_str()));
    for seed in ["1", "2", "3"] {
        let finished = drive("pursuit.launch.yaml", &[&given[..], &[("seed", seed)]].concat());
        let what = format!("by lasers, seed {seed}");
        stands_without_contact(&finished, &what);
        let worst = finished.conformity.finish().at_the_end();
        assert!(worst <= 0.05, "{what}: {worst} m from the segment at the end");
    }
}

/// Nobody but the laws and their inputs moves a robot here: no monitor finds V beyond its bound. What it finds otherwise is so: robots
/// that came into zone 1 of their leader, or lost it from sight.
fn energy_is_accounted_for(finished: &Finished, what: &str) {
    let is_of = |equation: &str| finished.violations.iter().filter(|(_, said)| said.contains(equation)).count();
    let (near, far) = (is_of(": A.12 (i): "), is_of(": 6.2.2: "));
    let others: Vec<_> = finished
        .violations
        .iter()
        .filter(|(_, said)| !said.contains(": A.12 (i): ") && !said.contains(": 6.2.2: "))
        .collect();
    println!("{} words of monitors, {near} on zone 1, {far} on leaders beyond rho_bar", finished.words);
    assert!(finished.words > 10_000, "{what}: ten words a second and robot, not {}", finished.words);
    assert!(others.is_empty(), "{what}: {others:?}");
}

#[test]
fn two_pursuits_are_equal_byte_for_byte() {
    let run = || drive("pursuit.launch.yaml", &[("duration", "20.0"), ("tolerance", "9.0")]).digest;
    assert_eq!(run(), run());
}

/// The column under the profile chain.yaml with one setting replaced by another.
fn column_with(setting: &str, other: &str, arguments: &[(&str, &str)]) -> Finished {
    let profile = std::fs::read_to_string(root().join("config/profiles/chain.yaml")).unwrap();
    assert_eq!(profile.matches(setting).count(), 1, "{setting}");
    let folder = tempfile::tempdir().unwrap();
    for name in ["launch", "config/profiles"] {
        let target = folder.path().join(name);
        std::fs::create_dir_all(&target).unwrap();
        for file in std::fs::read_dir(root().join(name)).unwrap() {
            let file = file.unwrap().path();
            std::fs::copy(&file, target.join(file.file_name().unwrap())).unwrap();
        }
    }
    for name in ["cameras", "formations", "robots", "worlds"] {
        let link = folder.path().join("config").join(name);
        std::os::unix::fs::symlink(root().join("config").join(name), link).unwrap();
    }
    std::fs::write(folder.path().join("config/profiles/other.yaml"), profile.replace(setting, other)).unwrap();
    let arguments = [&[("profile", "other")], arguments].concat();
    support::drive_file(&folder.path().join("launch/column.launch.yaml"), &arguments)
}

/// Every law on the honest bed: the column forms up on its segment, at rest and moving.
#[test]
fn every_dynamic_law_forms_the_column() {
    for law in ["goal", "goal_damped", "goal_at_rest", "zoned", "nearest", "chain", "queue"] {
        let arguments = [("tolerance", "0.07"), ("duration", "50.0")];
        let finished = column_with("law: chain", &format!("law: {law}"), &arguments);
        stands_without_contact(&finished, law);
    }
}

/// What of the segment robots ahead take: nothing, where they have come, or where they mean to stand.
#[test]
fn robots_that_tell_their_places_form_the_column() {
    for encroaching in ["nothing", "obstacles", "robots_apart", "places"] {
        let finished = column_with("encroaching: robots", &format!("encroaching: {encroaching}"), &[]);
        stands_without_contact(&finished, encroaching);
    }
}
