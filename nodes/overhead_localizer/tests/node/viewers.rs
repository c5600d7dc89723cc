//! What people are shown: markers, and who is missing.

use super::{START, build, detections, detections_of, send, wake};
use trench_core::{Action, Event, Level, Outbox, RequestId};
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{Identify, NameRobotsRequest, NameRobotsResponse, RobotState, TeamState};
use trench_msgs::visualization_msgs::{Marker, MarkerArray};
use trench_msgs::{Encode, Message};

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
    let mut core = super::nameless("order");
    for sequence in 1..=30 {
        send(core.as_mut(), sequence, &detections_of(&START[..1], sequence, |_| ()));
    }
    let report: DiagnosticArray = super::wake(core.as_mut(), 10_000_000_000);
    let expected = "2 robots, 1 pads found: names are given when the pads of all of them are seen: robot1 robot2";
    assert_eq!(report.status[1].message, expected);
}

#[test]
fn without_start_poses_robots_are_asked_to_turn_one_after_the_other() {
    let mut core = super::nameless("turns");
    let asked: Vec<Identify> = (1..=12)
        .flat_map(|sequence| send(core.as_mut(), sequence, &detections(sequence, |_| ())).published::<Identify>(6))
        .collect();
    // Pads must be seen, and stand for a while, before anybody is asked; then one is, in every frame.
    assert!((3..=6).contains(&asked.len()) && asked.iter().all(|each| each.robot == "robot1"), "{asked:?}");
    assert_eq!(wake(core.as_mut(), 10_000_000_000).status[1].message, "in doubt: robot1 robot2");
    // A person knows better.
    let request = NameRobotsRequest { robots: vec!["robot1".to_owned()], x: vec![1.5], y: vec![1.2] };
    let name = |core: &mut dyn trench_core::NodeCore, request: &NameRobotsRequest| {
        let mut outbox = Outbox::default();
        let event = Event::Request { service: 2, id: RequestId(1), cdr: &request.to_cdr() };
        core.handle(trench_core::Times::default(), event, &mut outbox);
        match outbox.actions.as_slice() {
            [Action::Respond { service: 2, cdr, .. }] => NameRobotsResponse::decode(cdr).unwrap(),
            other => panic!("{other:?}"),
        }
    };
    assert!(name(core.as_mut(), &request).success);
    let outbox = send(core.as_mut(), 13, &detections(13, |_| ()));
    let state: TeamState = outbox.last(0).unwrap();
    // With one known, the other one is known.
    assert!(state.robots.iter().all(|robot| robot.status == RobotState::STATUS_TRACKED), "{state:?}");
    assert!((state.robots[0].x - 1.5).abs() < 1e-3 && outbox.published::<Identify>(6).is_empty());
    for bad in [
        NameRobotsRequest { y: Vec::new(), ..request.clone() },
        NameRobotsRequest { x: vec![f64::NAN], ..request.clone() },
        NameRobotsRequest { robots: vec!["robot9".to_owned()], ..request.clone() },
        NameRobotsRequest { x: vec![0.9], ..request.clone() },
    ] {
        assert!(!name(core.as_mut(), &bad).success, "{bad:?}");
    }
}
