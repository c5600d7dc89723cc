//! The controller as its neighbours see it: messages in, messages out.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use formation_controller::description;
use trench_config::params::{Source, resolve};
use trench_config::{ConfigError, Parameters};
use trench_core::{Event, Files, NodeContext, NodeCore, Outbox, RosTime, Source as From, Steady, Times};
use trench_msgs::Encode;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::msg::{
    ApparentObstacleArray, Assignment, Formation, Goal, Goals, LeaderState, LinkStatus, Member, Point2, Queue,
    RobotState, RunState, Segment, TeamState,
};
use trench_msgs::std_msgs::Bool;

struct NoFiles;

impl Files for NoFiles {
    fn read(&self, key: &str, _: &str) -> Result<String, ConfigError> {
        Err(Parameters::default().error(key, "no files here", "none needed"))
    }
}

fn make(overrides: &[(&str, &str)]) -> Result<Box<dyn NodeCore>, String> {
    let sources: Vec<Source<'_>> =
        overrides.iter().map(|(name, value)| Source::Override { node: None, name, value }).collect();
    let node = description();
    let parameters = resolve(&sources, "/robot1", node.name, &(node.parameters)())
        .map_err(|errors| errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))?;
    let context = NodeContext { namespace: "/robot1".to_owned(), name: node.name.to_owned(), ..Default::default() };
    (node.build)(&context, &parameters, &NoFiles).map_err(|error| error.to_string())
}

/// A controller of robot1 with robot2 in its team, and a clock.
struct Bench {
    core: Box<dyn NodeCore>,
    out: Outbox,
    seconds: f64,
}

impl Bench {
    fn new() -> Self {
        let core = make(&[("team", "[robot1, robot2]")]).unwrap();
        Self { core, out: Outbox::default(), seconds: 100.0 }
    }

    fn times(&self) -> Times {
        Times { ros: RosTime(0).plus_seconds(self.seconds), steady: Steady(0).plus_seconds(self.seconds) }
    }

    fn send(&mut self, topic: &str, message: &dyn Encode) {
        self.send_bytes(topic, &message.to_cdr());
    }

    fn send_bytes(&mut self, topic: &str, cdr: &[u8]) {
        let port = self.core.interface().subscriptions.iter().position(|subscribe| subscribe.topic == topic).unwrap();
        let event = Event::Message { port, source: From::default(), cdr };
        self.core.handle(self.times(), event, &mut self.out);
    }

    fn port(&self, topic: &str) -> usize {
        self.core.interface().publications.iter().position(|advertise| advertise.topic == topic).unwrap()
    }

    /// Everything a running controller hears, with the goal 0.5 m ahead of a robot that looks at it.
    fn running(&mut self) {
        self.send("/run_state", &RunState { state: RunState::RUNNING, ..Default::default() });
        self.send("/apparent_obstacles", &ApparentObstacleArray::default());
        let goal = Goal {
            robot: "robot1".to_owned(),
            position: Point2 { x: 1.5, y: 0.9 },
            remaining: 1e9,
            ..Default::default()
        };
        let mut goals = Goals { goals: vec![goal], ..Default::default() };
        goals.header.stamp = self.times().ros.into();
        self.send("/goals", &goals);
    }

    fn team(&self, status: u8, age: f64) -> TeamState {
        let robot = RobotState { name: "robot1".to_owned(), status, x: 1.0, y: 0.9, ..Default::default() };
        let mut team = TeamState { robots: vec![robot], ..Default::default() };
        team.header.stamp = self.times().ros.plus_seconds(-age).into();
        team
    }

    /// One frame: the command that comes of it.
    fn tick(&mut self, team: &TeamState) -> TwistStamped {
        self.send("/team_state", team);
        self.last_command()
    }

    fn last_command(&self) -> TwistStamped {
        self.out.last(self.port("/robot1/cmd_vel")).unwrap()
    }

    fn says(&self) -> String {
        let said: DiagnosticArray = self.out.last(self.port("/diagnostics")).unwrap();
        said.status.iter().map(|status| status.message.as_str()).collect::<Vec<_>>().join("; ")
    }
}

#[test]
fn drives_ahead_as_fast_as_the_steppers_start() {
    let mut bench = Bench::new();
    bench.running();
    let command = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.035));
    assert!((command.twist.linear.x - 0.08).abs() < 1e-9, "pull-in speed: {command:?}");
    assert!(command.twist.angular.z.abs() < 1e-9);
    let state: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
    assert_eq!(state.robot, "robot1");
    assert!((state.goal_distance - 0.5).abs() < 1e-6 && state.lyapunov_rate < 0.0, "{state:?}");
    assert_eq!(state.limited_by, LeaderState::LIMIT_WHEELS | LeaderState::LIMIT_RAMP);
}

#[test]
fn rests_unless_everything_is_there() {
    let rests = |prepare: &dyn Fn(&mut Bench) -> TeamState, reason: &str| {
        let mut bench = Bench::new();
        bench.running();
        let team = prepare(&mut bench);
        let command = bench.tick(&team);
        assert_eq!((command.twist.linear.x, command.twist.angular.z), (0.0, 0.0), "{reason}");
    };
    let tracked = RobotState::STATUS_TRACKED;
    rests(
        &|bench| {
            bench.send("/run_state", &RunState { state: RunState::ARMED, ..Default::default() });
            bench.team(tracked, 0.0)
        },
        "armed is not running",
    );
    rests(&|bench| bench.team(RobotState::STATUS_LOST, 0.0), "lost");
    rests(&|bench| bench.team(RobotState::STATUS_AMBIGUOUS, 0.0), "in doubt");
    rests(&|bench| bench.team(tracked, 0.2), "an old pose");
    rests(&|bench| bench.team(tracked, -0.2), "a pose from the future");
    rests(&|_| TeamState::default(), "no pose at all");
    rests(
        &|bench| {
            bench.seconds += 0.6;
            bench.team(tracked, 0.0)
        },
        "old goals and obstacles",
    );
    rests(
        &|bench| {
            bench.send("/emergency_stop", &Bool { data: true });
            bench.team(tracked, 0.0)
        },
        "emergency stop",
    );
}

#[test]
fn the_reason_is_on_diagnostics() {
    let mut bench = Bench::new();
    bench.running();
    bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
    bench.tick(&bench.team(RobotState::STATUS_LOST, 0.0));
    assert_eq!(bench.says(), "resting: the localizer has lost the robot");
}

#[test]
fn an_emergency_stop_does_not_wait_for_the_next_frame() {
    let mut bench = Bench::new();
    bench.running();
    bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
    bench.out.take();
    bench.send("/emergency_stop", &Bool { data: true });
    assert_eq!(bench.last_command().twist.linear.x, 0.0);
}

#[test]
fn silence_stops_the_robot() {
    let mut bench = Bench::new();
    bench.running();
    assert!(bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.03)).twist.linear.x > 0.0);
    let mut commands = Vec::new();
    for _ in 0..4 {
        let due = bench.core.next_wakeup().unwrap();
        bench.seconds = due.0 as f64 * 1e-9;
        bench.core.handle(bench.times(), Event::Wakeup, &mut bench.out);
        commands.push(bench.last_command().twist.linear.x);
    }
    assert!(commands[0] > 0.0, "one lost frame does not stop a robot: {commands:?}");
    assert_eq!(commands[1..], [0.0, 0.0, 0.0], "a pose older than 0.12 s does: {commands:?}");
}

#[test]
fn numbers_that_are_none_never_reach_the_wheels() {
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e308] {
        for field in 0..5 {
            let mut bench = Bench::new();
            bench.running();
            let mut team = bench.team(RobotState::STATUS_TRACKED, 0.0);
            let robot = &mut team.robots[0];
            *[&mut robot.x, &mut robot.y, &mut robot.theta, &mut robot.v, &mut robot.omega][field] = bad;
            let command = bench.tick(&team).twist;
            assert!(command.linear.x.is_finite() && command.angular.z.is_finite(), "{bad} in field {field}");
            assert!(command.linear.x.abs() <= 0.3);
        }
    }
}

#[test]
fn garbage_is_counted_and_dropped() {
    let mut bench = Bench::new();
    bench.running();
    bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
    for garbage in [&[][..], &[0, 1], &[0xff; 64], &[0, 1, 0, 0, 0xff, 0xff, 0xff, 0xff]] {
        bench.send_bytes("/team_state", garbage);
        bench.send_bytes("/robot2/leader_state", garbage);
    }
    assert!(bench.says().contains("was dropped"), "{}", bench.says());
    let again = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
    assert!(again.twist.linear.x > 0.0, "the last good messages are still in force");
}

#[test]
fn gains_outside_the_stable_zone_are_refused_with_the_equation() {
    let refused = |overrides| make(overrides).map(drop).unwrap_err();
    let error = refused(&[("gains.k1", "0.1"), ("gains.k2", "1.0"), ("gains.k3", "9.0")]);
    assert!(error.contains("gains.k3 = 9"), "{error}");
    assert!(error.contains("K3 < K1 + 2 c1 K2") && error.contains("4.3.1"), "{error}");
    assert!(refused(&[("gains.k2", "-1.0")]).contains("K2 > 0"));
    assert!(make(&[("gains.k3", "50.0"), ("refuse_unstable_gains", "false")]).is_ok());
}

#[test]
fn a_refused_change_leaves_the_old_gains_in_force() {
    let mut bench = Bench::new();
    let node = description();
    let change = Source::Override { node: None, name: "gains.k2", value: "-3.0" };
    let parameters = resolve(&[change], "/robot1", node.name, &(node.parameters)()).unwrap();
    assert!(bench.core.set_parameters(&parameters).is_err());
    bench.running();
    assert!(bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0)).twist.linear.x > 0.0);
}

#[test]
fn what_is_carried_forward_drives_nobody_for_long() {
    let driven = |unseen: u32| {
        let mut bench = Bench::new();
        bench.running();
        let mut team = bench.team(RobotState::STATUS_PREDICTED, 0.04);
        team.robots[0].unseen.nanosec = unseen;
        let command = bench.tick(&team);
        let age = RosTime(0).plus_seconds(100.0).seconds_since(RosTime::from(&command.header.stamp));
        (command.twist.linear.x > 0.0, (1e3 * age).round())
    };
    assert_eq!(driven(0), (true, 40.0));
    assert_eq!(driven(200_000_000), (true, 240.0));
    assert_eq!(driven(220_000_000), (false, 260.0));
}

/// robot1 follows robot2 in a chain on the segment y = 0.9, in the frame of the map.
fn follower() -> Bench {
    let core = make(&[("team", "[robot1, robot2]"), ("law", "chain")]).unwrap();
    let mut bench = Bench { core, out: Outbox::default(), seconds: 100.0 };
    bench.running();
    let point = |x| Point2 { x, y: 0.9 };
    let segment = Segment { points: vec![point(0.0), point(3.0)], ..Default::default() };
    let queue = Queue { segment, vertices: vec![point(3.0)], share: 1.0, ..Default::default() };
    bench.send("/formation", &Formation { hash: 7, queues: vec![queue], ..Default::default() });
    let member = |robot: &str, rank, leader: &str| Member {
        robot: robot.to_owned(),
        rank,
        leader: leader.to_owned(),
        ..Default::default()
    };
    let members = vec![member("robot2", 1, ""), member("robot1", 2, "robot2")];
    bench.send("/assignment", &Assignment { epoch: 4, formation_hash: 7, members, ..Default::default() });
    bench
}

fn leader_at(bench: &Bench, x: f64, epoch: u64) -> LeaderState {
    let mut state = LeaderState { epoch, formation_hash: 7, rank: 1, ..Default::default() };
    state.header.stamp = bench.times().ros.plus_seconds(-0.035).into();
    state.point = Point2 { x, y: 0.9 };
    state
}

#[test]
fn a_follower_goes_after_its_leader_and_rests_when_that_is_silent() {
    let mut bench = follower();
    let fastest = bench.drive(30, Some(1.9));
    assert!(fastest > 0.05, "{fastest}");
    bench.drive(30, None);
    assert_eq!(bench.last_command().twist.linear.x, 0.0);
    assert!(bench.says().contains("robot2, ahead in the chain, is silent"), "{}", bench.says());
}

impl Bench {
    /// So many ticks of a follower, with its leader at `leader` (m along the segment) if it speaks; gives the highest speed.
    fn drive(&mut self, ticks: u32, leader: Option<f64>) -> f64 {
        let mut fastest = 0.0_f64;
        for _ in 0..ticks {
            self.running();
            if let Some(x) = leader {
                self.send("/robot2/leader_state", &leader_at(self, x, 4));
            }
            let v = self.tick(&self.team(RobotState::STATUS_TRACKED, 0.0)).twist.linear.x;
            fastest = fastest.max(v);
            self.seconds += 1.0 / 30.0;
        }
        fastest
    }
}

#[test]
fn a_follower_that_hears_nobody_goes_along_the_segment_until_it_does() {
    let mut bench = follower();
    bench.drive(30, Some(1.9));
    bench.drive(75, None);
    assert!(bench.last_command().twist.linear.x > 0.1, "as fast as it may: {:?}", bench.last_command());
    assert!(bench.says().contains("hears nobody of its queue"), "{}", bench.says());
    bench.drive(18, Some(1.9));
    assert!(!bench.says().contains("hears nobody of its queue"), "{}", bench.says());
    let state: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
    assert_eq!(state.hears, ["robot2"]);
}

#[test]
fn a_follower_without_a_leader_is_drawn_to_its_goal() {
    let mut bench = follower();
    let member = |robot: &str, rank| Member { robot: robot.to_owned(), rank, ..Default::default() };
    let members = vec![member("robot2", 1), member("robot1", 2)];
    bench.send("/assignment", &Assignment { epoch: 5, formation_hash: 7, members, ..Default::default() });
    bench.drive(30, None);
    assert!(bench.last_command().twist.linear.x > 0.05, "{}", bench.says());
    let state: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
    assert!((state.goal.x - 1.5).abs() < 0.01, "{state:?}");
}

#[test]
fn leader_states_beyond_the_radio_s_reach_are_not_heard() {
    let mut bench = follower();
    let link = |hears: &[&str]| LinkStatus {
        up: true,
        hears: hears.iter().map(|name| (*name).to_owned()).collect(),
        ..Default::default()
    };
    for _ in 0..30 {
        bench.send("/robot1/link", &link(&["robot3"]));
        bench.drive(1, Some(1.9));
    }
    assert!(bench.says().contains("robot2, ahead in the chain, is silent"), "{}", bench.says());
    for _ in 0..30 {
        bench.send("/robot1/link", &link(&["robot2"]));
        bench.drive(1, Some(1.9));
    }
    assert!(bench.says().contains("driving"), "{}", bench.says());
    let core = make(&[("team", "[robot1, robot2]"), ("law", "chain"), ("team_link", "network")]).unwrap();
    let mut bench = Bench { core, out: Outbox::default(), seconds: 100.0 };
    bench.send("/robot1/link", &link(&[]));
    bench.drive(1, Some(1.9));
    let state: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
    assert_eq!(state.hears, ["robot2"], "on the robots' own hosts what comes is heard");
}

#[test]
fn a_second_publisher_waits_until_the_first_is_silent() {
    let mut bench = follower();
    bench.drive(10, Some(1.9));
    let mut team = bench.team(RobotState::STATUS_TRACKED, 0.0);
    team.robots[0].x = 0.3;
    let cdr = team.to_cdr();
    let port = bench.core.interface().subscriptions.iter().position(|topic| topic.topic == "/team_state").unwrap();
    let foreign = Event::Message { port, source: From { gid: [9; 16], sequence: 1 }, cdr: &cdr };
    bench.out.take();
    bench.core.handle(bench.times(), foreign, &mut bench.out);
    assert!(bench.out.published::<TwistStamped>(bench.port("/robot1/cmd_vel")).is_empty(), "no tick of its own");
    assert!(bench.says().contains("another publisher writes this topic"), "{}", bench.says());
}

#[test]
fn leader_states_of_another_epoch_or_time_do_not_count() {
    let refused = |spoil: &dyn Fn(&mut LeaderState), expected: &str| {
        let mut bench = follower();
        let mut state = leader_at(&bench, 1.9, 4);
        spoil(&mut state);
        bench.send("/robot2/leader_state", &state);
        let command = bench.tick(&bench.team(RobotState::STATUS_TRACKED, 0.0));
        assert_eq!(command.twist.linear.x, 0.0, "{expected}");
        assert!(bench.says().contains(expected), "{}", bench.says());
    };
    refused(&|state| state.epoch = 3, "it is of epoch 3, ours is 4");
    refused(&|state| state.formation_hash = 8, "of another formation");
    refused(&|state| state.header.stamp = RosTime(0).plus_seconds(105.0).into(), "from the future");
    refused(&|state| state.point.x = f64::NAN, "not finite");
}

#[test]
fn dynamic_laws_outside_the_theory_are_refused_with_their_equation() {
    let refused = |overrides: &[(&str, &str)]| make(overrides).map(drop).unwrap_err();
    assert!(refused(&[("law", "chain"), ("damping", "1.0")]).contains("(7.13) with k = 1 < 2"));
    assert!(refused(&[("law", "goal"), ("damping", "0.0")]).contains("(5.1) needs k > 0"));
    assert!(refused(&[("law", "chain"), ("zones.radii", "[0.3, 0.2, 0.4, 0.5, 1.0]")]).contains("6.2.2"));
    assert!(make(&[("law", "chain"), ("damping", "1.0"), ("refuse_unstable_gains", "false")]).is_ok());
}
