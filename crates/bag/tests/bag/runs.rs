//! Runs read out of bags and tables, and judged.

use std::path::Path;
use trench_bag::run::{CsvError, GoalSample, Pose, Run, RunSummary, SummaryOptions, Track, summary};
use trench_bag::{BagReader, BagWriter, Stamp, WriteOptions};
use trench_core::{Qos, RosTime};
use trench_msgs::Message;
use trench_msgs::msg::{Assignment, Formation, Goal, Goals, Member, Point2, Queue, RobotState, RunState, TeamState};
use trench_msgs::nav_msgs::Odometry;

const T0: i64 = 1_700_000_000_000_000_000;

struct Recorder(BagWriter);

impl Recorder {
    fn create(path: &Path) -> Self {
        Self(BagWriter::create(path, WriteOptions { disk_reserve: 0, ..WriteOptions::default() }).unwrap())
    }

    fn write<M: Message>(&mut self, topic: &str, time: i64, message: &M) {
        let id = self.0.add_topic(topic, M::TYPE.into(), Qos::RELIABLE).unwrap();
        let stamp = Stamp { log_time: time as u64, publish_time: time as u64, sequence: 0 };
        self.0.write(id, stamp, &message.to_cdr()).unwrap();
    }
}

fn point(x: f64, y: f64) -> Point2 {
    Point2 { x, y }
}

/// Two robots drive 1 m along x at 0.1 m/s, 0.5 m apart; the second stops 0.03 m short. Their goals move at 0.1 m/s
/// from t = 2 s to 10 s. The localizer sees everything 5 mm off.
fn record(path: &Path) {
    let mut bag = Recorder::create(path);
    let mut formation = Formation::default();
    formation.header.frame_id = "map".to_owned();
    formation.queues = [0.0, 0.5].map(|y| Queue { vertices: vec![point(1.0, y)], ..Queue::default() }).to_vec();
    bag.write("/formation", T0 - 1000, &formation);
    let member =
        |index| Member { robot: format!("robot{}", index + 1), queue: index, rank: 1, place: 0, leader: String::new() };
    bag.write("/assignment", T0 - 900, &Assignment { members: vec![member(0), member(1)], ..Assignment::default() });
    bag.write("/run_state", T0 - 800, &RunState { state: RunState::RUNNING, ..RunState::default() });
    let running = RunState { state: RunState::RUNNING, t0: RosTime(T0).into(), ..RunState::default() };
    bag.write("/run_state", T0, &running);
    // Ten poses a second, the first before the run begins.
    for step in -5..=150_i64 {
        let time = T0 + step * 100_000_000;
        let t = step as f64 * 0.1;
        let mut team = TeamState::default();
        team.header.stamp = RosTime(time).into();
        for (index, stop) in [1.0, 0.97].into_iter().enumerate() {
            let (x, y) = ((0.1 * t).clamp(0.0, stop), 0.5 * index as f64);
            let mut odometry = Odometry::default();
            odometry.header.stamp = RosTime(time).into();
            odometry.pose.pose.position.x = x;
            odometry.pose.pose.position.y = y;
            odometry.pose.pose.orientation.w = 1.0;
            odometry.twist.twist.linear.x = if x > 0.0 && x < stop { 0.1 } else { 0.0 };
            bag.write(&format!("/ground_truth/robot{}/odom", index + 1), time, &odometry);
            let name = format!("robot{}", index + 1);
            let status = RobotState::STATUS_TRACKED;
            team.robots.push(RobotState { name, status, x: x + 0.005, y, ..RobotState::default() });
        }
        bag.write("/team_state", time, &team);
        let moving = (2.0..10.0).contains(&t);
        let goal = |index: usize| Goal {
            robot: format!("robot{}", index + 1),
            position: point((0.2 + 0.1 * (t - 2.0).max(0.0)).min(1.0), 0.5 * index as f64),
            velocity: point(if moving { 0.1 } else { 0.0 }, 0.0),
            remaining: if moving { 10.0 - t } else { 0.0 },
            ..Goal::default()
        };
        let mut goals = Goals { goals: vec![goal(0), goal(1)], ..Goals::default() };
        goals.header.stamp = RosTime(time).into();
        bag.write("/goals", time, &goals);
    }
    // Two messages that are not what they say.
    let id = bag.0.add_topic("/team_state", TeamState::TYPE.into(), Qos::RELIABLE).unwrap();
    for cdr in [&[0, 1, 0, 0, 1][..], &[]] {
        bag.0.write(id, Stamp { log_time: T0 as u64, ..Stamp::default() }, cdr).unwrap();
    }
    bag.0.finish().unwrap();
}

fn near(actual: f64, expected: f64) -> bool {
    (actual - expected).abs() < 1e-9
}

#[test]
fn a_run_is_judged_by_ground_truth() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    record(&path);
    let run = Run::from_bag(&BagReader::open(&path).unwrap()).unwrap();
    let options = SummaryOptions { shape_times: vec![5.0, 15.0, 60.0], ..SummaryOptions::default() };
    let RunSummary {
        t0, ground_truth, duration, motion, robots, shape, final_shape_error, closest, undecodable, ..
    } = summary(&run, &options);
    assert_eq!((t0, ground_truth, undecodable), (Some(T0), true, 2));
    assert!(near(duration, 15.0));
    let (first, last) = motion.unwrap();
    assert!(near(first, 2.0) && near(last, 9.9), "{motion:?}");
    assert_eq!(robots[1].vertex, Some([1.0, 0.5]));
    assert!(near(robots[0].final_distance.unwrap(), 0.0) && near(robots[1].final_distance.unwrap(), 0.03));
    assert!(near(robots[0].max_speed, 0.1));
    // At 5 s both are at x = 0.5; in the end one is 0.03 m behind, and 60 s the run never reached.
    let expected_final = 0.03_f64.hypot(0.5) - 0.5;
    assert_eq!(shape.len(), 2);
    assert!(near(shape[0].error, 0.0) && near(shape[1].error, expected_final), "{shape:?}");
    assert!(near(final_shape_error.unwrap(), expected_final));
    let closest = closest.unwrap();
    assert!(near(closest.gap, 0.5 - 0.16));
    assert_eq!(closest.robots, ["robot1", "robot2"].map(str::to_owned));
}

#[test]
fn the_largest_shape_error_is_that_of_its_interval() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    record(&path);
    let run = Run::from_bag(&BagReader::open(&path).unwrap()).unwrap();
    let largest = |interval| summary(&run, &SummaryOptions { interval, ..SummaryOptions::default() }).max_shape_error;
    assert!(near(largest(Some((0.0, 9.0))).unwrap(), 0.0));
    // By default from two thirds of the goals' motion to the end.
    assert!(near(largest(None).unwrap(), 0.03_f64.hypot(0.5) - 0.5));
    assert_eq!(largest(Some((100.0, 200.0))), None);
}

#[test]
fn without_ground_truth_the_localizer_is_believed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let mut bag = Recorder::create(&path);
    let status = [RobotState::STATUS_TRACKED, RobotState::STATUS_LOST];
    let robots = status.map(|status| RobotState { name: format!("robot{status}"), status, ..RobotState::default() });
    bag.write("/team_state", T0, &TeamState { robots: robots.to_vec(), ..TeamState::default() });
    bag.0.finish().unwrap();
    let run = Run::from_bag(&BagReader::open(&path).unwrap()).unwrap();
    assert!(!run.is_ground_truth);
    // A lost robot's pose is old: it is no evidence.
    assert_eq!(run.robots.keys().collect::<Vec<_>>(), ["robot1"]);
    assert_eq!(summary(&run, &SummaryOptions::default()).closest, None);
}

#[test]
fn tables_are_read() {
    let table = "t,robot,x,y,theta,v,omega,goal_x,goal_y\n0,a,0,0,3.1,0.1,0,1,0\n1,a,0.1,0,-3.1,0.1,0,1.5,0\n2,a,0.2,0,-3.1,0,0,1.5,0\n";
    let run = Run::from_csv(table).unwrap();
    let track = &run.robots["a"];
    assert_eq!(track.poses.len(), 3);
    // Halfway from 3.1 to -3.1 rad is pi, not 0.
    let halfway = track.pose_at(0.5).unwrap();
    assert!((halfway.theta.abs() - std::f64::consts::PI).abs() < 1e-9 && near(halfway.x, 0.05), "{halfway:?}");
    assert_eq!(run.vertex("a"), Some([1.5, 0.0]));
    assert_eq!(run.motion(), Some((0.0, 0.0)));
}

#[test]
fn wrong_tables_are_refused_with_their_line() {
    let check = |text: &str, expected: CsvError| assert_eq!(Run::from_csv(text), Err(expected));
    check("", CsvError::Column("robot"));
    check("robot,t,x,y,theta,v,goal_x,goal_y\n", CsvError::Column("omega"));
    let header = "t,robot,x,y,theta,v,omega,goal_x,goal_y\n";
    let number = |line, column, value: &str| CsvError::Number { line, column, value: value.to_owned() };
    check(&format!("{header}0,a,0,0,0,0,0,,\n1,a,zero,0,0,0,0,,\n"), number(3, "x", "zero"));
    check(&format!("{header}0,a,0,NaN,0,0,0,,\n"), number(2, "y", "NaN"));
    check(&format!("{header}0,a,0\n"), number(2, "y", ""));
}

#[test]
fn goals_that_go_on_with_a_target_have_no_resting_place() {
    let goal = |name: &str, time: f64, speed: f64, remaining: f64| GoalSample {
        time,
        position: [0.1 * time, if name == "a" { 0.0 } else { 1.0 }],
        velocity: [speed, 0.0],
        remaining,
    };
    let run = |remaining: f64| {
        let track = |name: &str, y: f64| {
            let pose = |time: f64| Pose { time, x: 0.1 * time, y, ..Pose::default() };
            let goals = vec![goal(name, 0.0, 0.1, remaining), goal(name, 5.0, 0.1, remaining)];
            (name.to_owned(), Track { poses: vec![pose(0.0), pose(10.0)], goals, ..Track::default() })
        };
        Run { robots: [track("a", 0.0), track("b", 1.25)].into(), ..Run::default() }
    };
    let carried = run(f64::MAX);
    assert_eq!((carried.vertex("a"), carried.vertex("b")), (None, None));
    let summary = summary(&carried, &SummaryOptions::default());
    assert!(near(summary.final_shape_error.unwrap(), 0.25), "{summary:?}");
    assert_eq!(summary.robots[0].final_distance, None);
    assert_eq!(run(2.0).vertex("a"), Some([0.7, 0.0]));
}
