//! The node as its neighbours see it: obstacles and scans in, apparent obstacles out.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[path = "cases/silence.rs"]
mod silence;

use obstacle_mapper::description;
use trench_config::params::{Source as Setting, resolve};
use trench_config::{ConfigError, Parameters};
use trench_core::{Event, Files, NodeContext, NodeCore, Outbox, RosTime, Source, Steady, Times};
use trench_msgs::Encode;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{ApparentObstacleArray, Obstacle, ObstacleArray, Point2, RobotState, TeamState};
use trench_msgs::sensor_msgs::LaserScan;
use trench_msgs::std_msgs::Header;
use trench_msgs::visualization_msgs::MarkerArray;

struct NoFiles;

impl Files for NoFiles {
    fn read(&self, key: &str, _: &str) -> Result<String, ConfigError> {
        Err(Parameters::default().error(key, "cannot be read", "name no file"))
    }
}

struct Bench {
    core: Box<dyn NodeCore>,
    out: Outbox,
    seconds: f64,
}

impl Bench {
    fn new(overrides: &[(&str, &str)]) -> Self {
        let settings: Vec<Setting<'_>> =
            overrides.iter().map(|(name, value)| Setting::Override { node: None, name, value }).collect();
        let node = description();
        let parameters = resolve(&settings, "/", node.name, &(node.parameters)()).unwrap();
        let context = NodeContext { namespace: "/".to_owned(), name: node.name.to_owned(), ..NodeContext::default() };
        let core = (node.build)(&context, &parameters, &NoFiles).unwrap();
        let mut bench = Self { core, out: Outbox::default(), seconds: 1000.0 };
        bench.handle(Event::Started);
        bench
    }

    fn now(&self) -> RosTime {
        RosTime(0).plus_seconds(self.seconds)
    }

    fn handle(&mut self, event: Event<'_>) {
        let at = Times { ros: self.now(), steady: Steady(0).plus_seconds(self.seconds) };
        self.core.handle(at, event, &mut self.out);
    }

    fn send(&mut self, topic: &str, gid: u8, cdr: &[u8]) {
        let port = self.core.interface().subscriptions.iter().position(|reader| reader.topic == topic).unwrap();
        self.handle(Event::Message { port, source: Source { gid: [gid; 16], sequence: 1 }, cdr, arrived: None });
    }

    fn header(&self) -> Header {
        Header { stamp: self.now().into(), ..Header::default() }
    }

    fn obstacles(&mut self, obstacles: Vec<Obstacle>) {
        let message = ObstacleArray { header: self.header(), obstacles };
        self.send("/obstacles", 1, &message.to_cdr());
    }

    /// Robots at places, heading along x.
    fn team(&mut self, places: &[[f64; 2]]) {
        let robot = |(index, [x, y]): (usize, &[f64; 2])| RobotState {
            name: format!("robot{}", index + 1),
            status: RobotState::STATUS_TRACKED,
            x: *x,
            y: *y,
            ..RobotState::default()
        };
        let robots = places.iter().enumerate().map(robot).collect();
        let message = TeamState { header: self.header(), robots, ..TeamState::default() };
        self.send("/team_state", 2, &message.to_cdr());
    }

    fn wake(&mut self) -> ApparentObstacleArray {
        self.handle(Event::Wakeup);
        self.out.last(0).unwrap()
    }

    fn condition(&self, part: &str) -> (u8, String) {
        let array: DiagnosticArray = self.out.last(2).unwrap();
        let status = array.status.iter().find(|status| status.name.ends_with(part)).unwrap();
        (status.level, status.message.clone())
    }
}

fn disc(id: u32, x: f64, speed: f64) -> Obstacle {
    Obstacle { id, polygon: vec![Point2 { x, y: 0.0 }], radius: 0.1, velocity: Point2 { x: speed, y: 0.0 } }
}

/// What a laser at `from` sees of a wall along x = 2, from y = -1 to 1, and of a robot's body.
fn scan(header: Header, from: [f64; 2], body: Option<[f64; 2]>) -> LaserScan {
    let rays = 360_u16;
    let range = |ray: u16| {
        let (sin, cos) = libm::sincos(f64::from(ray).to_radians());
        let wall = (2.0 - from[0]) / cos;
        let wall = if wall > 0.0 && (from[1] + wall * sin).abs() < 1.0 { wall } else { f64::INFINITY };
        let body = body.map_or(f64::INFINITY, |[x, y]| {
            let along = (x - from[0]) * cos + (y - from[1]) * sin;
            let beside = (x - from[0]) * sin - (y - from[1]) * cos;
            if along > 0.0 && beside.abs() < 0.08 { along - (0.0064 - beside * beside).sqrt() } else { f64::INFINITY }
        });
        wall.min(body) as f32
    };
    LaserScan {
        header,
        angle_increment: 1_f32.to_radians(),
        range_min: 0.1,
        range_max: 3.5,
        ranges: (0..rays).map(range).collect(),
        ..LaserScan::default()
    }
}

const TWO: (&str, &str) = ("robots", "[robot1, robot2]");

#[test]
fn near_ones_are_combined_and_move_as_the_fastest() {
    let mut bench = Bench::new(&[]);
    bench.obstacles(vec![disc(1, 0.0, 0.0), disc(2, 0.3, -0.2), disc(3, 2.0, 0.0)]);
    let combined: ApparentObstacleArray = bench.out.last(0).unwrap();
    assert_eq!(combined.obstacles.len(), 2);
    assert_eq!((&combined.obstacles[0].members[..], combined.obstacles[0].velocity.x), (&[1, 2][..], -0.2));
    assert_eq!(combined.obstacles[1].members, [3]);
    // Half a second later the second one is 0.1 m nearer to the first one.
    bench.seconds += 0.5;
    let later = bench.wake();
    assert!((later.obstacles[0].hull.iter().map(|point| point.x).fold(0.0, f64::max) - 0.2).abs() < 1e-9);
    let markers: MarkerArray = bench.out.last(1).unwrap();
    assert_eq!(markers.markers.len(), 2 + 3);
}

#[test]
fn it_speaks_ten_times_a_second_and_more_whatever_happens() {
    let mut bench = Bench::new(&[TWO]);
    for _ in 0..100 {
        let due = bench.core.next_wakeup().unwrap();
        assert!(due.seconds_since(Steady(0).plus_seconds(bench.seconds)) <= 0.1);
        bench.seconds = due.0 as f64 * 1e-9;
        assert_eq!(bench.wake().obstacles, []);
    }
}

#[test]
fn what_lasers_see_becomes_an_obstacle_with_one_identity() {
    let mut bench = Bench::new(&[TWO]);
    let places = [[0.5, 0.0], [1.2, 0.3]];
    let mut ids = Vec::new();
    for tick in 0..20_u8 {
        bench.seconds += 0.1;
        // Each robot sees the wall, and the other one's body, which is no obstacle.
        for (robot, other) in [(0, 1), (1, 0)] {
            let scan = scan(bench.header(), places[robot], Some(places[other]));
            bench.send(&format!("/robot{}/scan", robot + 1), 10 + robot as u8, &scan.to_cdr());
        }
        assert!(tick > 0 || bench.wake().obstacles.is_empty(), "poses at that time are not known yet");
        bench.team(&places);
        let known = bench.wake();
        assert_eq!(known.obstacles.len(), 1, "{known:?}");
        ids.push(known.obstacles[0].id);
    }
    assert!(ids.iter().all(|id| *id == ids[0]), "{ids:?}");
    let wall = bench.wake().obstacles.remove(0);
    let span = |axis: fn(&Point2) -> f64| {
        let values: Vec<f64> = wall.hull.iter().map(axis).collect();
        (values.iter().copied().fold(f64::MAX, f64::min), values.iter().copied().fold(f64::MIN, f64::max))
    };
    let ((left, right), (low, high)) = (span(|point| point.x), span(|point| point.y));
    assert!(left > 1.99 && right < 2.01 && low < -0.9 && high > 0.9, "{wall:?}");
    // The wall is carried away: rays pass where it was.
    for _ in 0..5 {
        bench.seconds += 0.1;
        let mut empty = scan(bench.header(), places[0], Some(places[1]));
        for range in &mut empty.ranges {
            *range = f32::INFINITY;
        }
        bench.send("/robot1/scan", 10, &empty.to_cdr());
        bench.team(&places);
    }
    assert_eq!(bench.wake().obstacles, []);
}

#[test]
fn what_two_robots_see_of_a_wall_becomes_one_obstacle() {
    let places = [[0.5, 0.0], [1.2, 0.3]];
    // robot1 sees the wall's right half, robot2 its left one, from its own place.
    let half = |bench: &Bench, robot: usize| {
        let mut half = scan(bench.header(), places[robot], None);
        for (ray, range) in half.ranges.iter_mut().enumerate() {
            let angle = if ray < 180 { ray as f64 } else { ray as f64 - 360.0 };
            let kept = if robot == 0 { angle <= 3.0 } else { angle >= -22.0 };
            if !kept {
                *range = f32::INFINITY;
            }
        }
        half.to_cdr()
    };
    let seen = |eyes: &[usize]| -> Vec<(f64, f64)> {
        let mut bench = Bench::new(&[TWO]);
        for _ in 0..5 {
            bench.seconds += 0.1;
            for robot in eyes {
                let scan = half(&bench, *robot);
                bench.send(&format!("/robot{}/scan", robot + 1), 10 + *robot as u8, &scan);
            }
            bench.team(&places);
        }
        let spans = bench.wake().obstacles.into_iter().map(|one| {
            let heights = one.hull.iter().map(|point| point.y);
            (heights.clone().fold(f64::MAX, f64::min), heights.fold(f64::MIN, f64::max))
        });
        spans.collect()
    };
    let [(low, high)] = seen(&[0])[..] else { panic!("robot1: {:?}", seen(&[0])) };
    assert!(low < -0.9 && high < 0.2, "{low} to {high}");
    let [(low, high)] = seen(&[1])[..] else { panic!("robot2: {:?}", seen(&[1])) };
    assert!(low > -0.2 && high > 0.9, "{low} to {high}");
    let [(low, high)] = seen(&[0, 1])[..] else { panic!("both: {:?}", seen(&[0, 1])) };
    assert!(low < -0.9 && high > 0.9, "{low} to {high}");
}

#[test]
fn what_nobody_sees_any_more_is_forgotten() {
    let mut bench = Bench::new(&[TWO, ("scan.memory", "1.0")]);
    bench.team(&[[0.5, 0.0], [0.5, 5.0]]);
    let seen = scan(bench.header(), [0.5, 0.0], None);
    bench.send("/robot1/scan", 10, &seen.to_cdr());
    assert_eq!(bench.wake().obstacles.len(), 1);
    bench.seconds += 0.95;
    assert_eq!(bench.wake().obstacles.len(), 1);
    bench.seconds += 0.1;
    assert_eq!(bench.wake().obstacles, []);
}

#[test]
fn a_lost_robots_body_is_an_obstacle_and_its_scan_is_not_used() {
    let mut bench = Bench::new(&[TWO]);
    bench.team(&[[0.5, 0.0]]);
    let seen = scan(bench.header(), [0.5, 0.0], Some([1.2, 0.0]));
    bench.send("/robot1/scan", 10, &seen.to_cdr());
    let blind = scan(bench.header(), [1.2, 0.0], None);
    bench.send("/robot2/scan", 11, &blind.to_cdr());
    let known = bench.wake();
    assert!(known.obstacles.iter().any(|one| one.hull.iter().all(|point| point.x < 1.3)), "{known:?}");
    let (level, message) = bench.condition("scans");
    assert!(level == 2 && message.contains("robot2"), "{level} {message}");
}

#[test]
fn bad_messages_are_told_of_and_good_ones_end_it() {
    let mut bench = Bench::new(&[TWO]);
    bench.obstacles(vec![Obstacle { radius: -1.0, ..disc(7, 0.0, 0.0) }, disc(8, 0.0, 0.0)]);
    let (level, message) = bench.condition("obstacles");
    assert!(level == 2 && message.contains("obstacle 7 is left out: the radius is -1"), "{message}");
    assert_eq!(bench.wake().obstacles.len(), 1);
    bench.seconds += 0.1;
    bench.obstacles(vec![disc(8, 0.0, 0.0)]);
    assert_eq!(bench.condition("obstacles").0, 0);
    bench.send("/obstacles", 1, &[0, 1, 0]);
    assert_eq!(bench.condition("obstacles").0, 2);

    bench.team(&[[0.5, 0.0], [0.5, 1.0]]);
    let mut bad = scan(bench.header(), [0.5, 0.0], None);
    bad.range_max = f32::NAN;
    bench.send("/robot1/scan", 10, &bad.to_cdr());
    assert!(bench.condition("scans").1.contains("a scan of robot1 was dropped: its limits are"));
    let mut early = scan(bench.header(), [0.5, 0.0], None);
    early.header.stamp = bench.now().plus_seconds(5.0).into();
    bench.send("/robot1/scan", 10, &early.to_cdr());
    let mut late = early;
    late.header.stamp = bench.now().plus_seconds(-5.0).into();
    bench.send("/robot2/scan", 11, &late.to_cdr());
    bench.seconds += 1.0;
    bench.wake();
    assert!(bench.condition("scans").1.contains("robot2"), "{:?}", bench.condition("scans"));
    assert_eq!(bench.wake().obstacles.len(), 1, "nothing of them is taken");
}

/// A second publisher of /team_state, as often as the first: the warning stays while it writes, ends after it, and says nothing of scans.
#[test]
fn a_stranger_on_team_state_is_told_of_steadily() {
    let mut bench = Bench::new(&[TWO]);
    let mut heard = |stranger: bool| {
        let mut levels = std::collections::BTreeSet::new();
        for tick in 0..60 {
            bench.seconds += 0.1;
            bench.team(&[[0.5, 0.0], [0.5, 1.0]]);
            let seen = scan(bench.header(), [0.5, 0.0], None);
            bench.send("/robot1/scan", 10, &seen.to_cdr());
            if stranger {
                bench.send("/team_state", 99, &TeamState::default().to_cdr());
            }
            bench.wake();
            // All parts are told once a second.
            if tick > 10 {
                assert_eq!(bench.condition("scans").0, 0, "{:?}", bench.condition("scans"));
                levels.insert(bench.condition("messages").0);
            }
        }
        (levels, bench.condition("messages").1)
    };
    assert_eq!(heard(false).0, [0].into());
    let (levels, text) = heard(true);
    assert_eq!(levels, [1].into(), "it does not flip");
    assert!(text.starts_with("a message on /team_state was dropped: another publisher writes this topic"), "{text}");
    assert_eq!(heard(false).1, "none was dropped lately");
}

/// A second laser of one robot sees walls where none are: by turns with the first, with stamps of now, of later and of long ago.
#[test]
fn a_second_laser_of_a_robot_is_named_and_adds_nothing_until_the_first_is_silent() {
    const ANOTHER: &str = "a message on /robot1/scan was dropped: another publisher writes this topic";
    let mut bench = Bench::new(&[TWO]);
    let places = [[0.5, 0.0], [0.5, 3.0]];
    // What robot1's lasers see, and how many hulls there are then.
    let mut hulls = |ours: bool, stranger: Option<f64>| {
        bench.seconds += 0.05;
        if ours {
            let mut empty = scan(bench.header(), places[0], None);
            empty.ranges.fill(f32::INFINITY);
            bench.send("/robot1/scan", 10, &empty.to_cdr());
        }
        if let Some(ahead) = stranger {
            let mut wall = scan(bench.header(), places[0], None);
            wall.header.stamp = bench.now().plus_seconds(ahead).into();
            bench.send("/robot1/scan", 99, &wall.to_cdr());
        }
        bench.team(&places);
        let hulls = bench.wake().obstacles.len();
        let told: DiagnosticArray = bench.out.last(2).unwrap();
        let of =
            |part: &str| told.status.iter().find(|status| status.name.ends_with(part)).map(|one| one.message.clone());
        (hulls, of(": messages").unwrap(), of(": scans"))
    };
    for ahead in [0.0, -0.04, 0.9, 70.0, -3600.0] {
        for tick in 0..40 {
            let (seen, messages, scans) = hulls(true, Some(ahead));
            assert_eq!(seen, 0, "{ahead} s, tick {tick}");
            assert!(messages.starts_with(ANOTHER), "{ahead} s, tick {tick}: {messages}");
            assert!(scans.is_none_or(|text| text == "scans are taken"), "{ahead} s, tick {tick}");
        }
    }
    // Ours is silent. A laser from the future does not take its place.
    for _ in 0..20 {
        assert_eq!(hulls(false, Some(0.9)).0, 0);
    }
    assert_eq!(hulls(false, None).2.unwrap(), "a scan of robot1 was dropped: its stamp is in the future");
    assert_eq!(hulls(true, None).0, 0, "ours, at once");
    let taken_over = (1..=20).find(|_| hulls(false, Some(0.0)).0 > 0);
    assert_eq!(taken_over, Some(11), "twentieths of a second");
}

/// Where robots were is not learnt from the future.
#[test]
fn a_team_state_from_the_future_is_named_and_hides_none_of_now() {
    let mut bench = Bench::new(&[TWO]);
    let places = [[0.5, 0.0], [0.5, 3.0]];
    let header = Header { stamp: bench.now().plus_seconds(0.9).into(), ..Header::default() };
    bench.send("/team_state", 99, &TeamState { header, ..TeamState::default() }.to_cdr());
    let (level, text) = bench.condition("messages");
    assert!(level == 1 && text == "a message on /team_state was dropped: its stamp is in the future", "{text}");
    bench.seconds += 0.05;
    let seen = scan(bench.header(), places[0], None);
    bench.send("/robot1/scan", 10, &seen.to_cdr());
    bench.team(&places);
    assert_eq!(bench.wake().obstacles.len(), 1);
}

/// A hull is called like the least of its members (ApparentObstacle.msg): it keeps its name whoever else comes and leaves, and so do
/// those beside it.
#[test]
fn hulls_keep_their_identities_while_members_come_and_leave() {
    let mut bench = Bench::new(&[]);
    let mut named = |obstacles: &[(u32, f64)]| {
        bench.seconds += 0.1;
        bench.obstacles(obstacles.iter().map(|(id, x)| disc(*id, *x, 0.0)).collect());
        let known: ApparentObstacleArray = bench.out.last(0).unwrap();
        known.obstacles.into_iter().map(|one| (one.id, one.members)).collect::<Vec<_>>()
    };
    let far = (9, 5.0);
    let alone = |members: &[u32]| vec![(4, members.to_vec()), (9, vec![9])];
    assert_eq!(named(&[(4, 0.0), (6, 0.3), far]), alone(&[4, 6]));
    assert_eq!(named(&[(7, 0.6), (4, 0.0), far, (6, 0.3)]), alone(&[4, 6, 7]), "another comes, in any order");
    // The one in the middle leaves: what is left of the hull keeps the name, the other part is called like itself.
    assert_eq!(named(&[(4, 0.0), (7, 0.6), far]), [(4, vec![4]), (7, vec![7]), (9, vec![9])]);
    assert_eq!(named(&[(4, 0.0), (6, 0.3), (7, 0.6), far]), alone(&[4, 6, 7]), "it comes back");
    assert_eq!(named(&[(4, 1.5), (6, 0.3), (7, 0.6), far]), [(4, vec![4]), (6, vec![6, 7]), (9, vec![9])]);
}

/// A crescent: its hull closes its mouth, and what lies in the mouth belongs to it.
#[test]
fn a_crescent_is_as_large_as_its_hull() {
    let arc = |radius: f64, index: u32| {
        let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(index) / 12.0);
        Point2 { x: radius * cos, y: radius * sin }
    };
    let polygon: Vec<Point2> =
        (0..=12).map(|index| arc(0.5, index)).chain((0..=12).rev().map(|index| arc(0.4, index))).collect();
    let crescent = Obstacle { id: 2, polygon, ..Obstacle::default() };
    let mut bench = Bench::new(&[]);
    let within = Obstacle { id: 3, polygon: vec![Point2 { x: 0.0, y: 0.15 }], radius: 0.05, ..Obstacle::default() };
    bench.obstacles(vec![crescent, within]);
    let known: ApparentObstacleArray = bench.out.last(0).unwrap();
    bench.seconds += 1.1;
    bench.wake();
    assert_eq!(bench.condition("obstacles").0, 0, "it is taken as it is");
    assert_eq!(known.obstacles.len(), 1, "{known:?}");
    let hull = &known.obstacles[0];
    assert_eq!((hull.id, &hull.members[..]), (2, &[2, 3][..]));
    let next = |index: usize| &hull.hull[(index + 1) % hull.hull.len()];
    let area: f64 = (0..hull.hull.len())
        .map(|index| 0.5 * (hull.hull[index].x * next(index).y - hull.hull[index].y * next(index).x))
        .sum();
    // The half of a polygon of 24 corners on a circle of 0.5 m: the mouth is closed from tip to tip.
    let half = 12.0 * 0.5 * 0.25 * libm::sin(std::f64::consts::PI / 12.0);
    assert!((area - half).abs() < 1e-9, "{area} {half}");
}

#[test]
fn obstacles_of_a_publisher_that_has_gone_are_forgotten() {
    let mut bench = Bench::new(&[]);
    bench.handle(Event::Matched { port: 0, writers: 1 });
    bench.obstacles(vec![disc(1, 0.0, 0.0)]);
    bench.seconds += 0.1;
    bench.obstacles(vec![disc(1, 0.0, 0.0)]);
    bench.seconds += 100.0;
    assert_eq!(bench.wake().obstacles.len(), 1, "it is connected and has nothing new to say");
    bench.handle(Event::Matched { port: 0, writers: 0 });
    assert_eq!(bench.wake().obstacles, []);
}
