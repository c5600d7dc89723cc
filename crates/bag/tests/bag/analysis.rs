//! What a bag tells of traffic, links and rules.

use std::path::Path;
use trench_bag::analysis::{Analysis, AnalysisOptions, analyze};
use trench_bag::run::Run;
use trench_bag::{BagReader, BagWriter, Stamp, WriteOptions};
use trench_core::{Qos, RosTime};
use trench_msgs::Message;
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::msg::{LeaderState, LinkStatus, Obstacle, ObstacleArray, Point2, RobotState, RunState, TeamState};

const T0: i64 = 1_700_000_000_000_000_000;
const MS: i64 = 1_000_000;

fn write<M: Message>(bag: &mut BagWriter, topic: &str, log_time: i64, message: &M) {
    let id = bag.add_topic(topic, M::TYPE.into(), Qos::RELIABLE).unwrap();
    let stamp = Stamp { log_time: log_time as u64, publish_time: log_time as u64, sequence: 0 };
    bag.write(id, stamp, &message.to_cdr()).unwrap();
}

/// Ten seconds at 50 Hz: robot1 passes robot2, which stands, at 0.1 m/s and 0.18 m; a disc comes towards robot2; the
/// frames from 4 s to 4.5 s are missing; the link of robot1 is down from 6 s to 7 s.
fn record(path: &Path) -> Analysis {
    let mut bag = BagWriter::create(path, WriteOptions { disk_reserve: 0, ..WriteOptions::default() }).unwrap();
    let mut state = RunState { state: RunState::RUNNING, ..RunState::default() };
    state.t0 = RosTime(T0).into();
    write(&mut bag, "/run_state", T0, &state);
    let mut obstacles = ObstacleArray::default();
    obstacles.header.stamp = RosTime(T0).into();
    let (polygon, velocity) = (vec![Point2 { x: 3.0, y: 0.0 }], Point2 { x: -0.1, y: 0.0 });
    obstacles.obstacles = vec![Obstacle { id: 5, polygon, radius: 0.2, velocity }];
    write(&mut bag, "/obstacles", T0, &obstacles);
    for index in 0..500_i64 {
        let (stamp, time) = (T0 + index * 20 * MS, index as f64 * 0.02);
        if !(200..225).contains(&index) {
            let mut team = TeamState::default();
            team.header.stamp = RosTime(stamp).into();
            let robot = |name: &str, x: f64, y: f64| {
                let name = name.to_owned();
                RobotState { name, status: RobotState::STATUS_TRACKED, x, y, ..RobotState::default() }
            };
            team.robots = vec![robot("robot1", 0.5 + 0.1 * time, 0.18), robot("robot2", 1.0, 0.0)];
            write(&mut bag, "/team_state", stamp + 30 * MS, &team);
            let mut command = TwistStamped::default();
            command.header.stamp = RosTime(stamp).into();
            // One in a hundred takes longer.
            let late = if index % 100 == 99 { 9 } else { 2 };
            write(&mut bag, "/robot1/cmd_vel", stamp + (30 + late) * MS, &command);
            let mut leader = LeaderState { robot: "robot1".to_owned(), ..LeaderState::default() };
            leader.header.stamp = RosTime(stamp).into();
            // There, away again, and there to stay.
            leader.conforms = (2.0..3.0).contains(&time) || time >= 5.0;
            leader.segment_distance = 0.001 * time;
            write(&mut bag, "/robot1/leader_state", stamp + 33 * MS, &leader);
        }
        if index % 50 == 0 {
            let mut link = LinkStatus { robot: "robot1".to_owned(), up: index != 300, ..LinkStatus::default() };
            link.header.stamp = RosTime(stamp).into();
            (link.loss, link.round_trip, link.hops) = (if index == 300 { 0.5 } else { 0.0 }, 0.015, 2);
            (link.fault, link.frames_rejected) = (LinkStatus::FAULT_MISSED_STEPS, 7 + index as u64 / 50);
            write(&mut bag, "/robot1/link", stamp + 40 * MS, &link);
        }
    }
    bag.finish().unwrap();
    let bag = BagReader::open(path).unwrap();
    let run = Run::from_bag(&bag).unwrap();
    analyze(&bag, &run, &AnalysisOptions::default()).unwrap()
}

fn near(found: f64, expected: f64) -> bool {
    (found - expected).abs() < 1e-6
}

#[test]
fn a_run_is_analyzed() {
    let folder = tempfile::tempdir().unwrap();
    let analysis = record(&folder.path().join("run"));

    let team = analysis.traffic.iter().find(|topic| topic.topic == "/team_state").unwrap();
    assert_eq!(team.count, 475);
    assert!(near(team.rate.unwrap(), 474.0 / 9.98), "{team:?}");
    let gap = team.longest_gap.unwrap();
    assert!(near(gap.length, 0.52) && near(gap.from, 3.98 + 0.03), "{gap:?}");
    let age = team.age.unwrap();
    assert!(near(age.p50, 0.03) && near(age.max, 0.03), "{age:?}");

    let latency = analysis.latencies.iter().find(|latency| latency.to == "/robot1/cmd_vel").unwrap();
    assert_eq!((latency.from.as_str(), latency.count), ("/team_state", 475));
    let spread = latency.seconds;
    assert!(near(spread.p50, 0.002) && near(spread.p99, 0.009) && near(spread.max, 0.009), "{spread:?}");

    let [link] = &*analysis.links else { panic!("{:?}", analysis.links) };
    assert_eq!((link.robot.as_str(), link.reports, link.hops), ("robot1", 10, 2));
    assert!(near(link.up, 0.9) && near(link.longest_down, 1.0) && near(link.loss, 0.05), "{link:?}");
    assert!(near(link.worst_loss, 0.5) && near(link.round_trip.unwrap().p50, 0.015), "{link:?}");
    assert_eq!((link.faults, link.rejected), (LinkStatus::FAULT_MISSED_STEPS, 9));

    let [robot] = &*analysis.conformance else { panic!("{:?}", analysis.conformance) };
    assert!(near(robot.first.unwrap(), 2.0) && near(robot.for_good.unwrap(), 5.0), "{robot:?}");
    assert!(near(robot.final_distance, 0.00998), "{robot:?}");

    let [visit] = &*analysis.zone_visits else { panic!("{:?}", analysis.zone_visits) };
    // Nearer than 0.20 m while less than sqrt(0.2^2 - 0.18^2) m beside each other: 0.0872 m, 0.872 s. Of the first part
    // there are no poses.
    assert!(near(visit.from, 4.5) && (visit.to - 5.872).abs() < 0.021, "{visit:?}");
    assert!((visit.distance - 0.18).abs() < 1e-4, "{visit:?}");

    let [first, second] = &*analysis.clearances else { panic!("{:?}", analysis.clearances) };
    // At the end, t = 9.98 s, the disc has come to x = 2.002.
    assert_eq!((second.robot.as_str(), second.obstacle), ("robot2", 5));
    assert!(near(second.time, 9.98) && near(second.gap, 2.002 - 1.0 - 0.2 - 0.08), "{second:?}");
    let expected = length(2.002 - 1.498, 0.18) - 0.28;
    assert!(near(first.gap, expected), "{first:?}, expected {expected}");

    let told = analysis.to_string();
    for line in ["time to conform, the whole team: 5.00 s", "visits of zone 1                1", "2.00/9.00/9.00"] {
        assert!(told.contains(line), "{told}");
    }
}

fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}
