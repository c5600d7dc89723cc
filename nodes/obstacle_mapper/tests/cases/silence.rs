//! Who must speak is silent: nothing is published, so that controllers rest, and it is said who.

use super::{Bench, TWO, disc, scan};
use trench_config::params::{Source as Setting, resolve};
use trench_msgs::Encode;
use trench_msgs::msg::{ApparentObstacleArray, Obstacle, ObstacleArray, RobotState, TeamState};
use trench_msgs::std_msgs::Header;
use trench_msgs::visualization_msgs::MarkerArray;

const ONE: (&str, &str) = ("sources", "1");
const STALE: u8 = 3;

/// How many messages have gone out so far.
fn sent(bench: &Bench) -> usize {
    bench.out.published::<ApparentObstacleArray>(0).len()
}

/// Wakes the node as it wants it for so many seconds; how many messages went out meanwhile.
fn wait(bench: &mut Bench, seconds: f64) -> usize {
    let (before, end) = (sent(bench), bench.seconds + seconds);
    loop {
        let due = bench.core.next_wakeup().unwrap().0 as f64 * 1e-9;
        if due > end {
            bench.seconds = end;
            return sent(bench) - before;
        }
        bench.seconds = due;
        bench.handle(trench_core::Event::Wakeup);
    }
}

/// Both robots, robot2 at `x` and with this status.
fn team(bench: &mut Bench, x: f64, status: u8) {
    let of = |name: &str, x, y, status| RobotState { name: name.to_owned(), status, x, y, ..RobotState::default() };
    let robots = vec![of("robot1", 0.5, 3.0, RobotState::STATUS_TRACKED), of("robot2", x, 0.0, status)];
    bench.send("/team_state", 2, &TeamState { header: bench.header(), robots, ..TeamState::default() }.to_cdr());
}

/// robot2 drives at `speed` (m/s) for so many seconds, its laser speaks or is silent; how many messages went out meanwhile.
fn drive(bench: &mut Bench, (from, speed): (f64, f64), seconds: f64, speaks: bool) -> usize {
    let (before, began) = (sent(bench), bench.seconds);
    while bench.seconds < began + seconds - 1e-9 {
        bench.seconds += 0.05;
        let x = from + speed * (bench.seconds - began);
        if speaks {
            let seen = scan(bench.header(), [x, 0.0], None);
            bench.send("/robot2/scan", 11, &seen.to_cdr());
        }
        team(bench, x, RobotState::STATUS_TRACKED);
        bench.handle(trench_core::Event::Wakeup);
    }
    sent(bench) - before
}

#[test]
fn without_sources_nobody_is_waited_for() {
    let mut bench = Bench::new(&[]);
    assert!(sent(&bench) == 1 && wait(&mut bench, 2.0) > 30);
}

#[test]
fn nothing_is_published_before_the_sources_have_spoken() {
    let mut bench = Bench::new(&[ONE]);
    assert_eq!((sent(&bench), wait(&mut bench, 3.0)), (0, 0));
    let expected = "0 of 1 publishers of /obstacles heard within 0.5 s: robots rest (sources, age.sources)";
    assert_eq!(bench.condition("obstacles"), (STALE, expected.to_owned()));
    // That there are none is news, too.
    bench.obstacles(Vec::new());
    assert_eq!(sent(&bench), 1, "at once");
    assert_eq!(bench.condition("obstacles"), (0, "all are taken".to_owned()));
}

#[test]
fn a_source_that_falls_silent_stops_robots_and_is_named_until_it_speaks_again() {
    let mut bench = Bench::new(&[ONE]);
    for _ in 0..20 {
        bench.seconds += 0.1;
        bench.obstacles(vec![disc(1, 0.0, 0.0)]);
    }
    let pictures = |bench: &Bench| bench.out.published::<MarkerArray>(1).len();
    let (went_on, drawn) = (wait(&mut bench, 0.6), pictures(&bench));
    assert!((9..=10).contains(&went_on), "{went_on} in half a second");
    assert_eq!(bench.condition("obstacles").0, STALE, "within 0.6 s");
    assert_eq!(wait(&mut bench, 5.0), 0);
    assert!(pictures(&bench) > drawn + 20, "people see what it knows");
    // It has gone, so that its obstacles are forgotten: the more reason to say nothing.
    bench.handle(trench_core::Event::Matched { port: 0, writers: 0 });
    assert_eq!(wait(&mut bench, 5.0), 0);
    bench.seconds += 0.01;
    let before = sent(&bench);
    bench.obstacles(vec![disc(1, 0.0, 0.0)]);
    assert_eq!(sent(&bench), before + 1, "at once");
    assert_eq!(bench.condition("obstacles").0, 0);
    let last: ApparentObstacleArray = bench.out.last(0).unwrap();
    assert_eq!(last.obstacles.len(), 1);
}

#[test]
fn what_is_refused_is_no_word_and_anybody_s_word_counts() {
    let mut bench = Bench::new(&[ONE]);
    let future = bench.now().plus_seconds(5.0);
    let none: Vec<Vec<u8>> = vec![
        ObstacleArray { header: bench.header(), obstacles: vec![disc(1, f64::NAN, 0.0)] }.to_cdr(),
        ObstacleArray { header: Header { stamp: future.into(), ..Header::default() }, obstacles: vec![] }.to_cdr(),
        vec![0, 1, 0],
    ];
    for cdr in &none {
        bench.seconds += 0.1;
        bench.send("/obstacles", 1, cdr);
        assert_eq!(wait(&mut bench, 0.3), 0);
        let (level, text) = bench.condition("obstacles");
        assert!(level == STALE && text.starts_with("0 of 1 publishers of /obstacles heard"), "{text}");
    }
    assert!(bench.condition("obstacles").1.contains("; a message on /obstacles was dropped"), "and why it is refused");
    // The first publisher stays silent, another one speaks.
    let good = ObstacleArray { header: bench.header(), obstacles: vec![disc(1, 0.0, 0.0)] }.to_cdr();
    bench.send("/obstacles", 7, &good);
    assert_eq!(sent(&bench), 1);
    // One of two obstacles is none: the publisher speaks.
    let mut half = Bench::new(&[ONE]);
    half.obstacles(vec![Obstacle { radius: -1.0, ..disc(1, 0.0, 0.0) }, disc(2, 1.0, 0.0)]);
    assert_eq!((sent(&half), half.condition("obstacles").0), (1, 2));
}

#[test]
fn as_many_sources_as_are_wanted_must_speak_and_that_may_change() {
    let mut bench = Bench::new(&[("sources", "2")]);
    let speak = |gid: u8, bench: &mut Bench| {
        let message = ObstacleArray { header: bench.header(), obstacles: vec![] };
        bench.send("/obstacles", gid, &message.to_cdr());
        sent(bench)
    };
    assert_eq!(speak(1, &mut bench), 0);
    assert_eq!(wait(&mut bench, 0.3), 0);
    assert!(bench.condition("obstacles").1.starts_with("1 of 2"), "{:?}", bench.condition("obstacles"));
    assert_eq!(speak(1, &mut bench), 0, "twice the same one is one");
    assert_eq!(speak(2, &mut bench), 1);
    wait(&mut bench, 1.0);
    assert_eq!(wait(&mut bench, 1.0), 0);
    let node = obstacle_mapper::description();
    let parameters = |sources, age| {
        let given = [("sources", sources), ("age.sources", age)];
        let settings = given.map(|(name, value)| Setting::Override { node: None, name, value });
        resolve(&settings, "/", node.name, &(node.parameters)()).unwrap()
    };
    bench.core.set_parameters(&parameters("2", "10.0")).unwrap();
    assert!(wait(&mut bench, 1.0) > 10, "both spoke two seconds ago");
    bench.core.set_parameters(&parameters("3", "10.0")).unwrap();
    assert_eq!(wait(&mut bench, 1.0), 0);
    bench.core.set_parameters(&parameters("0", "0.5")).unwrap();
    assert!(wait(&mut bench, 1.0) > 10);
    assert_eq!(bench.condition("obstacles").0, 0);
}

#[test]
fn a_silence_that_lasts_is_logged_once() {
    let logged = |bench: &Bench| {
        let lines = bench.out.actions.iter().filter(|action| matches!(action, trench_core::Action::Log { .. }));
        lines.count()
    };
    let mut bench = Bench::new(&[ONE]);
    wait(&mut bench, 0.9);
    assert_eq!(logged(&bench), 0, "at the start everybody is silent");
    wait(&mut bench, 10.0);
    assert_eq!(logged(&bench), 1);
}

#[test]
fn a_laser_that_falls_silent_stops_robots_while_its_robot_drives() {
    let mut bench = Bench::new(&[TWO]);
    assert_eq!(drive(&mut bench, (0.0, 0.2), 1.0, true), 20);
    // 0.5 s later it has moved 0.1 m.
    assert_eq!(drive(&mut bench, (0.2, 0.2), 0.5, false), 10);
    assert_eq!(drive(&mut bench, (0.3, 0.2), 0.5, false), 0);
    let (level, text) = bench.condition("scans");
    assert_eq!(level, STALE);
    let rest = "robots rest until it speaks (age.scan)";
    assert!(text.starts_with("robot2's laser is silent for ") && text.ends_with(rest), "{text}");
    assert!(text.contains(" m since: "), "{text}");
    // Robots rest, and it is still not where its laser saw last.
    assert_eq!(drive(&mut bench, (0.4, 0.0), 5.0, false), 0);
    assert!(bench.condition("scans").1.contains("it has moved 0.20 m since"), "{:?}", bench.condition("scans"));
    assert_eq!(drive(&mut bench, (0.4, 0.0), 0.05, true), 1, "it speaks");
    assert_eq!(bench.condition("scans"), (0, "scans are taken".to_owned()));
}

#[test]
fn a_laser_whose_robot_stands_is_lost_or_in_doubt_or_never_spoke_holds_nobody_up() {
    let mut bench = Bench::new(&[TWO]);
    drive(&mut bench, (0.0, 0.2), 1.0, true);
    assert_eq!(drive(&mut bench, (0.2, 0.001), 20.0, false), 400, "it is dead and stands, 0.02 m off for noise");
    // robot1's laser has never spoken. robot2 is carried away, and nobody knows where it is.
    for status in [RobotState::STATUS_LOST, RobotState::STATUS_AMBIGUOUS] {
        let before = sent(&bench);
        for _ in 0..20 {
            bench.seconds += 0.1;
            team(&mut bench, 1.5, status);
            bench.handle(trench_core::Event::Wakeup);
        }
        assert_eq!(sent(&bench) - before, 20);
    }
    // Where it is found again it has as long to speak as ever.
    assert_eq!(drive(&mut bench, (1.5, 0.0), 0.5, false), 10);
    assert_eq!(drive(&mut bench, (1.5, 0.0), 1.0, false), 0);
    // Switched off.
    let mut blind = Bench::new(&[TWO, ("age.scan", "0.0")]);
    drive(&mut blind, (0.0, 0.2), 1.0, true);
    assert_eq!(drive(&mut blind, (0.2, 0.2), 2.0, false), 40);
}

#[test]
fn silence_that_makes_no_sense_is_refused() {
    let check = |given: &[(&str, &str)], expected: &str| {
        let node = obstacle_mapper::description();
        let settings: Vec<Setting<'_>> =
            given.iter().map(|(name, value)| Setting::Override { node: None, name, value }).collect();
        let error = match resolve(&settings, "/", node.name, &(node.parameters)()) {
            Ok(parameters) => {
                let context = trench_core::NodeContext::default();
                (node.build)(&context, &parameters, &super::NoFiles).err().map(|error| error.to_string())
            }
            Err(errors) => errors.first().map(ToString::to_string),
        };
        let error = error.unwrap_or_default();
        assert!(error.contains(expected), "{error}");
    };
    check(&[("sources", "-1")], "sources = -1");
    check(&[("sources", "1.5")], "sources");
    check(&[("age.sources", "0.0")], "age.sources = 0.0");
    check(&[("age.sources", ".nan")], "age.sources");
    check(&[("age.scan", "-0.5")], "age.scan = -0.5");
    check(
        &[("age.scan", "0.01")],
        "age.scan = 0.01: is shorter than from one scan to the next; write 0.1 or more, or 0 for never",
    );
    check(&[("age.scan", "2.0"), ("scan.memory", "1.0")], "age.scan = 2.0: is longer than scan.memory = 1");
}
