//! Another lens or another place of the camera while the node runs.

use super::{LENS, MOUNT, START, build, camera, image, send, timing};
use nalgebra::Point3;
use trench_core::{Action, Event, NodeCore, Outbox, RequestId, Times};
use trench_msgs::msg::{RobotState, SetCalibrationRequest, SetCalibrationResponse, TeamState};
use trench_msgs::{Encode, Message};
use trench_optics::{Camera, CameraInfo, Mount, Pad, Pose2};
use trench_sim::camera::{Appearance, Renderer};

fn ask(core: &mut dyn NodeCore, request: &SetCalibrationRequest) -> SetCalibrationResponse {
    let mut outbox = Outbox::default();
    let event = Event::Request { service: 3, id: RequestId(1), cdr: &request.to_cdr() };
    core.handle(Times::default(), event, &mut outbox);
    let answer = outbox.actions.iter().find_map(|action| match action {
        Action::Respond { service: 3, cdr, .. } => SetCalibrationResponse::decode(cdr).ok(),
        _ => None,
    });
    answer.unwrap()
}

/// Where a camera that hangs elsewhere takes a robot to be that the test's camera sees at `pose`.
fn by(other: &Camera, pose: Pose2) -> Pose2 {
    let [yellow, blue] = Pad::NOMINAL.discs(pose).map(|disc| {
        let pixel = camera().project(Point3::new(disc.x, disc.y, Pad::NOMINAL.height)).unwrap();
        other.unproject(pixel, Pad::NOMINAL.height).unwrap()
    });
    Pad::pose(yellow, blue)
}

#[test]
fn robots_keep_their_names_when_the_map_moves_below_them() {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, Appearance::default());
    let mut core = build("").unwrap();
    let see = |core: &mut dyn NodeCore, sequence: u64| -> TeamState {
        send(core, sequence, &image(&renderer, &START, timing(sequence).0).to_cdr()).last(0).unwrap()
    };
    for sequence in 1..=3 {
        see(core.as_mut(), sequence);
    }
    // Half a metre aside and a quarter turned: one robot's new place is as near to the other's old one.
    let moved = Mount { x: 1.7, y: 1.1, yaw: 1.6, ..*camera().mount() };
    let lens = CameraInfo::parse("", LENS).unwrap();
    let mount = SetCalibrationRequest { mount: moved.to_yaml(), ..SetCalibrationRequest::default() };
    assert!(ask(core.as_mut(), &mount).success);
    let check = |state: TeamState, other: &Camera| {
        for (robot, pose) in state.robots.iter().zip(START) {
            let expected = by(other, pose);
            let off = (robot.x - expected.x).hypot(robot.y - expected.y);
            assert!(robot.status == RobotState::STATUS_TRACKED && off < 3e-4, "{robot:?}: off by {off} m");
        }
    };
    check(see(core.as_mut(), 4), &Camera::new(lens.lens, moved).unwrap());
    // And a lens of another focal length.
    let mut longer = lens;
    (longer.lens.fx, longer.lens.fy) = (1.05 * longer.lens.fx, 1.05 * longer.lens.fy);
    let other = Camera::new(longer.lens, moved).unwrap();
    let camera_info = longer.to_yaml();
    assert!(ask(core.as_mut(), &SetCalibrationRequest { camera_info, ..SetCalibrationRequest::default() }).success);
    check(see(core.as_mut(), 5), &other);
}

#[test]
fn a_lens_of_another_camera_than_the_colours_is_refused() {
    let lens = |name: &str| {
        let camera_info = CameraInfo { name: name.to_owned(), ..CameraInfo::parse("", LENS).unwrap() }.to_yaml();
        SetCalibrationRequest { camera_info, ..SetCalibrationRequest::default() }
    };
    let mut core = build("    colour.camera: overhead\n").unwrap();
    let refused = ask(core.as_mut(), &lens("lab"));
    let reason = "the colours in force are those of the camera overhead, not of lab: give its colours together";
    assert!(!refused.success && refused.message.contains(reason), "{refused:?}");
    assert!(ask(core.as_mut(), &lens("overhead")).success);
    // Colours that are nobody's are anybody's.
    assert!(ask(build("").unwrap().as_mut(), &lens("lab")).success);
}

#[test]
fn what_does_not_fit_is_refused_with_the_reason_and_changes_nothing() {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, Appearance::default());
    let mut core = build("").unwrap();
    let none = SetCalibrationRequest::default;
    let low = Mount { height: 0.05, ..*camera().mount() };
    let two = "mounts:\n- {camera: a, position: [1.0, 1.0, 3.0]}\n- {camera: b, position: [2.0, 1.0, 3.0]}\n";
    for (bad, reason) in [
        (none(), "neither a lens nor a mount"),
        (SetCalibrationRequest { mount: MOUNT.replace("3.0]", "high]"), ..none() }, "mount:4: mount.position"),
        (SetCalibrationRequest { mount: two.to_owned(), ..none() }, "places 2 cameras, there are 1"),
        (SetCalibrationRequest { mount: low.to_yaml(), ..none() }, "below the pads"),
        (
            SetCalibrationRequest { camera: "west".to_owned(), camera_info: LENS.to_owned(), ..none() },
            "no camera \"west\"",
        ),
        (SetCalibrationRequest { camera_info: "image_width: 768\n".to_owned(), ..none() }, "camera_info:1"),
    ] {
        let response = ask(core.as_mut(), &bad);
        assert!(!response.success && response.message.contains(reason), "{bad:?}: {response:?}");
    }
    let state: TeamState = send(core.as_mut(), 1, &image(&renderer, &START, timing(1).0).to_cdr()).last(0).unwrap();
    for (robot, pose) in state.robots.iter().zip(START) {
        assert!((robot.x - pose.x).hypot(robot.y - pose.y) < 3e-4, "{robot:?}");
    }
}
