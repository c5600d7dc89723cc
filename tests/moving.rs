//! What changes while a team follows its target, in lock-step: the formation, the number of robots; and a target that is a
//! robot itself.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "the experiments use the rest")]
mod support;

use std::path::Path;
use support::conformity::Conformity;
use trench_bag::run::RunBuilder;
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Advertise, Event, Interface, Level, Local, NodeCore, Qos, RosTime, Serve, Sink, Source, Steady, Subscribe, Times,
};
use trench_harness::{Ending, Instance, Lockstep, Observer, load, plan};
use trench_journal::Disk;
use trench_msgs::Message;
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::msg::{
    Assignment, Formation, RunState, SetFormation, SetFormationRequest, SetFormationResponse, TeamState,
};
use trench_msgs::std_msgs::Header;

const COLUMN: &str = "launch/column.launch.yaml";

/// Each robot is this near to its segment when the team has formed, m.
const CONFORM: f64 = 0.05;

/// Someone at another terminal, who asks for other formations.
struct Asker {
    interface: Interface,
    /// What is asked when, s of the run's clock; the last first.
    asks: Vec<(f64, Ask)>,
}

enum Ask {
    Service(SetFormationRequest),
    Topic(Box<Formation>),
}

impl Asker {
    fn new(mut asks: Vec<(f64, Ask)>) -> Self {
        asks.reverse();
        let interface = Interface {
            publications: vec![Advertise::of::<Formation>("/set_formation", Qos::RELIABLE, Local::NetworkOnly)],
            clients: vec![Serve::of::<SetFormation>("/leader_assignment/set_formation")],
            ..Interface::default()
        };
        Self { interface, asks }
    }
}

impl NodeCore for Asker {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, _: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Wakeup => match self.asks.pop() {
                Some((_, Ask::Service(request))) => sink.call(0, &request),
                Some((_, Ask::Topic(formation))) => sink.publish(0, &*formation),
                None => {}
            },
            Event::Response { cdr, .. } => {
                let answer = SetFormationResponse::decode(cdr.unwrap()).unwrap();
                assert!(answer.success, "{answer:?}");
            }
            _ => {}
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.asks.last().map(|(when, _)| Steady(0).plus_seconds(*when))
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        Ok(())
    }
}

/// Someone with a joystick, who drives robot5 once it is time.
struct Driver {
    interface: Interface,
    /// Seconds of the run's clock at which it sets out, m/s, rad/s.
    drive: [f64; 3],
}

impl Driver {
    fn new(drive: [f64; 3]) -> Self {
        let interface = Interface {
            subscriptions: vec![Subscribe::to::<TeamState>("/team_state", Qos::RELIABLE)],
            publications: vec![Advertise::of::<TwistStamped>("/robot5/cmd_vel", Qos::RELIABLE, Local::SMALL)],
            ..Interface::default()
        };
        Self { interface, drive }
    }
}

impl NodeCore for Driver {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        let Event::Message { cdr, .. } = event else { return };
        let [depart, v, omega] = self.drive;
        let mut command = TwistStamped { header: TeamState::decode(cdr).unwrap().header, ..Default::default() };
        if at.steady >= Steady(0).plus_seconds(depart) {
            (command.twist.linear.x, command.twist.angular.z) = (v, omega);
        }
        sink.publish(0, &command);
    }

    fn next_wakeup(&self) -> Option<Steady> {
        None
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        Ok(())
    }
}

#[derive(Default)]
struct Watch {
    builder: RunBuilder,
    conformity: Conformity,
    assignments: Vec<Assignment>,
    formations: Vec<Formation>,
    complaints: Vec<String>,
    /// t0, s of the run's clock.
    t0: Option<f64>,
}

impl Watch {
    /// s since t0 of a time of the run's clock.
    fn since_t0(&self, seconds: f64) -> f64 {
        seconds - self.t0.unwrap()
    }
}

impl Observer for Watch {
    fn published(&mut self, at: Times, topic: &str, advertise: &Advertise, _: Source, cdr: &[u8]) {
        self.builder.take(topic, advertise.type_info.name, cdr);
        self.conformity.take(topic, cdr);
        match topic {
            "/assignment" => self.assignments.push(Assignment::decode(cdr).unwrap()),
            "/run_state" => {
                let (run, now) = (RunState::decode(cdr).unwrap(), at.steady.0 as f64 * 1e-9);
                let t0 = RosTime::from(&run.t0);
                if run.state == RunState::RUNNING && t0.0 != 0 {
                    self.t0.get_or_insert(now - at.ros.seconds_since(t0));
                }
            }
            "/formation" => self.formations.push(Formation::decode(cdr).unwrap()),
            _ => {}
        }
    }

    fn logged(&mut self, at: Times, node: &str, level: Level, text: &str) {
        if level >= Level::Warn {
            self.complaints.push(format!("[{:.3}] {node}: {text}", at.steady.0 as f64 * 1e-9));
        }
    }
}

/// The column with somebody else in the same system: it stands in the end, and nobody has touched anybody.
fn column(arguments: &[(&str, &str)], somebody: Box<dyn NodeCore>) -> Watch {
    let arguments = arguments.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(COLUMN);
    let mut instances = load(&plan(&path, &arguments).unwrap(), &Disk, 1).unwrap().instances;
    instances.push(Instance { default_name: "somebody".to_owned(), remaps: Vec::new(), core: somebody });
    let mut watch = Watch::default();
    let ending = Lockstep::new(instances).unwrap().run(600.0, &mut watch);
    let run = std::mem::take(&mut watch.builder).finish();
    assert_eq!(ending, Ending::Exit { node: "/operator".to_owned(), code: 0 }, "{:#?}", watch.complaints);
    assert!(run.contacts.is_empty(), "{:?}\n{:#?}", run.contacts, watch.complaints);
    watch
}

/// The farthest that any robot that has a place is from its segment between two times since t0, m.
fn farthest(conformity: &Conformity, from: f64, to: f64) -> f64 {
    let robots = conformity.finish().robots;
    let during = robots.values().flatten().filter(|sample| (from..to).contains(&sample.time));
    let farthest = during.map(|sample| sample.distance).fold(f64::NAN, f64::max);
    assert!(farthest.is_finite(), "nobody had a place from {from} s to {to} s");
    farthest
}

#[test]
fn a_team_takes_up_other_shapes_and_sizes_while_its_target_moves() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("config/formations/wings.yaml"));
    let wings = trench_plan::parse("wings.yaml", &text.unwrap()).unwrap().message(Header::default());
    let column_again = SetFormationRequest { name: "column".to_owned(), ..Default::default() };
    let smaller = SetFormationRequest { scale: 0.9, ..Default::default() };
    let changes = [25.0, 50.0, 75.0];
    let asks = vec![
        (changes[0], Ask::Topic(Box::new(wings.clone()))),
        (changes[1], Ask::Service(column_again)),
        (changes[2], Ask::Service(smaller)),
    ];
    // The target is under way from 10 s on, until after the last change.
    let arguments = [("duration", "100.0"), ("speed", "0.025")];
    let watch = column(&arguments, Box::new(Asker::new(asks)));
    let names: Vec<&str> = watch.formations.iter().map(|formation| formation.name.as_str()).collect();
    assert_eq!(names, ["column", "wings", "column", "column"]);
    assert_eq!(watch.formations[1].hash, wings.hash);
    // One for each formation and no more: nothing flaps.
    let epochs: Vec<u64> = watch.assignments.iter().map(|assignment| assignment.epoch).collect();
    assert_eq!(epochs, [1, 2, 3, 4], "{:#?}", watch.complaints);
    for (formation, assignment) in watch.formations.iter().zip(&watch.assignments) {
        assert_eq!((assignment.formation_hash, assignment.members.len()), (formation.hash, 4));
    }
    // Wings are two chains of two, 0.6 m apart.
    assert_eq!(watch.assignments[1].members.iter().filter(|member| member.leader.is_empty()).count(), 2);
    for change in changes {
        let change = watch.since_t0(change);
        let before = farthest(&watch.conformity, change - 4.0, change);
        assert!(before <= CONFORM, "{before} m from a segment before the change at {change} s");
    }
    let change = watch.since_t0(changes[0]);
    assert!(farthest(&watch.conformity, change + 0.1, change + 1.0) > 0.2, "wings are somewhere else");
    assert!(farthest(&watch.conformity, 96.0, 100.0) <= CONFORM);
}

#[test]
fn a_robot_leaves_the_formation_and_comes_back_while_the_target_moves() {
    let with = |robots: &[&str]| {
        let robots = robots.iter().map(|robot| (*robot).to_owned()).collect();
        Ask::Service(SetFormationRequest { robots, ..Default::default() })
    };
    let all = ["robot1", "robot2", "robot3", "robot4"];
    let asks = vec![(25.0, with(&all[..3])), (50.0, with(&all))];
    let watch = column(&[("duration", "90.0"), ("speed", "0.025")], Box::new(Asker::new(asks)));
    let sizes: Vec<usize> = watch.assignments.iter().map(|assignment| assignment.members.len()).collect();
    assert_eq!(sizes, [4, 3, 4], "{:#?}", watch.complaints);
    assert!(watch.assignments[1].members.iter().all(|member| member.robot != "robot4"));
    let [left, back] = [25.0, 50.0].map(|change| watch.since_t0(change));
    for (from, to) in [(left - 4.0, left), (back - 4.0, back), (86.0, 90.0)] {
        let distance = farthest(&watch.conformity, from, to);
        assert!(distance <= CONFORM, "{distance} m from a segment between {from} s and {to} s");
    }
}

#[test]
fn a_team_follows_a_robot() {
    let arguments = [
        ("target_robot", "robot5"),
        ("everybody", "[robot1, robot2, robot3, robot4, robot5]"),
        ("formation", "behind"),
        ("poses", "[0.4, 0.4, 0.3, 0.4, 1.4, -0.5, 0.8, 0.6, 1.2, 0.3, 0.9, 0.0, 1.7, 0.8, 0.0]"),
        ("duration", "60.0"),
    ];
    let depart = 25.0;
    let watch = column(&arguments, Box::new(Driver::new([depart, 0.06, 0.02])));
    assert_eq!(watch.assignments.len(), 1, "{:#?}", watch.complaints);
    assert!(watch.assignments[0].members.iter().all(|member| member.robot != "robot5"));
    let conformed = watch.conformity.finish();
    // It drove 2.2 m, along an arc, and the team with it.
    let [x, y] = conformed.places["robot5"];
    assert!(libm::hypot(x - 1.7, y - 0.8) > 1.8, "robot5 is at ({x}, {y})");
    let set_out = watch.since_t0(depart);
    assert!(farthest(&watch.conformity, set_out + 5.0, 60.0) <= CONFORM);
    let ahead = |robot: &str| libm::hypot(x - conformed.places[robot][0], y - conformed.places[robot][1]);
    let first = &watch.assignments[0].members[0].robot;
    assert!((ahead(first) - 0.6).abs() <= CONFORM, "{first} is {} m behind robot5", ahead(first));
}
