//! A scenario's run as the messages of the nodes, so that viewers, rosbag2 and `trench plot` read its bags.

use super::super::sink::Sink;
use trench_core::{Qos, RosTime};
use trench_formation::Vector2;
use trench_formation::hull::{ApparentObstacle, Obstacle, Outline};
use trench_msgs::builtin_interfaces::Time;
use trench_msgs::geometry_msgs::{Point, Pose, Quaternion, Vector3};
use trench_msgs::msg::{
    ApparentObstacle as ObstacleMessage, ApparentObstacleArray, Assignment, Formation, Goal, Goals, LeaderState,
    Member, Obstacle as MemberMessage, Point2, Queue, RobotState, Segment, TeamState,
};
use trench_msgs::std_msgs::{ColorRGBA, Header, String as Text};
use trench_msgs::visualization_msgs::{Marker, MarkerArray};
use trench_scenario::{Sample, Scenario, Seat, Simulation, Task};

/// Bags begin a second after the epoch: stamp 0 means "no time" to many tools.
const BEGIN: i64 = 1_000_000_000;

/// Turns samples into messages.
pub(super) struct Publisher<'a> {
    scenario: &'a Scenario,
    seats: Vec<Seat>,
    /// The size of a robot's marker, m.
    size: f64,
}

impl<'a> Publisher<'a> {
    pub(super) fn new(scenario: &'a Scenario) -> Self {
        let size = scenario.zoning().map_or(0.05, |zoning| zoning.radii().rho_underbar);
        Self { scenario, seats: scenario.seats(), size }
    }

    /// What holds from the beginning: the file itself, formation and assignment.
    pub(super) fn begin(&self, text: &str, sink: &mut Sink) {
        sink.publish(BEGIN, "/scenario", Qos::LATCHED, &Text { data: text.to_owned() });
        sink.publish(BEGIN, "/formation", Qos::LATCHED, &self.formation());
        sink.publish(BEGIN, "/assignment", Qos::LATCHED, &self.assignment());
    }

    pub(super) fn publish(&self, simulation: &Simulation, samples: &[Sample], sink: &mut Sink) {
        let time = BEGIN + (simulation.time() * 1e9).round() as i64;
        let header = Header { stamp: Time::from(RosTime(time)), frame_id: "map".to_owned() };
        let seated = || self.seats.iter().zip(samples);
        let robots = seated().map(|(seat, sample)| RobotState {
            name: seat.name.clone(),
            status: RobotState::STATUS_TRACKED,
            x: sample.position.x,
            y: sample.position.y,
            theta: sample.heading,
            v: sample.speed,
            omega: sample.turn_rate,
            ..RobotState::default()
        });
        let team = TeamState { header: header.clone(), frame_number: 0, robots: robots.collect(), unnamed: Vec::new() };
        sink.publish(time, "/team_state", Qos::RELIABLE, &team);
        let goal = |(seat, sample): (&Seat, &Sample)| {
            Some(Goal { robot: seat.name.clone(), position: point(sample.goal?), ..Goal::default() })
        };
        let goals =
            Goals { header: header.clone(), epoch: 1, goals: seated().filter_map(goal).collect(), ..Goals::default() };
        sink.publish(time, "/goals", Qos::RELIABLE, &goals);
        for (seat, sample) in seated() {
            let topic = format!("/{}/leader_state", seat.name);
            sink.publish(time, &topic, Qos::RELIABLE, &self.leader_state(&header, seat, sample));
        }
        let (real, apparent) = simulation.known_obstacles().unwrap_or_default();
        if let Task::Nearest(chain, _) = &self.scenario.task {
            let obstacles = apparent.iter().map(obstacle).collect();
            let members = real.iter().map(member).collect();
            let array =
                ApparentObstacleArray { header: header.clone(), clearance: chain.clearance, obstacles, members };
            sink.publish(time, "/apparent_obstacles", Qos::RELIABLE, &array);
        }
        sink.publish(time, "/markers", Qos::RELIABLE, &self.markers(&header, samples, apparent));
    }

    fn leader_state(&self, header: &Header, seat: &Seat, sample: &Sample) -> LeaderState {
        let [lyapunov, lyapunov_rate] = sample.lyapunov.unwrap_or_default();
        LeaderState {
            header: header.clone(),
            robot: seat.name.clone(),
            epoch: 1,
            queue: seat.case as u32,
            rank: seat.rank as u32,
            position: point(sample.position),
            theta: sample.heading,
            velocity: point(sample.velocity),
            acceleration: point(sample.acceleration),
            goal: point(sample.goal.unwrap_or(sample.position)),
            goal_distance: sample.goal.map_or(0.0, |goal| (goal - sample.position).norm()),
            segment_distance: if sample.deviation.is_finite() { sample.deviation } else { 0.0 },
            conforms: sample.deviation <= self.scenario.tolerance,
            lyapunov,
            lyapunov_rate,
            ..LeaderState::default()
        }
    }

    fn formation(&self) -> Formation {
        let (segment, vertex) = match &self.scenario.task {
            Task::Directed(task) => {
                let (from, to) = task.curve.domain();
                let segment = trench_plan::message_from_shape(&task.segment, from.is_infinite(), to.is_infinite());
                (segment, Some(task.chain.team_goal))
            }
            Task::Nearest(chain, shape) => {
                let (from, to) = chain.segment.domain();
                (trench_plan::message_from_shape(shape, from.is_infinite(), to.is_infinite()), chain.team_goal)
            }
            Task::Queue(task) => {
                let (from, to) = task.queue.segment.domain();
                let segment = trench_plan::message_from_shape(&task.segment, from.is_infinite(), to.is_infinite());
                (segment, Some(task.queue.target))
            }
            Task::Regulating(task) => (Segment::default(), Some(task.goal)),
            Task::GoalTracking(_) | Task::Launch(_) => (Segment::default(), None),
        };
        let queue = |(_, label): (&str, &str)| Queue {
            name: label.to_owned(),
            segment: segment.clone(),
            vertices: vertex.map(point).into_iter().collect(),
            share: 1.0,
            tolerance: self.scenario.tolerance,
            ..Queue::default()
        };
        Formation {
            header: Header { stamp: Time::from(RosTime(BEGIN)), frame_id: "map".to_owned() },
            name: self.scenario.name.clone(),
            hash: 0,
            queues: self.scenario.cases().into_iter().map(queue).collect(),
        }
    }

    fn assignment(&self) -> Assignment {
        let member = |seat: &Seat| Member {
            robot: seat.name.clone(),
            queue: seat.case as u32,
            rank: seat.rank as u32,
            place: 0,
            leader: seat.leader.map_or(String::new(), |leader| self.seats[leader].name.clone()),
        };
        let header = Header { stamp: Time::from(RosTime(BEGIN)), frame_id: "map".to_owned() };
        Assignment { header, epoch: 1, formation_hash: 0, members: self.seats.iter().map(member).collect() }
    }

    fn markers(&self, header: &Header, samples: &[Sample], apparent: &[ApparentObstacle]) -> MarkerArray {
        let marker = |namespace: &str, kind: i32, width: f64, color: [f32; 3], points: Vec<Point>| Marker {
            header: header.clone(),
            ns: namespace.to_owned(),
            r#type: kind,
            action: Marker::ADD,
            pose: Pose { orientation: Quaternion { w: 1.0, ..Quaternion::default() }, ..Pose::default() },
            scale: Vector3 { x: width, y: width, z: width },
            color: ColorRGBA { r: color[0], g: color[1], b: color[2], a: 1.0 },
            points,
            ..Marker::default()
        };
        let level = |point: Vector2<f64>| Point { x: point.x, y: point.y, z: 0.0 };
        let places = samples.iter().map(|sample| level(sample.position)).collect();
        let mut markers = vec![marker("robots", Marker::SPHERE_LIST, self.size, [0.0, 0.45, 0.7], places)];
        let line = 0.1 * self.size;
        if let Task::Nearest(chain, shape) = &self.scenario.task {
            let points = trench_plan::sampled(shape, &chain.segment, 0.0).into_iter().map(level).collect();
            markers.push(marker("segment", Marker::LINE_STRIP, line, [0.4, 0.4, 0.4], points));
        }
        for (id, obstacle) in apparent.iter().enumerate() {
            let outline = rounded(&obstacle.shape.outline()).into_iter().map(level).collect();
            let drawn = marker("apparent_obstacles", Marker::LINE_STRIP, line, [0.8, 0.1, 0.1], outline);
            markers.push(Marker { id: id as i32, ..drawn });
        }
        MarkerArray { markers }
    }
}

fn obstacle(obstacle: &ApparentObstacle) -> ObstacleMessage {
    let outline = obstacle.shape.outline();
    ObstacleMessage {
        id: obstacle.id,
        hull: outline.points.iter().copied().map(point).collect(),
        radius: outline.radius,
        velocity: Point2::default(),
        members: obstacle.members.clone(),
    }
}

fn member(obstacle: &Obstacle) -> MemberMessage {
    let outline = obstacle.shape.outline();
    let polygon = outline.points.iter().copied().map(point).collect();
    MemberMessage { id: obstacle.id, polygon, radius: outline.radius, velocity: Point2::default() }
}

fn point(vector: Vector2<f64>) -> Point2 {
    Point2 { x: vector.x, y: vector.y }
}

/// The boundary of a convex polygon grown by its radius, closed.
fn rounded(outline: &Outline<'_>) -> Vec<Vector2<f64>> {
    crate::command::rounded::rounded(outline.points, outline.radius)
}
