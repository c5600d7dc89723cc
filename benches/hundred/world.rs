//! Robots that do what they are told, and all that their controllers listen to.

use std::collections::BTreeMap;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Advertise, Event, Files, Interface, Local, NodeContext, NodeCore, NodeDescription, Qos, RosTime, Sink, StartError,
    Steady, Subscribe, Times,
};
use trench_formation::kinematics::{Pose, Twist};
use trench_msgs::Message;
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::msg::{ApparentObstacleArray, Goal, Goals, Point2, RobotState, RunState, TeamState};

pub(super) const DESCRIPTION: NodeDescription =
    NodeDescription { name: "hundred", about: "Drives many robots and counts their commands", parameters, build };

/// Between two frames, s.
const PERIOD: f64 = 1.0 / 30.0;
/// Frames that every controller must have answered before counting begins: by then all have found each other.
const SETTLED: usize = 30;
/// Given up without, s.
const PATIENCE: f64 = 120.0;
/// A robot that went no farther than this drove nowhere, m: its goal point goes 0.09 m in a second.
const STANDS: f64 = 0.05;
/// Clock ticks a second of /proc.
const TICKS: f64 = 100.0;

const TEAM_STATE: usize = 0;
const GOALS: usize = 1;
const RUN_STATE: usize = 2;
const OBSTACLES: usize = 3;

fn parameters() -> Vec<ParameterDescriptor> {
    use ParameterDescriptor as P;
    vec![
        P::integer("robots", 100, "how many").range(1.0, 1000.0).read_only(),
        P::double("seconds", 20.0, "s, for which commands are counted").range(1.0, 600.0).read_only(),
        P::integer("process", 0, "whose CPU is told").range(0.0, 1e9).read_only(),
    ]
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let robots = parameters.i64("robots")?;
    let commands =
        |robot: i64| Subscribe::to::<TwistStamped>(format!("/robot{robot}/cmd_vel"), Qos::RELIABLE).without_waking();
    let interface = Interface {
        subscriptions: (1..=robots).map(commands).collect(),
        publications: vec![
            Advertise::of::<TeamState>("/team_state", Qos::RELIABLE, Local::SharedMemory { max_len: 65_536 }),
            Advertise::of::<Goals>("/goals", Qos::RELIABLE, Local::SharedMemory { max_len: 65_536 }),
            Advertise::of::<RunState>("/run_state", Qos::LATCHED, Local::NetworkOnly),
            Advertise::of::<ApparentObstacleArray>(
                "/apparent_obstacles",
                Qos::RELIABLE,
                Local::SharedMemory { max_len: 1024 },
            ),
        ],
        ..Interface::default()
    };
    // Ten in a row, a metre apart: nobody is in anybody's way.
    let robot =
        |index: i64| Robot { pose: Pose::new((index % 10) as f64, (index / 10) as f64, 0.0), ..Robot::default() };
    Ok(Box::new(World {
        interface,
        robots: (0..robots).map(robot).collect(),
        frames: BTreeMap::new(),
        counted: (parameters.f64("seconds")? / PERIOD) as usize,
        process: parameters.i64("process")?,
        wakeup: None,
        from: None,
        cpu: 0.0,
    }))
}

#[derive(Default)]
struct Robot {
    pose: Pose,
    twist: Twist,
    /// Frames that its controller has answered, and commands without a new one.
    answered: Vec<usize>,
    again: usize,
    way: f64,
}

struct World {
    interface: Interface,
    robots: Vec<Robot>,
    /// Their numbers, by stamp.
    frames: BTreeMap<RosTime, usize>,
    counted: usize,
    process: i64,
    wakeup: Option<Steady>,
    /// The first frame that counts, and the CPU time then, s.
    from: Option<usize>,
    cpu: f64,
}

impl World {
    fn tick(&mut self, at: Times, sink: &mut dyn Sink) {
        let number = self.frames.len();
        self.frames.insert(at.ros, number);
        let stamp = || trench_msgs::std_msgs::Header { stamp: at.ros.into(), frame_id: "map".to_owned() };
        let elapsed = number as f64 * PERIOD;
        let (mut states, mut goals) = (Vec::new(), Vec::new());
        for (index, robot) in self.robots.iter_mut().enumerate() {
            robot.pose = robot.pose.advanced(robot.twist, PERIOD);
            robot.way += robot.twist.v.abs() * PERIOD;
            let name = format!("robot{}", index + 1);
            let Pose { x, y, theta } = robot.pose;
            let Twist { v, omega } = robot.twist;
            let status = RobotState::STATUS_TRACKED;
            states.push(RobotState { name: name.clone(), status, x, y, theta, v, omega, ..RobotState::default() });
            // Round a circle of 0.3 m at 0.09 m/s.
            let (sin, cos) = libm::sincos(0.3 * elapsed);
            let (home, way) = ([(index % 10) as f64, (index / 10) as f64], [0.3 * cos, 0.3 * sin]);
            goals.push(Goal {
                robot: name,
                phase: Goal::PHASE_MOVING,
                position: Point2 { x: home[0] + way[0], y: home[1] + way[1] },
                velocity: Point2 { x: -0.3 * way[1], y: 0.3 * way[0] },
                remaining: 1e9,
                ..Goal::default()
            });
        }
        goals.sort_by(|a, b| a.robot.cmp(&b.robot));
        sink.publish(OBSTACLES, &ApparentObstacleArray { header: stamp(), ..ApparentObstacleArray::default() });
        sink.publish(GOALS, &Goals { header: stamp(), goals, ..Goals::default() });
        let frame_number = number as u64;
        sink.publish(TEAM_STATE, &TeamState { header: stamp(), robots: states, frame_number, ..TeamState::default() });
    }

    /// Whether all is over.
    fn judge(&mut self, sink: &mut dyn Sink) -> bool {
        let number = self.frames.len();
        match self.from {
            None if self.robots.iter().all(|robot| robot.answered.len() >= SETTLED) => {
                self.from = Some(number);
                self.cpu = cpu(self.process);
                self.robots.iter_mut().for_each(|robot| (robot.again, robot.way) = (0, 0.0));
            }
            None if number as f64 * PERIOD > PATIENCE => {
                let silent = self.robots.iter().filter(|robot| robot.answered.len() < SETTLED).count();
                println!("{silent} of {} controllers never answered", self.robots.len());
                sink.exit(1);
                return true;
            }
            // Some frames more, for the last ones' answers.
            Some(from) if number >= from + self.counted + 6 => {
                let least = self.report(from);
                // Who stands is commanded, but does not drive.
                sink.exit(u8::from(least < STANDS));
                return true;
            }
            _ => {}
        }
        false
    }

    /// Says what came of it, and the shortest way of a robot, m.
    fn report(&self, from: usize) -> f64 {
        let counts = from..from + self.counted;
        let answered = |robot: &Robot| {
            let mut frames: Vec<usize> =
                robot.answered.iter().copied().filter(|frame| counts.contains(frame)).collect();
            frames.dedup();
            frames.len()
        };
        let all: Vec<usize> = self.robots.iter().map(answered).collect();
        let (least, sum) = (all.iter().min().copied().unwrap_or_default(), all.iter().sum::<usize>());
        let again: usize = self.robots.iter().map(|robot| robot.again).sum();
        let way = self.robots.iter().map(|robot| robot.way).fold(f64::INFINITY, f64::min);
        let seconds = (self.counted + 6) as f64 * PERIOD;
        let (robots, expected) = (all.len(), self.counted);
        println!(
            "{robots} controllers: {sum} of {} ticks answered, the worst {least} of {expected}; {again} commands besides",
            robots * expected
        );
        println!("each robot drove {way:.2} m and more");
        println!(
            "{:6.1} %  of a core: the process of all controllers",
            100.0 * (cpu(self.process) - self.cpu) / seconds
        );
        way
    }
}

/// CPU time of a process, s.
fn cpu(process: i64) -> f64 {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    let numbers = stat.rsplit(") ").next().unwrap_or_default().split_whitespace().skip(11).take(2);
    numbers.filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / TICKS
}

impl NodeCore for World {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Started => {
                self.wakeup = Some(at.steady);
                sink.publish(RUN_STATE, &RunState { state: RunState::RUNNING, ..RunState::default() });
            }
            Event::Message { port, cdr, .. } => {
                let Ok(command) = TwistStamped::decode(cdr) else { return };
                let (frame, robot) =
                    (self.frames.get(&RosTime::from(&command.header.stamp)), self.robots.get_mut(port));
                let (Some(frame), Some(robot)) = (frame, robot) else { return };
                if robot.answered.last() == Some(frame) {
                    robot.again += 1;
                } else {
                    robot.answered.push(*frame);
                }
                robot.twist = Twist { v: command.twist.linear.x, omega: command.twist.angular.z };
            }
            Event::Wakeup => {
                if self.judge(sink) {
                    self.wakeup = None;
                    return;
                }
                self.tick(at, sink);
                let next = self.wakeup.unwrap_or(at.steady).plus_seconds(PERIOD);
                // Who was held up does not catch up.
                self.wakeup = Some(next.max(at.steady.plus_seconds(0.5 * PERIOD)));
            }
            _ => {}
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.wakeup
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        Ok(())
    }
}
