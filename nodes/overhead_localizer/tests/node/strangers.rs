//! Two cameras that say to be the same one: the first is heard until it is silent, and the other is named.

use super::{START, Shipped, build, camera, detections_of, image, nameless};
use overhead_localizer::description;
use std::collections::BTreeMap;
use trench_config::ConfigError;
use trench_config::params::{Source as Given, resolve};
use trench_core::{Event, Files, NodeContext, NodeCore, Outbox, RosTime, Source, Steady, Times};
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
use trench_msgs::msg::{DiscArray, Pad as PadMessage, PadArray, RobotState, TeamState};
use trench_msgs::std_msgs::Header;
use trench_msgs::{Encode, Message};
use trench_optics::{Pad, Pose2};
use trench_sim::camera::{Appearance, Renderer};

/// Where a stranger says that the robots are: where they could be.
const AWAY: [Pose2; 2] = [Pose2 { x: 0.51, y: 0.5, theta: 0.8 }, Pose2 { x: 1.49, y: 1.2, theta: -2.0 }];
const OURS: u8 = 1;
const STRANGER: u8 = 2;

/// A core on the clocks of a host, and the last of all that it said of itself.
struct Bench {
    core: Box<dyn NodeCore>,
    /// Monotonic, ms.
    now: u64,
    /// Of the wall clock at monotonic zero, ms.
    wall: i64,
    told: Vec<DiagnosticStatus>,
    /// What each publisher has sent on each port.
    sent: BTreeMap<(usize, u8), u64>,
}

impl Bench {
    fn new(core: Box<dyn NodeCore>) -> Self {
        let mut bench = Self { core, now: 1000, wall: 100_000_000, told: Vec::new(), sent: BTreeMap::new() };
        bench.handle(Event::Started);
        bench
    }

    /// A stamp so many milliseconds ahead of now.
    fn stamp(&self, ahead: i64) -> RosTime {
        RosTime(1_000_000 * (self.wall + self.now as i64 + ahead))
    }

    fn handle(&mut self, event: Event<'_>) -> Vec<TeamState> {
        let mut outbox = Outbox::default();
        let at = Times { ros: self.stamp(0), steady: Steady(1_000_000 * self.now) };
        self.core.handle(at, event, &mut outbox);
        if let Some(report) = outbox.last::<DiagnosticArray>(2) {
            self.told = report.status;
        }
        outbox.published(0)
    }

    fn send(&mut self, port: usize, who: u8, cdr: &[u8]) -> Option<TeamState> {
        let sequence = self.sent.entry((port, who)).or_default();
        *sequence += 1;
        let source = Source { gid: [who; 16], sequence: *sequence };
        self.handle(Event::Message { port, source, cdr, arrived: None }).pop()
    }

    /// Detections of robots, stamped so many milliseconds ahead.
    fn see(&mut self, port: usize, who: u8, ahead: i64, robots: &[Pose2]) -> Option<TeamState> {
        let mut discs = DiscArray::decode(&detections_of(robots, 1, |_| ())).unwrap();
        discs.header.stamp = self.stamp(ahead).into();
        self.send(port, who, &discs.to_cdr())
    }

    /// As time goes by.
    fn pass(&mut self, milliseconds: u64) {
        self.now += milliseconds;
        if self.core.next_wakeup().is_some_and(|due| due.0 <= 1_000_000 * self.now) {
            self.handle(Event::Wakeup);
        }
    }

    fn part(&self, name: &str) -> (u8, &str) {
        let suffix = format!(": {name}");
        let part = self.told.iter().find(|status| status.name.ends_with(&suffix));
        part.map_or((255, ""), |status| (status.level, status.message.as_str()))
    }

    fn count(&self, key: &str) -> &str {
        let value = self.told.iter().flat_map(|status| &status.values).find(|value| value.key == key);
        value.map_or("", |value| value.value.as_str())
    }
}

/// That a frame of ours was taken, and moved no robot from its start.
fn check_is_ours(state: Option<TeamState>, what: &str) {
    assert!(state.is_some(), "{what}: nothing is said");
    let state = state.unwrap_or_default();
    for (robot, pose) in state.robots.iter().zip(START) {
        assert_eq!(robot.status, RobotState::STATUS_TRACKED, "{what}: {robot:?}");
        assert!((robot.x - pose.x).hypot(robot.y - pose.y) < 3e-4, "{what}: {robot:?}");
    }
}

const DETECTIONS: &str = "    input: detections\n";
const ANOTHER: &str = "was dropped: another publisher writes this topic; this one is heard once";

/// With stamps of now, of 0.9 s and 70 s later (once taken for a clock that was set), and of an hour before and after.
#[test]
fn a_second_camera_moves_nobody_and_is_named_whatever_it_stamps() {
    for ahead in [0, 900, 70_000, 3_600_000, -3_600_000] {
        let mut bench = Bench::new(build(DETECTIONS).unwrap());
        for frame in 0..60 {
            let state = bench.see(0, OURS, -35, &START);
            check_is_ours(state, &format!("{ahead} ms, frame {frame}"));
            bench.pass(10);
            assert_eq!(bench.see(0, STRANGER, ahead, &AWAY), None, "{ahead} ms, frame {frame}");
            bench.pass(30);
        }
        let (level, text) = bench.part("messages");
        assert!(level == 1 && text.starts_with(&format!("a message on /overhead/detections {ANOTHER}")), "{text}");
        assert_eq!(bench.part("camera"), (0, "frames arrive"), "the other one's frames are no fault of ours");
        assert!(bench.count("dropped").parse::<u32>().unwrap() > 50);
        assert_eq!((bench.count("frames out of order"), bench.count("frames dropped")), ("0", "0"));
        // It has gone.
        for _ in 0..150 {
            check_is_ours(bench.see(0, OURS, -35, &START), "alone");
            bench.pass(40);
        }
        assert_eq!(bench.part("messages"), (0, "none was dropped lately"));
    }
}

#[test]
fn the_second_camera_is_named_at_once_and_nothing_is_said_of_others_before() {
    let mut bench = Bench::new(build(DETECTIONS).unwrap());
    bench.see(0, OURS, -35, &START);
    bench.pass(40);
    assert_eq!(bench.part("messages").0, 255);
    bench.see(0, STRANGER, -35, &AWAY);
    assert_eq!(bench.part("messages").0, 1);
}

#[test]
fn when_the_camera_is_silent_for_half_a_second_another_takes_over() {
    let mut bench = Bench::new(build(DETECTIONS).unwrap());
    check_is_ours(bench.see(0, OURS, -35, &START), "ours");
    // Ours is silent from here on.
    let mut heard_after = 0;
    for _ in 0..20 {
        bench.pass(40);
        heard_after += 40;
        if bench.see(0, STRANGER, -35, &START).is_some() {
            break;
        }
    }
    assert_eq!(heard_after, 520, "ms");
    bench.pass(40);
    assert!(bench.see(0, STRANGER, -35, &START).is_some());
    assert_eq!(bench.see(0, OURS, -35, &START), None, "it is the second one now");
}

/// Who is from the future is not heard even where nobody else is, and keeps nobody from being heard.
#[test]
fn a_camera_from_the_future_takes_nobodys_place() {
    let mut bench = Bench::new(build(DETECTIONS).unwrap());
    let wait_with = |bench: &mut Bench, ahead: i64| {
        for _ in 0..20 {
            assert_eq!(bench.see(0, STRANGER, ahead, &AWAY), None, "{ahead} ms");
            bench.pass(40);
        }
    };
    for ahead in [900, 70_000] {
        wait_with(&mut bench, ahead);
        let (level, text) = bench.part("messages");
        let why = format!("a message on /overhead/detections was dropped: it is {}.", ahead / 1000);
        assert!(level == 1 && text.starts_with(&why) && text.ends_with(" s from the future"), "{text}");
        assert_eq!(bench.part("camera"), (2, "no frames"));
        for _ in 0..10 {
            check_is_ours(bench.see(0, OURS, -35, &START), "ours, at once");
            bench.pass(40);
        }
    }
}

/// What is no frame takes nobody's place either.
#[test]
fn nonsense_of_others_is_not_read_and_does_not_take_over() {
    let mut bench = Bench::new(build(DETECTIONS).unwrap());
    check_is_ours(bench.see(0, OURS, -35, &START), "ours");
    for _ in 0..20 {
        bench.pass(40);
        bench.send(0, STRANGER, &[0, 1, 0, 0, 9]);
    }
    assert_eq!(bench.part("camera").0, 2, "it is told of: nobody else is there");
    check_is_ours(bench.see(0, OURS, -35, &START), "ours, at once");
}

#[test]
fn a_clock_that_is_set_moves_nobody() {
    let mut bench = Bench::new(build(DETECTIONS).unwrap());
    for set in [0, 3_600_000, -7_200_000, 3_600_000] {
        // One frame is on its way while the clock is set; what is then from the future is lost.
        let on_its_way = bench.stamp(-5).seconds_since(RosTime(0));
        bench.wall += set;
        let ahead = 1e3 * (on_its_way - bench.stamp(0).seconds_since(RosTime(0)));
        let taken = bench.see(0, OURS, ahead.round() as i64, &START);
        assert_eq!(taken.is_some(), set >= 0, "{set} ms");
        for frame in 0..30 {
            bench.pass(33);
            check_is_ours(bench.see(0, OURS, -35, &START), &format!("{set} ms, frame {frame}"));
            bench.pass(7);
            assert_eq!(bench.see(0, STRANGER, 0, &AWAY), None, "{set} ms, frame {frame}");
        }
        assert_eq!(bench.count("frames out of order"), "0");
    }
}

#[test]
fn a_second_camera_s_pictures_and_a_second_system_s_pads_move_nobody() {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, Appearance::default());
    let mut bench = Bench::new(build("").unwrap());
    for frame in 0..5 {
        let ours = image(&renderer, &START, bench.stamp(-35)).to_cdr();
        check_is_ours(bench.send(0, OURS, &ours), &format!("picture {frame}"));
        bench.pass(20);
        let (seen, mut black) = (image(&renderer, &AWAY, bench.stamp(0)), image(&renderer, &[], bench.stamp(0)));
        black.data.fill(0);
        for others in [seen, black] {
            assert_eq!(bench.send(0, STRANGER, &others.to_cdr()), None);
        }
        bench.pass(20);
    }
    assert!(bench.part("messages").1.starts_with(&format!("a message on /overhead/image_raw {ANOTHER}")));

    let mut bench = Bench::new(build("    input: pads\n    pad_ids: [2, 1]\n").unwrap());
    let pads = |bench: &Bench, robots: &[Pose2], ahead: i64| {
        let pad =
            |(id, pose): (i32, &Pose2)| PadMessage { id, x: pose.x, y: pose.y, theta: pose.theta, confidence: 1.0 };
        let header = Header { stamp: bench.stamp(ahead).into(), ..Header::default() };
        PadArray { header, pads: (1..).zip(robots).map(pad).collect() }.to_cdr()
    };
    for frame in 0..5 {
        let ours = pads(&bench, &START, -35);
        check_is_ours(bench.send(0, OURS, &ours), &format!("pads {frame}"));
        bench.pass(40);
        for ahead in [0, 900, 70_000] {
            let others = pads(&bench, &AWAY, ahead);
            assert_eq!(bench.send(0, STRANGER, &others), None);
        }
    }
}

/// A robot that nobody has named yet is not named by a stranger's frames.
#[test]
fn names_are_given_by_the_camera_s_frames_alone() {
    let mut bench = Bench::new(nameless("order"));
    for _ in 0..10 {
        bench.see(0, OURS, -35, &[]);
        // Names go by three frames in which all are seen.
        for _ in 0..4 {
            bench.pass(10);
            bench.see(0, STRANGER, -5, &START);
        }
    }
    let state = bench.see(0, OURS, -35, &[]).unwrap();
    assert!(state.robots.iter().all(|robot| robot.status == RobotState::STATUS_LOST), "{state:?}");
}

/// Two cameras: the one that the others use, and one to its east.
struct Two;

impl Files for Two {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        let text = Shipped.read(key, path)?;
        let second =
            "mounts:\n- {camera: west, position: [1.24, 0.915, 3.0]}\n- {camera: east, position: [2.84, 0.915, 3.0]}\n";
        Ok(if path == "overhead_mount.yaml" { second.to_owned() } else { text })
    }
}

/// Nobody is on the east camera's topic but a stranger, who becomes its master.
#[test]
fn one_of_several_cameras_whose_clock_is_wrong_does_not_move_the_others_time() {
    let description = description();
    let text = format!("{}{DETECTIONS}", super::PARAMETERS);
    let sources = [Given::File { name: "localizer.yaml", text: &text }];
    let parameters = resolve(&sources, "/", description.name, &(description.parameters)()).unwrap();
    for ahead in [900, 70_000, -1_500, -70_000] {
        let core = (description.build)(&NodeContext::default(), &parameters, &Two).unwrap();
        let mut bench = Bench::new(core);
        let mut stamps = Vec::new();
        for frame in 0..40 {
            let exposed = bench.stamp(-35);
            stamps.extend(bench.see(0, OURS, -35, &START));
            bench.pass(5);
            stamps.extend(bench.see(1, STRANGER, ahead, &AWAY));
            // The other camera is waited for.
            for _ in 0..3 {
                bench.now += 5;
                stamps.extend(bench.handle(Event::Wakeup));
            }
            let said: Vec<RosTime> = stamps.drain(..).map(|state| RosTime::from(&state.header.stamp)).collect();
            assert_eq!(said, [exposed], "{ahead} ms, frame {frame}");
            bench.pass(20);
        }
        // The west camera has one publisher, and a second one.
        assert_eq!(bench.see(0, STRANGER, 0, &AWAY), None);
        let text = bench.part("messages").1;
        assert!(text.starts_with(&format!("a message on /overhead/west/detections {ANOTHER}")), "{text}");
    }
}
