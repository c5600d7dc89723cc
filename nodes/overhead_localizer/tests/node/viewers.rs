//! What people are shown: markers, and who is missing.

use super::{START, build, detections, detections_of, send};
use trench_core::{Action, Level, Outbox};
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::visualization_msgs::{Marker, MarkerArray};

fn pictures(outbox: &Outbox) -> Vec<MarkerArray> {
    outbox.published(3)
}

#[test]
fn robots_are_drawn_ten_times_a_second_in_the_colour_of_their_status() {
    let mut core = build("    input: detections\n").unwrap();
    let mut frames = Vec::new();
    // 25 frames a second.
    for sequence in 1..=51 {
        frames.push(pictures(&send(core.as_mut(), sequence, &detections(sequence, |_| ()))));
    }
    let count = frames.iter().filter(|frame| !frame.is_empty()).count();
    assert!((16..=21).contains(&count), "{count} pictures in two seconds");
    let markers = &frames[0][0].markers;
    let drawn: Vec<(i32, &str, i32)> =
        markers.iter().map(|marker| (marker.id, marker.ns.as_str(), marker.r#type)).collect();
    let kinds = [
        ("robots/body", Marker::CYLINDER),
        ("robots/heading", Marker::ARROW),
        ("robots/name", Marker::TEXT_VIEW_FACING),
    ];
    assert_eq!(drawn, [0, 1].map(|id| kinds.map(|(namespace, kind)| (id, namespace, kind))).concat());
    assert_eq!((markers[2].text.as_str(), markers[5].text.as_str()), ("robot1", "robot2"));
    assert!((markers[3].pose.position.x - START[1].x).abs() < 1e-6, "{markers:?}");
    assert!(markers[0].color.g > markers[0].color.r, "green: it is seen");

    // A second without the second robot: grey, where it was.
    let mut last = Vec::new();
    for sequence in 52..=80 {
        let one = detections_of(&START[..1], sequence, |_| ());
        last = Some(pictures(&send(core.as_mut(), sequence, &one))).filter(|all| !all.is_empty()).unwrap_or(last);
    }
    let grey = &last[0].markers[3];
    assert!(grey.color.r == grey.color.g && grey.pose.position == markers[3].pose.position, "{grey:?}");
}

#[test]
fn more_robots_than_pads_is_said_with_the_names_of_the_missing() {
    let check = |more: &str, robots: usize, expected: &str| {
        let mut core = build(&format!("    input: detections\n{more}")).unwrap();
        let mut warnings = Vec::new();
        for sequence in 1..=60 {
            let outbox = send(core.as_mut(), sequence, &detections_of(&START[..robots], sequence, |_| ()));
            warnings.extend(outbox.actions.into_iter().filter_map(|action| match action {
                Action::Log { level: Level::Warn, text } => Some((sequence, text)),
                _ => None,
            }));
        }
        // Once, after a second.
        assert_eq!(warnings, [(26, expected.to_owned())]);
        let report: DiagnosticArray = super::wake(core.as_mut(), 10_000_000_000);
        assert_eq!((report.status[1].level, report.status[1].message.as_str()), (1, expected));
    };
    check("", 1, "2 robots, 1 pads found; missing: robot2");
    check("", 0, "2 robots, 0 pads found; missing: robot1 robot2");
}

#[test]
fn without_start_poses_all_pads_are_waited_for() {
    let mut core = super::nameless();
    for sequence in 1..=30 {
        send(core.as_mut(), sequence, &detections_of(&START[..1], sequence, |_| ()));
    }
    let report: DiagnosticArray = super::wake(core.as_mut(), 10_000_000_000);
    let expected = "2 robots, 1 pads found: names are given when the pads of all of them are seen: robot1 robot2";
    assert_eq!(report.status[1].message, expected);
}
