//! A change of behaviour is found and named.

use super::{check, golden};
use std::path::Path;
use trench_config::ParameterValue;
use trench_harness::replay::{Verdict, replay_from};
use trench_journal::{Journal, JournalReader, Start};

const CONTROLLER: &str = "robot1.formation_controller.mcap";

/// The start of a journal with one gain higher by 1 %.
fn with_more_gain(journal: &JournalReader, gain: &str) -> Start {
    let mut start = journal.start().clone();
    let parameter = start.parameters.iter_mut().find(|parameter| parameter.name == gain).unwrap();
    let ParameterValue::Double(value) = &mut parameter.value else { panic!("{parameter:?}") };
    *value *= 1.01;
    start
}

/// Copies a journal, with another start.
fn rewrite(journal: &JournalReader, start: &Start, to: &Path) {
    let mut written = Journal::replace(to, start).unwrap();
    for step in journal.steps() {
        let step = step.unwrap();
        let records = step.records();
        let bytes = step.with_outputs(&records, records.rest());
        written.append(step.at, bytes).unwrap();
    }
    written.finish().unwrap();
}

#[test]
fn one_per_cent_of_a_gain_is_found() {
    let journal = JournalReader::open(&golden("square").join(CONTROLLER)).unwrap();
    let report = replay_from(&journal, &with_more_gain(&journal, "gains.k1")).unwrap();
    let Verdict::Differs(first) = &report.verdict else { panic!("{:?}", report.verdict) };
    assert_eq!(first.node, "/robot1/formation_controller");
    assert_eq!(first.subject, "/robot1/cmd_vel", "{first}");
    assert!(first.pair.path.starts_with("twist.linear.x") || first.pair.path.starts_with("twist.angular.z"), "{first}");
    assert!(first.equal_before > 0 && first.seconds > 0.0, "{first}");
    let by = first.pair.by.unwrap();
    assert!(by > 0.0 && by < 0.1, "{first}");
    println!("{first}");
}

#[test]
fn the_command_reports_a_change_and_renews_the_journal() {
    let folder = tempfile::tempdir().unwrap();
    let journal = JournalReader::open(&golden("square").join(CONTROLLER)).unwrap();
    let path = folder.path().join(CONTROLLER);
    rewrite(&journal, &with_more_gain(&journal, "gains.k1"), &path);

    let (code, said) = check(&[], folder.path());
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("/robot1/formation_controller: /robot1/cmd_vel at t = "), "{said}");
    assert!(said.contains("recorded ") && said.contains(", now ") && said.contains("outputs equal before"), "{said}");

    let (code, said) = check(&["--update"], folder.path());
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("differed, written anew"), "{said}");
    let (code, said) = check(&[], folder.path());
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(super::journals(folder.path()), [path], "nothing is left beside it");
}

#[test]
fn a_configuration_that_the_node_refuses_is_a_difference() {
    let journal = JournalReader::open(&golden("square").join(CONTROLLER)).unwrap();
    let mut start = journal.start().clone();
    start.parameters.iter_mut().find(|parameter| parameter.name == "gains.k1").unwrap().value =
        ParameterValue::Double(-1.0);
    let report = replay_from(&journal, &start).unwrap();
    let Verdict::Differs(first) = &report.verdict else { panic!("{:?}", report.verdict) };
    assert!(first.subject == "start" && first.pair.now.contains("gains.k1"), "{first}");
}

/// Journals of a controller whose gain is not the one that its outputs were recorded with.
fn with_other_gain(folder: &Path) -> std::path::PathBuf {
    let journal = JournalReader::open(&golden("square").join(CONTROLLER)).unwrap();
    let path = folder.join(CONTROLLER);
    rewrite(&journal, &with_more_gain(&journal, "gains.k1"), &path);
    path
}

#[test]
fn tolerances_allow_what_they_name_and_no_more() {
    let folder = tempfile::tempdir().unwrap();
    let path = with_other_gain(folder.path());
    let file = folder.path().join("tolerances.yaml");
    let checked = |text: &str| {
        std::fs::write(&file, text).unwrap();
        check(&["--tolerances", file.to_str().unwrap()], &path)
    };
    let (code, said) = checked("tolerances:\n  /robot1/*: {'*': 10.0}\n");
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("  within tolerance ("), "{said}");
    let (code, said) = checked("tolerances:\n  /robot1/*: {'*': 1.0e-9}\n");
    assert_eq!(code, Some(1), "{said}");
    // Another field of the same message counts as before.
    let (code, said) = checked("tolerances:\n  /robot1/cmd_vel: {twist.linear.x: 10.0}\n");
    assert_eq!(code, Some(1), "{said}");
    assert!(!said.contains("/robot1/cmd_vel: twist.linear.x") || said.contains("twist.angular.z"), "{said}");
    let (code, said) = checked("tolerances:\n  /robot1/cmd_vel: {twist.linear.x: wide}\n");
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("tolerances.yaml:2"), "{said}");
}

#[test]
fn a_divergence_is_drawn_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let path = with_other_gain(folder.path());
    let pictures = folder.path().join("pictures");
    let (code, said) = check(&["--plot", pictures.to_str().unwrap()], &path);
    assert_eq!(code, Some(1), "{said}");
    let names: Vec<_> = super::journals(&pictures)
        .iter()
        .map(|path| path.file_name().unwrap().to_string_lossy().into_owned())
        .collect();
    assert!(names.iter().any(|name| name.contains("robot1.cmd_vel-twist.")), "{names:?}");
    for name in names {
        let svg = std::fs::read_to_string(pictures.join(name)).unwrap();
        assert!(
            svg.contains("recorded") && svg.contains("difference") && svg.matches("<polyline").count() > 3,
            "{svg}"
        );
    }
}
