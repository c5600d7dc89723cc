//! The node core from images to messages, and what it makes of bad ones.

#![expect(clippy::unwrap_used, reason = "a test may panic, its helpers too")]

mod calibration;
mod encodings;
mod noise;
mod restart;
mod strangers;
mod viewers;

use overhead_localizer::description;
use trench_config::params::{Source as Given, resolve};
use trench_config::{ConfigError, Origin};
use trench_core::{
    Action, Event, Files, Level, NodeContext, NodeCore, Outbox, RequestId, RosTime, Source, Steady, Times,
};
use trench_msgs::Encode;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::geometry_msgs::TransformStamped;
use trench_msgs::msg::{Disc, DiscArray, Pad as PadMessage, PadArray, RobotState, TeamState};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::sensor_msgs::Image;
use trench_msgs::std_msgs::Header;
use trench_msgs::std_srvs::{TriggerRequest, TriggerResponse};
use trench_msgs::tf2_msgs::TFMessage;
use trench_optics::{Camera, CameraInfo, Mount, Pad, Pose2};
use trench_sim::camera::{Appearance, Renderer, Scene};

const LENS: &str = include_str!("../../../../config/cameras/overhead.yaml");
const MOUNT: &str = include_str!("../../../../config/cameras/overhead_mount.yaml");
const START: [Pose2; 2] = [Pose2 { x: 0.5, y: 0.5, theta: 0.8 }, Pose2 { x: 1.5, y: 1.2, theta: -2.0 }];

/// The files of config/cameras.
struct Shipped;

impl Files for Shipped {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        match path {
            "overhead.yaml" => Ok(LENS.to_owned()),
            "overhead_mount.yaml" => Ok(MOUNT.to_owned()),
            other => Err(ConfigError {
                origin: Origin::default(),
                key: key.to_owned(),
                value: other.to_owned(),
                problem: "cannot be read".to_owned(),
                remedy: String::new(),
            }),
        }
    }
}

const PARAMETERS: &str = "overhead_localizer:
  ros__parameters:
    robots: [robot2, robot1]
    initial_poses: [1.5, 1.2, -2.0, 0.5, 0.5, 0.8]
    camera_info_file: overhead.yaml
    mount_file: overhead_mount.yaml
    # The cameras of these tests have no noise: resting robots look the same in every frame.
    frozen_frames: 0
";

fn build(more: &str) -> Result<Box<dyn NodeCore>, String> {
    restart(more, None)
}

/// With what the last life left.
fn restart(more: &str, checkpoint: Option<Vec<u8>>) -> Result<Box<dyn NodeCore>, String> {
    let text = format!("{PARAMETERS}{more}");
    let description = description();
    let sources = [Given::File { name: "localizer.yaml", text: &text }];
    let parameters = resolve(&sources, "/", description.name, &(description.parameters)())
        .map_err(|errors| errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))?;
    let name = description.name.to_owned();
    let context = NodeContext { namespace: "/".to_owned(), name, checkpoint, ..NodeContext::default() };
    (description.build)(&context, &parameters, &Shipped).map_err(|error| error.to_string())
}

/// Without start poses, on detections; names are found in this way.
fn nameless(names: &str) -> Box<dyn NodeCore> {
    let description = description();
    let input = format!("input: detections\n    names: {names}");
    let text = PARAMETERS.replace("initial_poses: [1.5, 1.2, -2.0, 0.5, 0.5, 0.8]", &input);
    let sources = [Given::File { name: "localizer.yaml", text: &text }];
    let parameters = resolve(&sources, "/", description.name, &(description.parameters)()).unwrap();
    (description.build)(&NodeContext::default(), &parameters, &Shipped).unwrap()
}

fn camera() -> Camera {
    Camera::new(CameraInfo::parse("", LENS).unwrap().lens, Mount::parse("", MOUNT).unwrap()).unwrap()
}

fn image(renderer: &Renderer, robots: &[Pose2], stamp: RosTime) -> Image {
    let mut data = vec![0; renderer.frame_len()];
    let sweeps: Vec<Vec<Pose2>> = robots.iter().map(|pose| vec![*pose]).collect();
    renderer.render(Scene { robots: &sweeps, obstacles: &[] }, stamp.0 as u64, &mut data).unwrap();
    Image {
        header: Header { stamp: stamp.into(), frame_id: "overhead".to_owned() },
        height: 576,
        width: 768,
        encoding: "rgb8".to_owned(),
        is_bigendian: 0,
        step: 2304,
        data,
    }
}

/// Frame `sequence` of a camera at 25 Hz: when it is exposed, and who sends it.
fn timing(sequence: u64) -> (RosTime, Times, Source) {
    let exposed = RosTime(1_000_000_000 + 40_000_000 * sequence as i64);
    let at = Times { ros: exposed.plus_seconds(0.035), steady: Steady(40_000_000 * sequence) };
    (exposed, at, Source { gid: [1; 16], sequence })
}

fn send(core: &mut dyn NodeCore, sequence: u64, cdr: &[u8]) -> Outbox {
    let mut outbox = Outbox::default();
    let (_, at, source) = timing(sequence);
    core.handle(at, Event::Message { port: 0, source, cdr, arrived: None }, &mut outbox);
    outbox
}

fn wake(core: &mut dyn NodeCore, steady: u64) -> DiagnosticArray {
    let mut outbox = Outbox::default();
    core.handle(Times { ros: RosTime(0), steady: Steady(steady) }, Event::Wakeup, &mut outbox);
    outbox.last(2).unwrap()
}

#[test]
fn one_frame_gives_the_teams_state_odometry_and_transforms() {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, Appearance::default());
    let mut core = build("").unwrap();
    for sequence in 1..=3 {
        let (stamp, ..) = timing(sequence);
        let mut frame = image(&renderer, &START, stamp);
        if sequence == 3 {
            // bgr8 with padding at the end of each row.
            frame.encoding = "bgr8".to_owned();
            frame.step = 2400;
            let rows = frame.data.chunks(2304);
            frame.data = rows
                .flat_map(|row| {
                    let swapped = row.chunks(3).flat_map(|pixel| [pixel[2], pixel[1], pixel[0]]);
                    swapped.chain(std::iter::repeat_n(77, 96)).collect::<Vec<u8>>()
                })
                .collect();
        }
        let outbox = send(core.as_mut(), sequence, &frame.to_cdr());
        let state: TeamState = outbox.last(0).unwrap();
        assert_eq!((state.header.stamp, state.frame_number), (stamp.into(), sequence));
        assert_eq!(state.header.frame_id, "map");
        for (robot, (name, pose)) in state.robots.iter().zip([("robot1", START[0]), ("robot2", START[1])]) {
            assert_eq!((robot.name.as_str(), robot.status), (name, RobotState::STATUS_TRACKED));
            let error = [robot.x - pose.x, robot.y - pose.y, robot.theta - pose.theta];
            assert!(error[0].hypot(error[1]) < 3e-4 && error[2].abs() < 5e-3, "{error:?}");
        }
        let transforms = outbox.last::<TFMessage>(1).unwrap().transforms;
        let children: Vec<&str> =
            transforms.iter().map(|each: &TransformStamped| each.child_frame_id.as_str()).collect();
        assert_eq!(children, ["robot1/base_link", "robot2/base_link"]);
        let odometry: Odometry = outbox.last(5).unwrap();
        assert!((odometry.pose.pose.position.x - 1.5).abs() < 3e-4, "{odometry:?}");
        assert!(odometry.pose.covariance[0] > 0.0 && odometry.pose.covariance[35] > 0.0);
    }
    let topics: Vec<&str> = core.interface().publications.iter().map(|each| each.topic.as_str()).collect();
    assert_eq!(
        topics,
        ["/team_state", "/tf", "/diagnostics", "/markers", "/robot1/odom", "/robot2/odom", "/identify", "/loop_delay"]
    );
}

#[test]
fn bad_frames_are_counted_reported_and_harmless() {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, Appearance::default());
    let good = |sequence| image(&renderer, &START, timing(sequence).0);
    let mut core = build("").unwrap();
    send(core.as_mut(), 1, &good(1).to_cdr());
    let mut check = |frame: &[u8], expected: &str| {
        let outbox = send(core.as_mut(), 2, frame);
        let logged =
            |action: &Action| matches!(action, Action::Log { level: Level::Error, text } if text.contains(expected));
        assert!(outbox.actions.iter().any(logged), "{expected}: {:?}", outbox.actions);
        assert_eq!(outbox.published::<TeamState>(0), []);
    };
    check(
        &Image { encoding: "mono8".to_owned(), ..good(2) }.to_cdr(),
        "\"mono8\", it must be rgb8, bgr8 or yuv422_yuy2: pads",
    );
    check(&Image { width: 640, ..good(2) }.to_cdr(), "[640, 576]");
    check(&Image { step: 100, ..good(2) }.to_cdr(), "a row of 768 pixels needs 2304");
    check(&Image { data: vec![0; 100], ..good(2) }.to_cdr(), "the frame has 100 bytes");
    check(&Image { height: u32::MAX, width: u32::MAX, step: u32::MAX, ..good(2) }.to_cdr(), "4294967295");
    check(&good(2).to_cdr()[..1000], "Image.data");
    check(&[], "the message ends");
    let report = wake(core.as_mut(), 1_200_000_000);
    assert_eq!(report.status[0].level, 2);
    let dropped = report.status[0].values.iter().find(|value| value.key == "frames dropped").unwrap();
    assert_eq!(dropped.value, "7");
    // Black, white and coloured frames are frames; the robots are carried forward, then lost.
    for (sequence, value) in (3..).zip([0, 255]) {
        let frame = Image { data: vec![value; 2304 * 576], ..good(sequence) };
        let state: TeamState = send(core.as_mut(), sequence, &frame.to_cdr()).last(0).unwrap();
        assert!(state.robots.iter().all(|robot| robot.status == RobotState::STATUS_PREDICTED), "{state:?}");
    }
    let yellow = Image { data: [235, 205, 45].repeat(768 * 576), ..good(40) };
    let outbox = send(core.as_mut(), 40, &yellow.to_cdr());
    assert!(outbox.last::<TeamState>(0).unwrap().robots.iter().all(|robot| robot.status == RobotState::STATUS_LOST));
    assert_eq!(
        outbox.last::<DiagnosticArray>(2).unwrap().status[1].message,
        "2 robots, 0 pads found; missing: robot1 robot2"
    );
    // And then all is well again; the frame before the last comes too late.
    let state: TeamState = send(core.as_mut(), 41, &good(41).to_cdr()).last(0).unwrap();
    assert!(state.robots.iter().all(|robot| robot.status == RobotState::STATUS_TRACKED), "{state:?}");
    assert_eq!(send(core.as_mut(), 39, &good(39).to_cdr()).published::<TeamState>(0), []);
}

fn detections(sequence: u64, change: impl Fn(&mut Vec<Disc>)) -> Vec<u8> {
    detections_of(&START, sequence, change)
}

/// What a detector would find of robots.
fn detections_of(robots: &[Pose2], sequence: u64, change: impl Fn(&mut Vec<Disc>)) -> Vec<u8> {
    let camera = camera();
    let mut discs = Vec::new();
    for &pose in robots {
        for (colour, place) in [Disc::COLOUR_YELLOW, Disc::COLOUR_BLUE].into_iter().zip(Pad::NOMINAL.discs(pose)) {
            let pixel = camera.project(nalgebra::Point3::new(place.x, place.y, Pad::NOMINAL.height)).unwrap();
            discs.push(Disc { colour, u: pixel.u, v: pixel.v, area: 346.0, confidence: 1.0 });
        }
    }
    change(&mut discs);
    let stamp = timing(sequence).0.into();
    DiscArray { header: Header { stamp, frame_id: "overhead".to_owned() }, discs }.to_cdr()
}

#[test]
fn detections_serve_as_well_as_images() {
    let mut core = build("    input: detections\n").unwrap();
    assert_eq!(core.interface().subscriptions[0].topic, "/overhead/detections");
    let state: TeamState = send(core.as_mut(), 1, &detections(1, |_| ())).last(0).unwrap();
    for (robot, pose) in state.robots.iter().zip(START) {
        assert_eq!(robot.status, RobotState::STATUS_TRACKED);
        assert!((robot.x - pose.x).hypot(robot.y - pose.y) < 1e-6, "{robot:?}");
    }
    let changes: [fn(&mut Disc); 3] = [|disc| disc.colour = 7, |disc| disc.u = f64::NAN, |disc| disc.v = f64::INFINITY];
    for change in changes {
        let broken = detections(2, |discs| change(&mut discs[1]));
        assert_eq!(send(core.as_mut(), 2, &broken).published::<TeamState>(0), []);
    }
    let many = detections(2, |discs| *discs = vec![discs[0]; 5000]);
    assert_eq!(send(core.as_mut(), 2, &many).published::<TeamState>(0), []);
    // Far outside any image: no place in the map, no trouble.
    let far = detections(2, |discs| discs[0].u = 1e300);
    let state: TeamState = send(core.as_mut(), 2, &far).last(0).unwrap();
    assert_eq!(state.robots[0].status, RobotState::STATUS_PREDICTED);
}

/// A pad that is nobody's, and then a robot without one: names stay where they were, and the report says how many there are.
#[test]
fn more_pads_than_robots_and_fewer_do_not_move_names() {
    let mut core = build("    input: detections\n").unwrap();
    let stranger = Pose2 { x: 1.0, y: 0.9, theta: 0.3 };
    let mut told = |sequence: u64, pads: &[Pose2]| {
        let outbox = send(core.as_mut(), sequence, &detections_of(pads, sequence, |_| ()));
        let state: TeamState = outbox.last(0).unwrap();
        for (robot, pose) in state.robots.iter().zip(START) {
            assert!((robot.x - pose.x).hypot(robot.y - pose.y) < 1e-3, "frame {sequence}: {robot:?}");
        }
        // The controllers keep off it from its first frame on, and off no robot's pad twice.
        let unnamed: Vec<[f64; 2]> = state.unnamed.iter().map(|pad| [pad.x, pad.y]).collect();
        assert_eq!(unnamed.len(), usize::from(pads.contains(&stranger)), "frame {sequence}: {unnamed:?}");
        assert!(unnamed.iter().all(|[x, y]| (x - stranger.x).hypot(y - stranger.y) < 1e-3), "{unnamed:?}");
        let report = outbox.published::<DiagnosticArray>(2).pop();
        (state.robots.iter().map(|robot| robot.status).collect::<Vec<_>>(), report)
    };
    told(1, &START);
    for sequence in 2..=30 {
        let (statuses, _) = told(sequence, &[START[0], stranger, START[1]]);
        assert_eq!(statuses, [RobotState::STATUS_TRACKED; 2], "frame {sequence}");
    }
    // The stranger does not stand in for a robot whose pad is hidden.
    let (statuses, report) = told(31, &[START[0], stranger]);
    assert_eq!(statuses, [RobotState::STATUS_TRACKED, RobotState::STATUS_PREDICTED]);
    let message = &report.unwrap().status[1].message;
    assert!(message.contains("not seen: robot2"), "{message}");
    let (statuses, _) = told(32, &START);
    assert_eq!(statuses, [RobotState::STATUS_TRACKED; 2]);
}

#[test]
fn silence_is_an_error_and_the_rate_is_told() {
    let mut core = build("    input: detections\n").unwrap();
    assert_eq!(wake(core.as_mut(), 0).status[0].message, "no frames");
    for sequence in 1..=26 {
        send(core.as_mut(), sequence, &detections(sequence, |_| ()));
    }
    let report = wake(core.as_mut(), 1_040_000_001);
    assert_eq!((report.status[0].level, report.status[0].message.as_str()), (0, "frames arrive"));
    let rate = report.status[0].values.iter().find(|value| value.key == "frames per second").unwrap();
    assert_eq!(rate.value, "25.0");
    assert_eq!(wake(core.as_mut(), 2_000_000_000).status[0].message, "no frames");
}

#[test]
fn more_than_one_frame_missed_of_a_hundred_is_a_warning_that_tells_the_remedy() {
    let mut core = build("    input: detections\n").unwrap();
    wake(core.as_mut(), 0);
    let mut send_all = |sequences: &mut dyn Iterator<Item = u64>, until: u64| {
        sequences.for_each(|sequence| drop(send(core.as_mut(), sequence, &detections(sequence, |_| ()))));
        let status = wake(core.as_mut(), until).status.swap_remove(0);
        (status.level, status.message)
    };
    let ok = (0, "frames arrive".to_owned());
    assert_eq!(send_all(&mut (1..=26), 1_040_000_001), ok);
    let (level, message) = send_all(&mut (27..=52).step_by(3), 2_080_000_002);
    assert_eq!(level, 1);
    assert!(message.starts_with("16 of 25 frames missed: a camera over the network needs sockets"), "{message}");
    assert_eq!(send_all(&mut (52..=78), 3_120_000_003), ok);
}

#[test]
fn a_frozen_camera_drives_nobody_however_fresh_its_stamps() {
    let description = description();
    let text = PARAMETERS.replace("frozen_frames: 0", "input: detections");
    let sources = [Given::File { name: "localizer.yaml", text: &text }];
    let parameters = resolve(&sources, "/", description.name, &(description.parameters)()).unwrap();
    let mut core = (description.build)(&NodeContext::default(), &parameters, &Shipped).unwrap();
    let mut told = |sequence: u64, noise: f64| {
        let frame = detections(sequence, |discs| discs.iter_mut().for_each(|disc| disc.u += noise));
        let out = send(core.as_mut(), sequence, &frame);
        (out.published::<TeamState>(0).len(), out.last::<DiagnosticArray>(2).map(|told| told.status[0].message.clone()))
    };
    let moving: usize = (1..=10).map(|sequence| told(sequence, 1e-6 * sequence as f64).0).sum();
    assert_eq!(moving, 10);
    let frozen: Vec<_> = (11..=16).map(|sequence| told(sequence, 0.5)).collect();
    let why = Some("dropped: the camera is frozen: its pictures are equal to the last bit".to_owned());
    let nothing = || (0, None);
    assert_eq!(frozen[..3], [(1, None), (1, None), (1, None)]);
    assert_eq!(frozen[3..], [(0, why), nothing(), nothing()], "said at once, and once");
    assert_eq!(told(17, 0.6).0, 1, "it goes on");
}

#[test]
fn identities_are_found_anew_on_request() {
    let mut core = build("    input: detections\n").unwrap();
    send(core.as_mut(), 1, &detections(1, |_| ()));
    let mut outbox = Outbox::default();
    let request = Event::Request { service: 0, id: RequestId(3), cdr: &TriggerRequest {}.to_cdr() };
    core.handle(Times::default(), request, &mut outbox);
    let expected = TriggerResponse { success: true, message: String::new() };
    match outbox.actions.as_slice() {
        [Action::Respond { service: 0, id: RequestId(3), cdr }] => {
            let response = <TriggerResponse as trench_msgs::Message>::decode(cdr).unwrap();
            assert_eq!(response.success, expected.success);
        }
        other => panic!("{other:?}"),
    }
    let state: TeamState = send(core.as_mut(), 2, &detections(2, |_| ())).last(0).unwrap();
    assert!(state.robots.iter().all(|robot| robot.status == RobotState::STATUS_TRACKED), "{state:?}");
}

#[test]
fn wrong_parameters_stop_the_node_before_it_works() {
    let check = |from: &str, to: &str, expected: &str| {
        let description = description();
        let text = PARAMETERS.replace(from, to);
        assert_ne!(text, PARAMETERS);
        let sources = [Given::File { name: "localizer.yaml", text: &text }];
        let parameters = resolve(&sources, "/", description.name, &(description.parameters)()).unwrap();
        let error = (description.build)(&NodeContext::default(), &parameters, &Shipped).err().unwrap().to_string();
        assert!(error.starts_with(expected), "{error}");
    };
    check(
        "[robot2, robot1]",
        "[robot1, robot1]",
        "localizer.yaml:3: robots = [\"robot1\", \"robot1\"]: robot1 is there twice; name each robot once",
    );
    check(
        "1.5, 1.2,",
        "1.5,",
        "localizer.yaml:4: initial_poses = [1.5, -2.0, 0.5, 0.5, 0.8]: has 5 numbers for 2 robots",
    );
    check(
        "    robots:",
        "    colour: {camera: west}\n    robots:",
        "localizer.yaml:3: colour.camera = \"west\": these are not the colours of the camera overhead",
    );
    check("file: overhead.yaml", "file: none.yaml", "camera_info_file = none.yaml: cannot be read");
    check("file: overhead_mount.yaml", "file: overhead.yaml", "overhead.yaml:3: mount: is missing");
    check("file: overhead.yaml", "file: \"\"", "localizer.yaml:5: camera_info_file = ");
}

#[test]
fn pads_with_codes_name_their_robots_and_others_go_by_where_they_were() {
    let mut core = build("    input: pads\n    pad_ids: [7, 4]\n").unwrap();
    assert_eq!(core.interface().subscriptions[0].topic, "/overhead/pads");
    let pad = |id: i32, pose: Pose2| PadMessage { id, x: pose.x, y: pose.y, theta: pose.theta, confidence: 1.0 };
    let mut send_pads = |sequence: u64, pads: Vec<PadMessage>| {
        let stamp = timing(sequence).0.into();
        send(core.as_mut(), sequence, &PadArray { header: Header { stamp, ..Header::default() }, pads }.to_cdr())
    };
    // `robots` are robot2, robot1: 7 is robot2's code. Not where they start, and one of another team.
    let places = [Pose2 { x: 2.0, y: 0.4, theta: 0.1 }, Pose2 { x: 0.3, y: 1.5, theta: 3.0 }];
    let seen = vec![pad(7, places[1]), pad(4, places[0]), pad(99, START[0])];
    let state: TeamState = send_pads(1, seen).last(0).unwrap();
    for (robot, place) in state.robots.iter().zip(places) {
        assert_eq!(robot.status, RobotState::STATUS_TRACKED, "{robot:?}");
        assert!((robot.x - place.x).hypot(robot.y - place.y) < 1e-9, "{robot:?}");
    }
    // A code that is not read goes by place; the rest of the robots keep theirs.
    let state: TeamState = send_pads(2, vec![pad(PadMessage::NO_ID, places[0]), pad(7, places[1])]).last(0).unwrap();
    assert!(state.robots.iter().all(|robot| robot.status == RobotState::STATUS_TRACKED), "{state:?}");
    for bad in [vec![pad(7, places[0]), pad(7, places[1])], vec![pad(7, Pose2 { x: f64::NAN, ..places[0] })]] {
        assert_eq!(send_pads(3, bad).published::<TeamState>(0), []);
    }
}
