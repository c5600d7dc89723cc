//! A controller of robot1 with a clock, driven by events.

use formation_controller::description;
use trench_config::params::{Source, resolve};
use trench_config::{ConfigError, Parameters};
use trench_core::{Event, Files, NodeContext, NodeCore, Outbox, RosTime, Source as From, Steady, Times};
use trench_formation::kinematics::{Pose, Twist};
use trench_msgs::Encode;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::msg::{
    ApparentObstacleArray, Assignment, Formation, Goal, Goals, LeaderState, Member, Point2, Queue, RobotState,
    RunState, Segment, TeamState,
};

struct NoFiles;

impl Files for NoFiles {
    fn read(&self, key: &str, _: &str) -> Result<String, ConfigError> {
        Err(Parameters::default().error(key, "no files here", "none needed"))
    }
}

/// All names that the parameter `law` may have.
pub(crate) const LAWS: [&str; 11] = [
    "robust",
    "nominal",
    "direct",
    "family",
    "goal",
    "goal_damped",
    "goal_at_rest",
    "zoned",
    "nearest",
    "chain",
    "queue",
];

/// The parameters of a controller with these overrides.
pub(crate) fn parameters(overrides: &[(&str, &str)]) -> Result<Parameters, String> {
    let sources: Vec<Source<'_>> =
        overrides.iter().map(|(name, value)| Source::Override { node: None, name, value }).collect();
    let node = description();
    resolve(&sources, "/robot1", node.name, &(node.parameters)())
        .map_err(|errors| errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
}

pub(crate) fn make(overrides: &[(&str, &str)]) -> Result<Box<dyn NodeCore>, String> {
    let (node, parameters) = (description(), parameters(overrides)?);
    let context = NodeContext { namespace: "/robot1".to_owned(), name: node.name.to_owned(), ..Default::default() };
    (node.build)(&context, &parameters, &NoFiles).map_err(|error| error.to_string())
}

/// A controller of robot1 with robot2 in its team, and a clock.
pub(crate) struct Bench {
    pub(crate) core: Box<dyn NodeCore>,
    pub(crate) out: Outbox,
    pub(crate) seconds: f64,
    /// By how much the ROS clock was set back, s.
    pub(crate) behind: f64,
    /// Where a robot is that does what it is told, and how it moves.
    pub(crate) pose: Pose,
    pub(crate) twist: Twist,
    /// What the mapper tells of.
    pub(crate) obstacles: ApparentObstacleArray,
    /// The goal point, m.
    pub(crate) goal: Point2,
    /// How it and the frame of the formation move, m/s.
    pub(crate) moves: Point2,
    /// Whom else the localizer sees.
    pub(crate) others: Vec<RobotState>,
}

/// Between two frames, s.
pub(crate) const PERIOD: f64 = 1.0 / 30.0;

impl Bench {
    pub(crate) fn new() -> Self {
        let core = make(&[("team", "[robot1, robot2]")]).unwrap();
        Self::of(core)
    }

    pub(crate) fn of(core: Box<dyn NodeCore>) -> Self {
        Self {
            core,
            out: Outbox::default(),
            seconds: 100.0,
            behind: 0.0,
            pose: Pose::new(1.0, 0.9, 0.0),
            twist: Twist::ZERO,
            obstacles: ApparentObstacleArray::default(),
            goal: Point2 { x: 1.5, y: 0.9 },
            moves: Point2::default(),
            others: Vec::new(),
        }
    }

    pub(crate) fn times(&self) -> Times {
        Times { ros: RosTime(0).plus_seconds(self.seconds - self.behind), steady: Steady(0).plus_seconds(self.seconds) }
    }

    pub(crate) fn send(&mut self, topic: &str, message: &dyn Encode) {
        self.send_bytes(topic, &message.to_cdr());
    }

    pub(crate) fn send_bytes(&mut self, topic: &str, cdr: &[u8]) {
        self.send_from([0; 16], topic, cdr);
    }

    /// A message of the writer `gid`.
    pub(crate) fn send_from(&mut self, gid: [u8; 16], topic: &str, cdr: &[u8]) {
        let port = self.core.interface().subscriptions.iter().position(|subscribe| subscribe.topic == topic).unwrap();
        let event = Event::Message { port, source: From { gid, sequence: 0 }, cdr, arrived: None };
        self.core.handle(self.times(), event, &mut self.out);
    }

    pub(crate) fn port(&self, topic: &str) -> usize {
        self.core.interface().publications.iter().position(|advertise| advertise.topic == topic).unwrap()
    }

    /// Everything a running controller hears, with the goal 0.5 m ahead of a robot that looks at it.
    pub(crate) fn running(&mut self) {
        self.running_without_goals();
        self.goals();
    }

    /// The same but for the goals.
    pub(crate) fn running_without_goals(&mut self) {
        self.send("/run_state", &RunState { state: RunState::RUNNING, ..Default::default() });
        self.obstacles.header.stamp = self.times().ros.into();
        let obstacles = self.obstacles.to_cdr();
        self.send_bytes("/apparent_obstacles", &obstacles);
    }

    fn goals(&mut self) {
        let position = self.goal;
        let goal =
            Goal { robot: "robot1".to_owned(), position, velocity: self.moves, remaining: 1e9, ..Default::default() };
        let ahead = Goal { robot: "robot2".to_owned(), position: Point2 { x: 1.9, y: 0.9 }, ..goal.clone() };
        let mut goals = Goals { goals: vec![goal, ahead], ..Default::default() };
        goals.frame.velocity = self.moves;
        goals.header.stamp = self.times().ros.into();
        self.send("/goals", &goals);
    }

    pub(crate) fn team(&self, status: u8, age: f64) -> TeamState {
        let robot = RobotState { name: "robot1".to_owned(), status, x: 1.0, y: 0.9, ..Default::default() };
        let robots = std::iter::once(robot).chain(self.others.iter().cloned()).collect();
        let mut team = TeamState { robots, ..Default::default() };
        team.header.stamp = self.times().ros.plus_seconds(-age).into();
        team
    }

    /// A robot that does what it is told, for so many frames.
    pub(crate) fn drive(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.running();
            let mut team = self.team(RobotState::STATUS_TRACKED, 0.0);
            let robot = &mut team.robots[0];
            (robot.x, robot.y, robot.theta) = (self.pose.x, self.pose.y, self.pose.theta);
            (robot.v, robot.omega) = (self.twist.v, self.twist.omega);
            let command = self.tick(&team).twist;
            self.twist = Twist { v: command.linear.x, omega: command.angular.z };
            self.pose = self.pose.advanced(self.twist, PERIOD);
            self.seconds += PERIOD;
        }
    }

    /// One frame: the command that comes of it.
    pub(crate) fn tick(&mut self, team: &TeamState) -> TwistStamped {
        self.send("/team_state", team);
        self.last_command()
    }

    pub(crate) fn last_command(&self) -> TwistStamped {
        self.out.last(self.port("/robot1/cmd_vel")).unwrap()
    }

    pub(crate) fn says(&self) -> String {
        let said: DiagnosticArray = self.out.last(self.port("/diagnostics")).unwrap();
        said.status.iter().map(|status| status.message.as_str()).collect::<Vec<_>>().join("; ")
    }
}

/// robot1 follows robot2 on the segment y = 0.9, in the frame of the map.
pub(crate) fn formation(bench: &mut Bench) {
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
}

/// robot2 stands 0.4 m ahead of where robot1 begins: in zone 4.
pub(crate) fn leader(bench: &mut Bench) {
    let mut state = LeaderState { epoch: 4, formation_hash: 7, rank: 1, ..Default::default() };
    state.header.stamp = bench.times().ros.into();
    state.point = Point2 { x: 1.4, y: 0.9 };
    bench.send("/robot2/leader_state", &state);
}
