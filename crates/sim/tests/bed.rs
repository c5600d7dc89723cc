//! The test bed as a whole: from serial bytes to moving robots and back.
#![expect(clippy::unwrap_used, reason = "a test ends where what it needs is missing")]

use proptest::prelude::*;
use trench_optics::Pose2;
use trench_radio::{
    AckStatus, COUNTER_TICK, Commands, Fault, LinkFrame, Packet, Payload, RelayList, Relaying, RobotSet, StreamDecoder,
    Telemetry, WheelTimer, Wheels,
};
use trench_sim::{
    Bed, BedSetup, Body, Faults, Field, Laser, MediumSetup, Motor, Obstacle, Output, Scan, Shutter, Thing, camera,
};

const MS: u64 = 1_000_000;
const START: u64 = 5_000 * MS;

fn setup(robots: &[Pose2]) -> BedSetup {
    BedSetup {
        start: START,
        seed: 42,
        robots: robots.iter().enumerate().map(|(index, pose)| (index as u8 + 1, *pose)).collect(),
        body: Body::MRKIT,
        field: Field { width: 2.48, height: 1.83 },
        obstacles: vec![],
        medium: MediumSetup::HONEST,
        shutter: Shutter { period: 33_333_333, exposure: 10 * MS, delay: 35 * MS },
        lasers: vec![],
        laser: Laser {
            period: 100 * MS,
            range_min: 0.1,
            range_max: 3.5,
            field_of_view: std::f64::consts::TAU,
            rays: 36,
            noise: 0.01,
        },
        baud: 115_200,
        key: None,
        nonces: 7,
        faults: Faults::default(),
    }
}

fn pose(x: f64, y: f64, theta: f64) -> Pose2 {
    Pose2 { x, y, theta }
}

fn packet(counter: u64, payload: Payload) -> Vec<u8> {
    relayed(Relaying::Direct, counter, payload)
}

fn relayed(relaying: Relaying, counter: u64, payload: Payload) -> Vec<u8> {
    let (mut bytes, mut line) = (Vec::new(), Vec::new());
    Packet { relayed: 0, relaying, counter, payload }.encode(None, &mut bytes);
    LinkFrame::Downlink { packet: &bytes }.encode(&mut line);
    line
}

/// The counter of a packet that is sent so many ms after the start: counters follow the clock.
fn at_ms(ms: u64) -> u64 {
    1 + ms * MS / COUNTER_TICK
}

/// The same wheel speeds for robots 1 to `count`.
fn drive(counter: u64, count: usize, left: f64, right: f64) -> Vec<u8> {
    let wheels = Wheels { left: WheelTimer::from_speed(left), right: WheelTimer::from_speed(right) };
    let mut commands = Commands { validity_ms: 80, ..Commands::default() };
    commands.wheels[1..=count].fill(Some(wheels));
    packet(counter, Payload::Commands(commands))
}

/// Sends the lines at their times (ms after the start) and gives all outputs up to `end_ms`, the bed advanced at the
/// given times besides.
fn run(setup: BedSetup, lines: &[(u64, Vec<u8>)], end_ms: u64, also_at: &[u64]) -> (Bed, Vec<Output>) {
    let mut bed = Bed::new(setup);
    let mut outputs = Vec::new();
    let mut times: Vec<(u64, Option<&[u8]>)> = also_at.iter().map(|at| (START + at, None)).collect();
    times.extend(lines.iter().map(|(ms, line)| (START + ms * MS, Some(&line[..]))));
    times.push((START + end_ms * MS, None));
    times.sort_by_key(|(at, _)| *at);
    for (at, line) in times.into_iter().filter(|(at, _)| *at <= START + end_ms * MS) {
        bed.advance(at);
        outputs.extend(std::iter::from_fn(|| bed.pop_output()));
        if let Some(line) = line {
            bed.write_serial(at, line);
        }
    }
    (bed, outputs)
}

fn reports(outputs: &[Output]) -> (Vec<Telemetry>, usize) {
    let (mut telemetry, mut sent) = (Vec::new(), 0);
    let mut decoder = StreamDecoder::default();
    for output in outputs {
        let Output::Serial { bytes, .. } = output else { continue };
        decoder.push(bytes, |frame| match frame {
            LinkFrame::Uplink { packet, .. } => match Packet::decode(packet, None).unwrap().payload {
                Payload::Telemetry(report) => telemetry.push(report),
                other => unreachable!("{other:?}"),
            },
            LinkFrame::Ack(ack) => sent += usize::from(ack.status == AckStatus::Sent),
            LinkFrame::Downlink { .. } => unreachable!("the base station sends no downlink"),
        });
    }
    assert_eq!(decoder.errors().total(), 0);
    (telemetry, sent)
}

#[test]
fn robots_drive_stop_by_themselves_and_report() {
    let lines: Vec<_> = (0..30).map(|k| (100 + 33 * k, drive(at_ms(100 + 33 * k), 2, 0.05, 0.05))).collect();
    let (bed, outputs) = run(setup(&[pose(0.5, 0.5, 0.0), pose(0.5, 1.2, 0.3)]), &lines, 2500, &[]);
    let [first, second] = bed.world().poses() else { unreachable!() };
    // 29 intervals of 33 ms and 80 ms of validity: 1.037 s at the speed of the timer nearest to 0.05 m/s.
    assert!((first.x - 0.5 - 1.037 * 0.05).abs() < 0.0008, "{first:?}");
    assert!((second.theta - 0.3).abs() < 1e-9 && second.y > 1.21);
    let (telemetry, sent) = reports(&outputs);
    assert_eq!(sent, 30);
    assert!((45..=50).contains(&telemetry.len()), "25 rounds of two robots less 3 %: {}", telemetry.len());
    let last = telemetry.iter().rfind(|report| report.robot == 1).unwrap();
    assert_eq!(last.fault, Fault::COMMAND_TIMEOUT);
    assert_eq!(u64::from(last.last_counter), at_ms(100 + 33 * 29));
    assert!((27..=30).contains(&last.received), "30 packets less 3 %: {}", last.received);
    assert!((f64::from(last.steps_left) - 1.037 * 0.05 / 4.2412e-4).abs() < 2.0);
    assert_eq!((last.ranges.as_slice().len(), last.battery_mv), (4, 8200));
}

#[test]
fn frames_come_a_period_apart_and_after_the_delay() {
    let (_, outputs) = run(setup(&[pose(0.5, 0.5, 0.0)]), &[(10, drive(1, 1, 0.05, 0.05))], 1000, &[]);
    let frames: Vec<_> = outputs.iter().filter_map(|o| if let Output::Frame(f) = o { Some(f) } else { None }).collect();
    assert_eq!(frames.len(), 28);
    for (index, frame) in frames.iter().enumerate() {
        assert_eq!(frame.number, index as u64);
        assert_eq!(frame.exposed_at, START + 33_333_333 * (index as u64 + 1));
        assert_eq!(frame.ready_at, frame.exposed_at + 35 * MS);
        assert_eq!((frame.exposure.len(), frame.exposure[0].len()), (1, 4));
    }
    // Driving at 0.05 m/s while the second frame is exposed: instants 2.5 ms apart.
    let exposure = &frames[1].exposure[0];
    let blur = exposure[3].x - exposure[0].x;
    assert!((blur - 3.0 * 0.0025 * 0.05).abs() < 2e-6, "{blur}");
}

#[test]
fn emergency_stop_latches_in_every_robot() {
    let mut lines: Vec<_> = (0..60).map(|k| (33 * k, drive(at_ms(33 * k), 3, 0.07, 0.07))).collect();
    lines
        .extend((0..5).map(|k| (500 + 50 * k, packet(at_ms(500 + 50 * k) + 1, Payload::EmergencyStop(RobotSet::ALL)))));
    // Commands that go on with higher counters than the stop's do not release it.
    lines.extend((0..20).map(|k| (760 + 33 * k, drive(at_ms(760 + 33 * k) + 2, 3, 0.07, 0.07))));
    let robots = [pose(0.5, 0.3, 0.0), pose(0.5, 0.8, 0.0), pose(0.5, 1.3, 0.0)];
    let (bed, _) = run(setup(&robots), &lines, 1800, &[]);
    for robot in bed.world().poses() {
        assert!((0.53..0.54).contains(&robot.x), "{robot:?}");
    }
}

#[test]
fn bodies_block_each_other_and_say_so_once() {
    let mut setup = setup(&[pose(0.8, 0.5, 0.0), pose(1.1, 0.5, std::f64::consts::PI), pose(2.3, 1.0, 0.0)]);
    setup.medium = MediumSetup::IDEAL;
    let lines: Vec<_> = (0..100).map(|k| (33 * k, drive(at_ms(33 * k), 3, 0.06, 0.06))).collect();
    let (bed, outputs) = run(setup, &lines, 3500, &[]);
    let contacts: Vec<_> =
        outputs.iter().filter_map(|o| if let Output::Contact(c) = o { Some(c) } else { None }).collect();
    assert_eq!(contacts.len(), 2, "{contacts:?}");
    assert!(matches!(contacts[0].thing, Thing::Robot(_)));
    assert!((contacts[0].at - START).abs_diff(1_180 * MS) < 30 * MS, "{:?}", contacts[0]);
    assert_eq!((contacts[1].robot, contacts[1].thing), (2, Thing::Edge(1)));
    let [first, second, third] = bed.world().poses() else { unreachable!() };
    assert!((second.x - first.x - 0.16).abs() < 2e-4 && second.x - first.x >= 0.16, "{first:?} {second:?}");
    assert!((third.x - 2.4).abs() < 1e-4 && third.x <= 2.4);
}

/// Who begins in somebody or over the edge touches them: a run must not say that there was no contact.
#[test]
fn bodies_that_overlap_at_the_start_touch_from_then_on() {
    let setup = setup(&[pose(0.8, 0.5, 0.0), pose(0.85, 0.5, 0.0), pose(2.45, 1.0, 0.0), pose(1.6, 1.0, 0.0)]);
    let (_, outputs) = run(setup, &[], 500, &[]);
    let contacts: Vec<_> = outputs
        .iter()
        .filter_map(|output| if let Output::Contact(contact) = output { Some(contact) } else { None })
        .map(|contact| (contact.at, contact.robot, contact.thing))
        .collect();
    assert_eq!(contacts, [(START, 1, Thing::Robot(0)), (START, 2, Thing::Edge(1))]);
}

#[test]
fn an_ideal_motor_follows_at_once() {
    let mut ideal = setup(&[pose(0.5, 0.5, 0.0)]);
    ideal.medium = MediumSetup::IDEAL;
    let mut honest = ideal.clone();
    ideal.body.motor = Motor::Ideal;
    honest.body.motor = Motor::HONEST;
    let lines: Vec<_> = (0..30).map(|k| (33 * k, drive(at_ms(33 * k), 1, 0.28, 0.28))).collect();
    let lost = |setup| run(setup, &lines, 1000, &[]).0.world().wheels(0).unwrap()[0].lost;
    assert_eq!(lost(ideal), 0.0);
    assert!(lost(honest) > 80.0);
}

/// Where robot 1 hears the base station, robot 2 hears robot 1 alone, robot 3 hears robot 2 alone.
fn a_line_of_three() -> BedSetup {
    let mut setup = setup(&[pose(0.5, 0.5, 0.0), pose(1.2, 0.5, 0.0), pose(1.9, 0.5, 0.0)]);
    setup.medium = MediumSetup { reach_down: 1.0, reach_up: 1.0, reach_robots: 1.0, loss: 0.0, ..MediumSetup::HONEST };
    setup
}

/// What each robot drove in 2 s, m, and the reports of each that came through.
fn driven(relays: &[u8]) -> [(f64, usize); 3] {
    let start = a_line_of_three();
    let wheels = Wheels { left: WheelTimer::from_speed(0.06), right: WheelTimer::from_speed(0.06) };
    let mut commands = Commands { validity_ms: 80, ..Commands::default() };
    commands.wheels[1..=3].fill(Some(wheels));
    let line = |ms: u64| relayed(Relaying::by(RelayList::new(relays)), at_ms(ms), Payload::Commands(commands));
    let lines: Vec<_> = (0..60).map(|k| (100 + 33 * k, line(100 + 33 * k))).collect();
    let (bed, outputs) = run(start.clone(), &lines, 2500, &[]);
    let (telemetry, _) = reports(&outputs);
    std::array::from_fn(|robot| {
        let count = telemetry.iter().filter(|report| usize::from(report.robot) == robot + 1).count();
        (bed.world().poses()[robot].x - start.robots[robot].1.x, count)
    })
}

#[test]
fn relays_reach_those_who_do_not_hear_the_base_station() {
    let check = |relays: &[u8], reached: usize| {
        for (robot, (way, heard)) in driven(relays).into_iter().enumerate() {
            if robot < reached {
                assert!((0.115..0.125).contains(&way), "relays {relays:?}, robot {}: {way} m", robot + 1);
                // The first rounds are over before anyone is a relay.
                assert!((20..=25).contains(&heard), "relays {relays:?}, robot {}: {heard} reports", robot + 1);
            } else {
                assert_eq!((way, heard), (0.0, 0), "relays {relays:?}, robot {}", robot + 1);
            }
        }
    };
    check(&[], 1);
    check(&[1], 2);
    check(&[1, 2], 3);
    check(&[2], 1);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
    #[test]
    fn what_happens_does_not_depend_on_who_looks(also_at in prop::collection::vec(0..700 * MS, 0..200), speed in -0.3..0.3f64) {
        let lines: Vec<_> = (0..15).map(|k| (20 + 37 * k, drive(at_ms(20 + 37 * k), 2, speed, 0.2))).collect();
        let robots = [pose(0.4, 0.4, 0.0), pose(0.6, 0.55, 2.0)];
        let (bed, outputs) = run(setup(&robots), &lines, 700, &[]);
        let (watched, watched_outputs) = run(setup(&robots), &lines, 700, &also_at);
        prop_assert_eq!(outputs, watched_outputs);
        prop_assert_eq!(bed.world().poses(), watched.world().poses());
    }

    #[test]
    fn nothing_comes_out_before_it_is_announced(steps in prop::collection::vec(1..60 * MS, 1..40)) {
        let mut bed = Bed::new(setup(&[pose(0.4, 0.4, 0.0), pose(1.6, 0.55, 2.0)]));
        let mut now = START;
        for step in steps {
            bed.write_serial(now, &drive(at_ms((now - START) / MS), 2, 0.1, 0.2));
            let announced = bed.next_output().unwrap();
            prop_assert!(announced > now);
            now = now.max(announced - 1).min(now + step);
            bed.advance(now);
            prop_assert_eq!(bed.pop_output().filter(|output| !matches!(output, Output::Contact(_))), None);
            bed.advance(now + step);
            now += step;
            while bed.pop_output().is_some() {}
        }
    }

    #[test]
    fn garbage_on_the_line_moves_nobody(garbage in prop::collection::vec(any::<u8>(), 0..3000)) {
        let (bed, _) = run(setup(&[pose(0.4, 0.4, 0.0)]), &[(1, garbage)], 500, &[]);
        prop_assert_eq!(bed.world().poses(), &[pose(0.4, 0.4, 0.0)]);
    }
}

#[test]
fn obstacles_that_move_push_robots_and_lasers_see_them_come() {
    let mut setup = setup(&[pose(1.0, 1.0, 0.0), pose(2.0, 1.0, 0.0)]);
    let wall = camera::Obstacle { corners: vec![[0.5, 0.8], [0.6, 0.8], [0.6, 1.2], [0.5, 1.2]], radius: 0.0 };
    setup.obstacles = vec![Obstacle::new(9, wall, [0.2, 0.0])];
    setup.lasers = vec![1];
    setup.laser.noise = 0.0;
    let (bed, outputs) = run(setup, &[], 3000, &[]);
    // From 0.6 m on by 0.6 m: the robot at 1 m is pushed on to 1.28 m, and turned by nothing.
    let pushed = bed.world().poses()[0];
    assert!((pushed.x - 1.28).abs() < 1e-3 && pushed.y == 1.0 && pushed.theta == 0.0, "{pushed:?}");
    let contacts: Vec<_> = outputs.iter().filter(|output| matches!(output, Output::Contact(_))).collect();
    assert!(
        matches!(contacts[..], [Output::Contact(contact)] if contact.thing == Thing::Obstacle(0)
        && contact.robot == 0 && contact.at.abs_diff(START + 1600 * MS) <= 2 * MS),
        "{contacts:?}"
    );
    let scans: Vec<&Scan> =
        outputs.iter().filter_map(|output| if let Output::Scan(scan) = output { Some(scan) } else { None }).collect();
    assert_eq!(scans.iter().map(|scan| (scan.at - START) / MS).collect::<Vec<_>>()[..3], [100, 200, 300]);
    assert!(scans.len() == 30 && scans.iter().all(|scan| scan.robot == 1 && scan.ranges.len() == 36));
    // The first ray looks back, at the first robot: 0.92 m away, in the end 0.64 m.
    assert!((scans[0].ranges[0] - 0.92).abs() < 1e-3 && (scans[29].ranges[0] - 0.64).abs() < 1e-3);
}
