//! The node as its neighbours see it: services, goals, run state, and what outlives it.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use leader_assignment::description;
use trench_config::params::{Source, resolve};
use trench_config::{ConfigError, Parameters};
use trench_core::{Action, Event, Files, NodeContext, NodeCore, Outbox, RequestId, RosTime, Steady, Times};
use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
use trench_msgs::msg::{
    Assignment, Formation, Goal, Goals, LeaderState, LinkStatus, RobotState, RunState, SetFormationRequest,
    SetFormationResponse, TeamState,
};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::std_srvs::{TriggerRequest, TriggerResponse};
use trench_msgs::visualization_msgs::MarkerArray;
use trench_msgs::{Encode, Message};

struct Shipped;

impl Files for Shipped {
    fn read(&self, key: &str, path: &str) -> Result<String, ConfigError> {
        let path = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(path).map_err(|error| Parameters::default().error(key, error.to_string(), "a file"))
    }
}

const FILE: (&str, &str) = ("formation_file", "config/formations/square.yaml");
const ROBOTS: (&str, &str) = ("robots", "[robot1, robot2, robot3, robot4]");

/// A queue of one place, half a metre behind the target.
struct OnTarget;

impl Files for OnTarget {
    fn read(&self, _: &str, _: &str) -> Result<String, ConfigError> {
        Ok("name: wing\nframe: target\nqueues:\n- name: left\n  \
            segment: {kind: line, points: [[-1.0, 0.0], [0.0, 0.0]]}\n  vertices: [[-0.5, 0.0]]\n  \
            share: 1.0\n  tolerance: 0.02\n"
            .to_owned())
    }
}

fn make(overrides: &[(&str, &str)], checkpoint: Option<Vec<u8>>) -> Result<Box<dyn NodeCore>, String> {
    make_of(overrides, checkpoint, &Shipped)
}

fn make_of(
    overrides: &[(&str, &str)],
    checkpoint: Option<Vec<u8>>,
    files: &dyn Files,
) -> Result<Box<dyn NodeCore>, String> {
    let sources: Vec<Source<'_>> =
        overrides.iter().map(|(name, value)| Source::Override { node: None, name, value }).collect();
    let node = description();
    let parameters = resolve(&sources, "/", node.name, &(node.parameters)()).map_err(|errors| errors[0].to_string())?;
    let context =
        NodeContext { namespace: "/".to_owned(), name: node.name.to_owned(), checkpoint, ..Default::default() };
    (node.build)(&context, &parameters, files).map_err(|error| error.to_string())
}

struct Bench {
    core: Box<dyn NodeCore>,
    out: Outbox,
    seconds: f64,
    /// The last one before the last call of a service.
    assignment: Option<Assignment>,
}

impl Bench {
    fn new(seconds: f64, checkpoint: Option<Vec<u8>>) -> Self {
        Self::of(make(&[FILE, ROBOTS], checkpoint).unwrap(), seconds)
    }

    fn of(core: Box<dyn NodeCore>, seconds: f64) -> Self {
        let mut bench = Self { core, out: Outbox::default(), seconds, assignment: None };
        bench.handle(Event::Started);
        bench
    }

    fn handle(&mut self, event: Event<'_>) {
        let at = Times { ros: RosTime(0).plus_seconds(self.seconds), steady: Steady(0).plus_seconds(self.seconds) };
        self.core.handle(at, event, &mut self.out);
    }

    fn call(&mut self, name: &str) -> TriggerResponse {
        let service = self.core.interface().services.iter().position(|serve| serve.name.ends_with(name)).unwrap();
        self.assignment = self.last("/assignment").or(self.assignment.take());
        self.out.take();
        let cdr = TriggerRequest::default().to_cdr();
        self.handle(Event::Request { service, id: RequestId(1), cdr: &cdr });
        let answer = self.out.actions.iter().find_map(|action| match action {
            Action::Respond { cdr, .. } => Some(TriggerResponse::decode(cdr).unwrap()),
            _ => None,
        });
        answer.unwrap()
    }

    fn set_formation(&mut self, name: &str, scale: f64, robots: &[&str]) -> SetFormationResponse {
        let service =
            self.core.interface().services.iter().position(|serve| serve.name.ends_with("set_formation")).unwrap();
        self.out.take();
        let robots = robots.iter().map(|robot| (*robot).to_owned()).collect();
        let cdr = SetFormationRequest { name: name.to_owned(), scale, robots }.to_cdr();
        self.handle(Event::Request { service, id: RequestId(1), cdr: &cdr });
        let answer = self.out.actions.iter().find_map(|action| match action {
            Action::Respond { cdr, .. } => Some(SetFormationResponse::decode(cdr).unwrap()),
            _ => None,
        });
        answer.unwrap()
    }

    fn send(&mut self, topic: &str, message: &dyn Encode) {
        let port = self.core.interface().subscriptions.iter().position(|subscribe| subscribe.topic == topic).unwrap();
        let cdr = message.to_cdr();
        self.handle(Event::Message { port, source: Default::default(), cdr: &cdr, arrived: None });
    }

    fn see(&mut self, status: u8) {
        let starts = [(0.15, 0.25), (0.95, 0.20), (0.20, 1.60), (0.90, 1.55)];
        let robot = |(index, (x, y)): (usize, (f64, f64))| RobotState {
            name: format!("robot{}", index + 1),
            status,
            x,
            y,
            ..Default::default()
        };
        self.see_robots(starts.into_iter().enumerate().map(robot).collect());
    }

    fn see_robots(&mut self, robots: Vec<RobotState>) {
        let mut team = TeamState { robots, ..Default::default() };
        team.header.stamp = RosTime(0).plus_seconds(self.seconds).into();
        let cdr = team.to_cdr();
        self.handle(Event::Message { port: 0, source: Default::default(), cdr: &cdr, arrived: None });
    }

    /// So many seconds of frames in which the robots of `speakers` say whom they hear; `silent` names radios that are down.
    fn live(&mut self, seconds: f64, speakers: &[(&str, &[&str])], silent: &[&str]) {
        for _ in 0..(10.0 * seconds) as u32 {
            self.seconds += 0.1;
            self.speak(speakers, silent);
            self.see(RobotState::STATUS_TRACKED);
        }
    }

    fn speak(&mut self, speakers: &[(&str, &[&str])], silent: &[&str]) {
        for (robot, hears) in speakers {
            let hears = hears.iter().map(|name| (*name).to_owned()).collect();
            self.send(&format!("/{robot}/leader_state"), &LeaderState { hears, ..Default::default() });
            let link = LinkStatus { up: !silent.contains(robot), ..Default::default() };
            self.send(&format!("/{robot}/link"), &link);
        }
    }

    /// The last assignment.
    fn assigned(&self) -> Assignment {
        self.last("/assignment").or(self.assignment.clone()).unwrap()
    }

    /// Robot and leader of each member of the last assignment.
    fn chains(&self) -> Vec<(String, String)> {
        self.assigned().members.into_iter().map(|member| (member.robot, member.leader)).collect()
    }

    fn last<M: Message>(&self, topic: &str) -> Option<M> {
        let port = self.core.interface().publications.iter().position(|advertise| advertise.topic == topic).unwrap();
        self.out.last(port)
    }

    fn checkpoint(&self) -> Vec<u8> {
        let kept = self.out.actions.iter().rev().find_map(|action| match action {
            Action::Checkpoint(bytes) => Some(bytes.clone()),
            _ => None,
        });
        kept.unwrap()
    }

    fn running() -> Self {
        Self::running_with(&[])
    }

    /// With further parameters.
    fn running_with(further: &[(&str, &str)]) -> Self {
        let mut bench = Self::of(make(&[&[FILE, ROBOTS][..], further].concat(), None).unwrap(), 100.0);
        bench.see(RobotState::STATUS_TRACKED);
        assert!(bench.call("arm").success);
        assert!(bench.call("start").success);
        bench.seconds += 1.0;
        bench.see(RobotState::STATUS_TRACKED);
        bench
    }
}

#[test]
fn a_run_from_arm_to_stop() {
    let mut bench = Bench::running();
    let state: RunState = bench.last("/run_state").unwrap();
    assert_eq!((state.state, RosTime::from(&state.t0)), (RunState::RUNNING, RosTime(101_000_000_000)));
    let goals: Goals = bench.last("/goals").unwrap();
    assert_eq!(goals.goals.len(), 4);
    assert!(goals.goals.iter().all(|goal| goal.phase == Goal::PHASE_APPROACH));
    bench.seconds += 9.0;
    bench.see(RobotState::STATUS_TRACKED);
    let goals: Goals = bench.last("/goals").unwrap();
    assert!(goals.goals.iter().all(|goal| goal.phase == Goal::PHASE_MOVING && goal.velocity.x > 0.06));
    assert!(bench.call("stop").success);
    let state: RunState = bench.last("/run_state").unwrap();
    assert_eq!(state.state, RunState::STOPPED);
}

#[test]
fn viewers_are_shown_the_formation_and_who_follows_whom() {
    let mut bench = Bench::new(100.0, None);
    bench.see(RobotState::STATUS_TRACKED);
    let shown = |bench: &Bench| -> Vec<(String, usize)> {
        let markers = bench.last::<MarkerArray>("/markers").unwrap().markers;
        assert!(markers.iter().all(|marker| marker.header.frame_id == "map" && marker.lifetime.sec > 0));
        markers.into_iter().map(|marker| (marker.ns, marker.points.len())).collect()
    };
    let queues = ["formation/segments", "formation/vertices"].repeat(2);
    let queues: Vec<_> = queues.into_iter().map(|namespace| (namespace.to_owned(), 2)).collect();
    assert_eq!(shown(&bench), queues, "before anyone is assigned");
    let bench = Bench::running();
    let goals = ("formation/goals".to_owned(), 4);
    let arrow = ("formation/leaders".to_owned(), 2);
    assert_eq!(shown(&bench), [queues, vec![goals, arrow.clone(), arrow]].concat());
}

#[test]
fn nobody_arms_robots_that_are_not_seen() {
    let mut bench = Bench::new(100.0, None);
    let refused = bench.call("arm");
    assert!(!refused.success && refused.message.contains("no /team_state"), "{refused:?}");
    bench.see(RobotState::STATUS_LOST);
    let refused = bench.call("arm");
    assert_eq!(refused.message, "not localised: robot1, robot2, robot3, robot4");
}

#[test]
fn a_process_that_died_goes_on_where_it_was() {
    let mut died = Bench::running();
    let before: Assignment = {
        died.see(RobotState::STATUS_TRACKED);
        let mut again = Bench::new(104.0, Some(died.checkpoint()));
        again.see(RobotState::STATUS_TRACKED);
        let state: RunState = again.last("/run_state").unwrap();
        assert_eq!((state.state, RosTime::from(&state.t0)), (RunState::RUNNING, RosTime(101_000_000_000)));
        assert_eq!(again.last::<Goals>("/goals").unwrap().goals.len(), 4);
        again.last("/assignment").unwrap()
    };
    assert_eq!((before.epoch, before.members.len()), (1, 4));
}

#[test]
fn yesterday_s_run_does_not_go_on() {
    let state = |bench: &Bench| bench.last::<RunState>("/run_state").unwrap().state;
    let died = Bench::running();
    assert_eq!(state(&Bench::new(3600.0, Some(died.checkpoint()))), RunState::IDLE, "too old");
    assert_eq!(state(&Bench::new(50.0, Some(died.checkpoint()))), RunState::IDLE, "from the future");
    let mut ended = Bench::running();
    ended.handle(Event::Shutdown);
    assert_eq!(state(&Bench::new(102.0, Some(ended.checkpoint()))), RunState::IDLE, "it ended cleanly");
    assert_eq!(state(&Bench::new(102.0, Some(vec![1, 2, 3]))), RunState::IDLE, "damaged");
}

#[test]
fn a_formation_in_the_target_s_frame_moves_and_turns_with_it() {
    let core = make_of(&[FILE, ("robots", "[robot1]")], None, &OnTarget).unwrap();
    let mut bench = Bench::of(core, 10.0);
    bench.see(RobotState::STATUS_TRACKED);
    assert!(bench.last::<Goals>("/goals").is_none(), "nobody knows where the formation is");
    let mut target = Odometry::default();
    (target.pose.pose.position.x, target.pose.pose.position.y) = (1.0, 1.0);
    let quarter = std::f64::consts::FRAC_PI_4;
    (target.pose.pose.orientation.w, target.pose.pose.orientation.z) = (quarter.cos(), quarter.sin());
    (target.twist.twist.linear.x, target.twist.twist.angular.z) = (0.2, 0.1);
    let cdr = target.to_cdr();
    bench.handle(Event::Message { port: 1, source: Default::default(), cdr: &cdr, arrived: None });
    assert!(bench.call("arm").success);
    bench.see(RobotState::STATUS_TRACKED);
    let goal = bench.last::<Goals>("/goals").unwrap().goals.remove(0);
    // The target looks along y: the vertex half a metre behind it lies below it, and swings out as it turns left.
    let near =
        |value: f64, expected: f64| assert!((value - expected).abs() < 1e-9, "{value}, not {expected}: {goal:?}");
    near(goal.position.x, 1.0);
    near(goal.position.y, 0.5);
    near(goal.velocity.x, 0.05);
    near(goal.velocity.y, 0.2);
    bench.seconds += 1.0;
    bench.out.take();
    bench.see(RobotState::STATUS_TRACKED);
    assert!(bench.last::<Goals>("/goals").is_none(), "a silent target stops its formation");
}

/// Level and text of what the node says last of one of its parts.
fn said(bench: &Bench, part: &str) -> (u8, String) {
    let port = bench.core.interface().publications.iter().position(|topic| topic.topic == "/diagnostics").unwrap();
    let said = bench.out.actions.iter().rev().find_map(|action| match action {
        Action::Publish { port: of, cdr } if *of == port => {
            let mut status = DiagnosticArray::decode(cdr).unwrap().status.into_iter();
            status.find(|status| status.name.ends_with(part)).map(|status| (status.level, status.message))
        }
        _ => None,
    });
    said.unwrap()
}

/// The goal at a new frame, if there is one; the robot is far from everything.
fn goal_of_the_target(bench: &mut Bench, robots: &[RobotState]) -> Option<(f64, f64)> {
    bench.out.take();
    bench.see_robots([&[tracked("robot1", 3.0, 3.0)][..], robots].concat());
    bench.last::<Goals>("/goals").map(|goals| (goals.goals[0].position.x, goals.goals[0].position.y))
}

fn tracked(name: &str, x: f64, y: f64) -> RobotState {
    RobotState { name: name.to_owned(), status: RobotState::STATUS_TRACKED, x, y, ..Default::default() }
}

fn target_at(x: f64, speed: f64) -> Odometry {
    let mut target = Odometry::default();
    (target.pose.pose.position.x, target.pose.pose.orientation.w, target.twist.twist.linear.x) = (x, 1.0, speed);
    target
}

#[test]
fn a_target_that_jumps_ten_metres_is_named_and_the_formation_goes_on_and_then_stops() {
    let core = make_of(&[FILE, ("robots", "[robot1]")], None, &OnTarget).unwrap();
    let mut bench = Bench::of(core, 10.0);
    bench.see_robots(vec![tracked("robot1", 3.0, 3.0)]);
    bench.send("/target", &target_at(1.0, 0.2));
    assert!(bench.call("arm").success && bench.call("start").success);
    for tick in 1..=4 {
        bench.seconds += 0.1;
        // The believed motion goes on, half a metre ahead of the place.
        let x = 0.5 + 0.02 * f64::from(tick);
        let goal = goal_of_the_target(&mut bench, &[]).unwrap();
        assert!((goal.0 - x).abs() < 1e-9 && goal.1.abs() < 1e-9, "{goal:?}, not ({x}, 0)");
        bench.send("/target", &target_at(11.0, 0.2));
        if tick == 1 {
            let (level, text) = said(&bench, "target");
            assert_eq!(level, DiagnosticStatus::ERROR);
            assert!(text.contains("it jumped by 9.98 m, more than target.jump"), "{text}");
        }
    }
    bench.seconds += 0.2;
    bench.send("/target", &target_at(11.0, 0.2));
    assert_eq!(goal_of_the_target(&mut bench, &[]), None, "after age.target nobody knows where the formation is");
    assert!(bench.call("stop").success && bench.call("reset").success && bench.call("arm").success);
    bench.send("/target", &target_at(11.0, 0.2));
    assert_eq!(said(&bench, "target").0, DiagnosticStatus::OK);
    let goal = goal_of_the_target(&mut bench, &[]);
    assert_eq!(goal, Some((10.5, 0.0)), "the operator armed: it is believed where it is");
}

#[test]
fn a_robot_may_be_the_target() {
    let parameters = [FILE, ("robots", "[robot1]"), ("target.robot", "robot9")];
    let mut bench = Bench::of(make_of(&parameters, None, &OnTarget).unwrap(), 10.0);
    let robot9 = |y: f64, status: u8| RobotState {
        theta: std::f64::consts::FRAC_PI_2,
        v: 0.2,
        status,
        ..tracked("robot9", 1.0, y)
    };
    let seen = [robot9(1.0, RobotState::STATUS_TRACKED)];
    assert_eq!(goal_of_the_target(&mut bench, &seen), None, "not armed");
    assert!(bench.call("arm").success && bench.call("start").success);
    bench.seconds += 0.1;
    // What others say of a target counts for nothing.
    bench.send("/target", &target_at(11.0, 0.0));
    let near = |goal: Option<(f64, f64)>, y: f64| {
        let (at_x, at_y) = goal.unwrap();
        assert!((at_x - 1.0).abs() < 1e-9 && (at_y - y).abs() < 1e-9, "{goal:?}, not (1, {y})");
    };
    let seen = [robot9(1.02, RobotState::STATUS_TRACKED)];
    near(goal_of_the_target(&mut bench, &seen), 0.52);
    bench.seconds += 0.4;
    let lost = [robot9(5.0, RobotState::STATUS_LOST)];
    near(goal_of_the_target(&mut bench, &lost), 0.60);
    bench.seconds += 0.2;
    assert_eq!(goal_of_the_target(&mut bench, &lost), None, "lost for longer than age.target");
    let seen = [robot9(1.14, RobotState::STATUS_TRACKED)];
    near(goal_of_the_target(&mut bench, &seen), 0.64);
}

#[test]
fn what_cannot_be_is_refused_at_start() {
    let refused = |overrides: &[(&str, &str)]| make(overrides, None).map(drop).unwrap_err();
    assert!(refused(&[ROBOTS]).contains("no formation is given"));
    assert!(refused(&[FILE]).contains("no robot takes part"));
    let order = refused(&[FILE, ROBOTS, ("chain.order", "nearest_first")]);
    assert!(order.contains("chain.order") && order.contains("write nearest or places"), "{order}");
    let five = ("robots", "[a, b, c, d, e]");
    assert!(refused(&[FILE, five]).contains("5 robots, but the formation square has 4 places"));
    let twice = ("robots", "[robot1, robot2, robot1]");
    assert!(refused(&[FILE, twice]).contains("two robots have the name robot1"));
    assert!(refused(&[("formation_file", "nowhere.yaml"), ROBOTS]).contains("formation_file"));
}

#[test]
fn the_formation_changes_while_running_in_size_and_number() {
    let mut bench = Bench::running();
    let before: Formation = {
        let fresh = Bench::new(0.0, None);
        fresh.last("/formation").unwrap()
    };
    let answer = bench.set_formation("", 0.5, &["robot1", "robot2", "robot3"]);
    assert!(answer.success, "{answer:?}");
    let formation: Formation = bench.last("/formation").unwrap();
    let assignment: Assignment = bench.last("/assignment").unwrap();
    assert_ne!(formation.hash, before.hash);
    assert_eq!((assignment.formation_hash, assignment.epoch, assignment.members.len()), (formation.hash, 2, 3));
    bench.seconds += 0.1;
    bench.see(RobotState::STATUS_TRACKED);
    let goals: Goals = bench.last("/goals").unwrap();
    assert_eq!((goals.epoch, goals.goals.len()), (2, 3));
    assert!(goals.goals.iter().all(|goal| goal.phase == Goal::PHASE_APPROACH), "the new one sets out now");
    let again = bench.set_formation("", 0.0, &[]);
    assert!(again.success && again.message.contains("already"), "{again:?}");
    assert!(bench.last::<Assignment>("/assignment").is_none(), "nothing flaps");
    let state: RunState = Bench::running().last("/run_state").unwrap();
    assert_eq!(state.state, RunState::RUNNING);
}

/// Robots of the last assignment with their queues, in order of name.
fn queues(bench: &Bench) -> Vec<(String, u32)> {
    let members = bench.assigned().members.into_iter();
    let mut queues: Vec<_> = members.map(|member| (member.robot, member.queue)).collect();
    queues.sort();
    queues
}

#[test]
fn another_formation_of_the_library_comes_by_its_name_for_as_many_robots_as_it_has_places() {
    let mut bench = Bench::running_with(&[("more_formations", "[config/formations/triangle.yaml]")]);
    let square = bench.assigned();
    let refused = bench.set_formation("triangle", 0.0, &[]);
    assert!(!refused.success && refused.message.contains("4 robots, but triangle has 3 places"), "{refused:?}");
    assert_eq!(said(&bench, "formation"), (DiagnosticStatus::WARN, refused.message.clone()));
    assert!(bench.last::<Formation>("/formation").is_none() && bench.last::<Assignment>("/assignment").is_none());
    let three = ["robot4", "robot1", "robot2"];
    let answer = bench.set_formation("triangle", 0.0, &three);
    assert!(answer.success, "{answer:?}");
    let formation: Formation = bench.last("/formation").unwrap();
    assert_eq!((formation.name.as_str(), formation.queues.len()), ("triangle", 3));
    let assignment = bench.assigned();
    assert_eq!((assignment.epoch, assignment.formation_hash), (square.epoch + 1, formation.hash));
    let taken = queues(&bench);
    assert_eq!(taken.iter().map(|(robot, _)| robot.as_str()).collect::<Vec<_>>(), ["robot1", "robot2", "robot4"]);
    let names: std::collections::BTreeSet<_> = taken.iter().map(|(_, queue)| *queue).collect();
    assert_eq!(names.len(), 3, "{taken:?}");
    bench.seconds += 0.1;
    bench.see(RobotState::STATUS_TRACKED);
    let goals: Goals = bench.last("/goals").unwrap();
    assert_eq!((goals.epoch, goals.goals.len()), (assignment.epoch, 3));
    bench.assignment = Some(assignment);
    let answer = bench.set_formation("square", 0.0, &["robot1", "robot2", "robot3", "robot4"]);
    assert!(answer.success, "{answer:?}");
    assert_eq!((bench.assigned().epoch, bench.assigned().members), (square.epoch + 2, square.members));
}

#[test]
fn another_shape_may_come_as_a_message_if_it_has_places_for_all() {
    let message = |file: &str, robots: &str| -> Formation {
        let core = make(&[("formation_file", file), ("robots", robots)], None).unwrap();
        Bench::of(core, 0.0).last("/formation").unwrap()
    };
    let mut bench = Bench::running();
    let square = bench.assigned();
    bench.out.take();
    bench.assignment = Some(square.clone());
    bench.send("/set_formation", &message("config/formations/triangle.yaml", "[robot1]"));
    let (level, text) = said(&bench, "formation");
    assert_eq!(level, DiagnosticStatus::WARN);
    assert!(text.contains("4 robots, but triangle has 3 places"), "{text}");
    assert_eq!(bench.assigned(), square, "the old one stays");
    let diagonal = message("config/formations/diagonal.yaml", "[robot1]");
    bench.send("/set_formation", &diagonal);
    let now: Formation = bench.last("/formation").unwrap();
    assert_eq!((now.hash, now.queues.len()), (diagonal.hash, 1));
    let assignment = bench.assigned();
    assert_eq!((assignment.epoch, assignment.formation_hash), (square.epoch + 1, now.hash));
    // One chain now: each robot but the first follows another.
    let chain = assignment.members.iter().map(|member| member.leader.as_str()).collect::<Vec<_>>();
    assert_eq!((chain.len(), chain[0], chain[1..].contains(&"")), (4, "", false), "{chain:?}");
    let goals = |bench: &mut Bench| {
        bench.seconds += 0.1;
        bench.out.take();
        bench.see(RobotState::STATUS_TRACKED);
        assert!(bench.last::<Assignment>("/assignment").is_none(), "nothing flaps");
        bench.last::<Goals>("/goals").unwrap()
    };
    assert_eq!((goals(&mut bench).epoch, goals(&mut bench).goals.len()), (assignment.epoch, 4));
}

#[test]
fn a_formation_that_does_not_fit_is_refused_and_the_old_one_stays() {
    let mut bench = Bench::running();
    let mut refused = |name, scale, robots: &[&str], expected: &str| {
        let answer = bench.set_formation(name, scale, robots);
        assert!(!answer.success && answer.message.contains(expected), "{answer:?}");
        assert!(bench.last::<Formation>("/formation").is_none());
    };
    refused("star", 0.0, &[], "no formation is called star; there are square");
    refused("", -1.0, &[], "scale is -1");
    refused("", f64::NAN, &[], "scale is NaN");
    refused("", 0.0, &["robot1", "robot9"], "robot9 is none of the robots");
    refused("", 0.0, &["robot1", "robot1"], "robot1 is named twice");
    refused("", 0.0, &["robot1", "robot1"], "stays as it is");
    bench.see(RobotState::STATUS_TRACKED);
    assert_eq!(bench.last::<Goals>("/goals").unwrap().goals.len(), 4);
}

#[test]
fn a_formation_larger_than_the_field_is_refused() {
    let field = ("field", "[0.0, 0.0, 2.48, 1.83]");
    let mut bench = Bench::of(make(&[FILE, ROBOTS, field], None).unwrap(), 1.0);
    let answer = bench.set_formation("", 2.0, &[]);
    assert!(!answer.success && answer.message.contains("outside the field"), "{answer:?}");
    let small = ("field", "[0.0, 0.0, 1.0, 1.0]");
    assert!(make(&[FILE, ROBOTS, small], None).map(drop).unwrap_err().contains("outside the field"));
}

#[test]
fn a_formation_may_come_as_a_message() {
    let mut bench = Bench::running();
    let mut formation: Formation = Bench::new(0.0, None).last("/formation").unwrap();
    formation.queues[0].tolerance = 0.05;
    bench.out.take();
    bench.send("/set_formation", &formation);
    let now: Formation = bench.last("/formation").unwrap();
    assert_eq!(now.queues[0].tolerance, 0.05);
    assert_ne!(now.hash, formation.hash, "the hash is of the content, whatever the sender wrote");
    formation.queues.clear();
    bench.out.take();
    bench.send("/set_formation", &formation);
    assert!(bench.last::<Formation>("/formation").is_none(), "a formation without segments changes nothing");
}

#[test]
fn a_changed_formation_outlives_the_process() {
    let mut died = Bench::running();
    assert!(died.set_formation("", 0.5, &["robot1", "robot2", "robot3"]).success);
    let held: Formation = died.last("/formation").unwrap();
    died.seconds += 1.0;
    died.handle(Event::Wakeup);
    let again = Bench::new(died.seconds + 1.0, Some(died.checkpoint()));
    assert_eq!(again.last::<Formation>("/formation").unwrap().hash, held.hash);
    assert_eq!(again.last::<Assignment>("/assignment").unwrap().members.len(), 3);
    assert_eq!(again.last::<RunState>("/run_state").unwrap().state, RunState::RUNNING);
}

const EVERYBODY: [(&str, &[&str]); 4] =
    [("robot1", &["robot2"]), ("robot2", &["robot1"]), ("robot3", &["robot4"]), ("robot4", &["robot3"])];

fn names(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
    pairs.iter().map(|(robot, leader)| ((*robot).to_owned(), (*leader).to_owned())).collect()
}

#[test]
fn who_does_not_hear_its_leader_follows_nobody_until_it_does() {
    let mut bench = Bench::running();
    bench.live(5.0, &EVERYBODY, &[]);
    let whole = names(&[("robot2", ""), ("robot1", "robot2"), ("robot4", ""), ("robot3", "robot4")]);
    assert_eq!(bench.chains(), whole);
    let deaf: [(&str, &[&str]); 4] = [("robot1", &["robot3"]), EVERYBODY[1], EVERYBODY[2], EVERYBODY[3]];
    bench.live(0.4, &deaf, &[]);
    assert_eq!(bench.chains(), whole, "a gap is no break");
    bench.live(0.5, &deaf, &[]);
    let broken = names(&[("robot2", ""), ("robot1", ""), ("robot4", ""), ("robot3", "robot4")]);
    assert_eq!(bench.chains(), broken);
    bench.live(1.2, &EVERYBODY, &[]);
    assert_eq!(bench.chains(), broken, "the dwell time is not over");
    bench.live(1.0, &EVERYBODY, &[]);
    assert_eq!(bench.chains(), whole);
    let goals: Goals = bench.last("/goals").unwrap();
    let assignment: Assignment = bench.last("/assignment").unwrap();
    assert_eq!((goals.epoch, assignment.epoch), (3, 3));
}

#[test]
fn robots_quit_and_join_while_the_others_keep_their_places() {
    let mut bench = Bench::running();
    bench.live(5.0, &EVERYBODY, &[]);
    let before = bench.assigned();
    bench.live(2.5, &EVERYBODY, &["robot2"]);
    let three = names(&[("robot1", ""), ("robot4", ""), ("robot3", "robot4")]);
    assert_eq!(bench.chains(), three, "robot2's radio is down");
    assert_eq!(bench.last::<Goals>("/goals").unwrap().goals.len(), 3);
    // A controller that dies is no other case.
    bench.live(3.0, &[EVERYBODY[0], EVERYBODY[1], EVERYBODY[3]], &["robot2"]);
    assert_eq!(bench.chains(), names(&[("robot1", ""), ("robot4", "")]));
    bench.live(3.0, &EVERYBODY, &[]);
    let after: Assignment = bench.last("/assignment").unwrap();
    assert_eq!(after.members, before.members, "both have their places again");
}

#[test]
fn while_the_localizer_is_silent_nobody_has_quit() {
    let mut bench = Bench::running();
    bench.live(5.0, &EVERYBODY, &[]);
    let before = bench.assigned();
    for _ in 0..50 {
        bench.seconds += 0.1;
        bench.speak(&EVERYBODY, &[]);
        bench.handle(Event::Wakeup);
    }
    bench.live(1.0, &EVERYBODY, &[]);
    assert_eq!(bench.assigned(), before, "places and epoch are as they were");
    for _ in 0..50 {
        bench.seconds += 0.1;
        bench.speak(&EVERYBODY[1..], &[]);
        bench.handle(Event::Wakeup);
    }
    assert_eq!(bench.chains().len(), 3, "a controller that dies meanwhile is missed");
}

#[test]
fn a_robot_that_has_quit_joins_after_a_restart_too() {
    let mut died = Bench::running();
    died.live(5.0, &EVERYBODY, &[]);
    died.live(2.5, &EVERYBODY, &["robot2"]);
    died.seconds += 1.0;
    died.handle(Event::Wakeup);
    let mut again = Bench::new(died.seconds + 1.0, Some(died.checkpoint()));
    assert_eq!(again.chains().len(), 3);
    again.live(1.0, &EVERYBODY, &[]);
    assert_eq!(again.chains().len(), 4, "{:?}", again.chains());
}
