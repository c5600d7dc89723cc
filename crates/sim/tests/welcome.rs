//! Robots with a key that are switched off and on: what was recorded drives none of them.
#![expect(clippy::unwrap_used, reason = "a test ends where what it needs is missing")]

use trench_optics::Pose2;
use trench_radio::{
    COUNTER_TICK, Commands, Key, LinkFrame, Packet, Payload, RelayList, Relaying, StreamDecoder, Welcome, WheelTimer,
    Wheels,
};
use trench_sim::{Bed, BedSetup, Body, Fault, FaultKind, Faults, Field, Laser, MediumSetup, Output, Shutter};

const MS: u64 = 1_000_000;
const START: u64 = 5_000 * MS;

fn key() -> Key {
    Key::new([9; 16])
}

/// Robots 1 to 3 side by side, all heading along x.
fn setup(key: Option<Key>, faults: Vec<(u64, u64, FaultKind)>) -> BedSetup {
    let fault = |(from, to, kind): (u64, u64, FaultKind)| Fault { from: from * MS, to: to * MS, kind };
    let laser = Laser { period: 100 * MS, range_min: 0.1, range_max: 3.5, field_of_view: 6.2, rays: 36, noise: 0.01 };
    BedSetup {
        start: START,
        seed: 42,
        robots: (1..=3).map(|id| (id, Pose2 { x: 0.4, y: 0.4 * f64::from(id), theta: 0.0 })).collect(),
        body: Body::MRKIT,
        field: Field { width: 2.48, height: 1.83 },
        obstacles: vec![],
        medium: MediumSetup { loss: 0.0, ..MediumSetup::HONEST },
        shutter: Shutter { period: 33_333_333, exposure: 10 * MS, delay: 35 * MS },
        lasers: vec![],
        laser,
        baud: 115_200,
        key,
        nonces: 7,
        faults: Faults::new(faults.into_iter().map(fault).collect()),
    }
}

/// What the base does in a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Host {
    /// Commands everybody 50 mm/s, and welcomes who says hello.
    Drives,
    /// Commands, but welcomes nobody.
    WelcomesNobody,
    /// Is off. Somebody plays all that it said before, welcomes too.
    Recorded,
}

/// The bed with its host.
struct Run {
    bed: Bed,
    key: Option<Key>,
    relays: RelayList,
    ms: u64,
    counter: u64,
    heard: StreamDecoder,
    said: Vec<Vec<u8>>,
    played: usize,
    /// Hellos heard: when, ms, and by whom.
    hellos: Vec<(u64, u8)>,
}

impl Run {
    fn new(setup: BedSetup, relays: &[u8]) -> Self {
        let (key, relays) = (setup.key.clone(), RelayList::new(relays));
        let bed = Bed::new(setup);
        let heard = StreamDecoder::default();
        Self { bed, key, relays, ms: 0, counter: 0, heard, said: vec![], played: 0, hellos: vec![] }
    }

    fn send(&mut self, payload: Payload) {
        self.counter = (self.counter + 1).max(1 + self.ms * MS / COUNTER_TICK);
        let packet = Packet { relayed: 0, relaying: Relaying::by(self.relays), counter: self.counter, payload };
        let (mut bytes, mut line) = (Vec::new(), Vec::new());
        packet.encode(self.key.as_ref(), &mut bytes);
        LinkFrame::Downlink { packet: &bytes }.encode(&mut line);
        self.bed.write_serial(START + self.ms * MS, &line);
        self.said.push(line);
    }

    fn hear(&mut self) -> Vec<(u8, u64)> {
        let mut asked = Vec::new();
        while let Some(output) = self.bed.pop_output() {
            let Output::Serial { bytes, .. } = output else { continue };
            self.heard.push(&bytes, |frame| {
                let LinkFrame::Uplink { packet, .. } = frame else { return };
                let packet = Packet::decode(packet, self.key.as_ref()).unwrap();
                if let Payload::Hello { nonce, report } = packet.payload {
                    asked.push((report.robot, nonce));
                }
            });
        }
        self.hellos.extend(asked.iter().map(|(robot, _)| (self.ms, *robot)));
        asked
    }

    /// Goes on until `end` ms after the start; how far each robot drove, m.
    fn until(&mut self, end: u64, host: Host) -> [f64; 3] {
        let place = |bed: &Bed, robot: usize| bed.world().poses()[robot].x;
        let before: [f64; 3] = std::array::from_fn(|robot| place(&self.bed, robot));
        while self.ms < end {
            self.ms += 1;
            self.bed.advance(START + self.ms * MS);
            let asked = self.hear();
            if host == Host::Drives && !asked.is_empty() {
                self.send(Payload::Welcome(Welcome::new(&asked)));
            }
            if self.ms.is_multiple_of(33) && host != Host::Recorded {
                self.send(forward());
            }
            if host == Host::Recorded && self.ms.is_multiple_of(20) && !self.said.is_empty() {
                let line = self.said[self.played % self.said.len()].clone();
                self.bed.write_serial(START + self.ms * MS, &line);
                self.played += 1;
            }
        }
        std::array::from_fn(|robot| place(&self.bed, robot) - before[robot])
    }
}

/// Everybody at 50 mm/s.
fn forward() -> Payload {
    let wheels = Wheels { left: WheelTimer::from_speed(0.05), right: WheelTimer::from_speed(0.05) };
    let mut commands = Commands { validity_ms: 80, ..Commands::default() };
    commands.wheels[1..=3].fill(Some(wheels));
    Payload::Commands(commands)
}

fn off(from: u64, to: u64) -> (u64, u64, FaultKind) {
    (from, to, FaultKind::Off { robots: vec![1] })
}

#[test]
fn a_robot_switched_on_while_all_of_before_is_played_stands_until_it_is_welcomed() {
    for (key, obeys_records) in [(Some(key()), false), (None, true)] {
        let mut run = Run::new(setup(key, vec![off(1000, 1300)]), &[]);
        let [one, two, _] = run.until(1000, Host::Drives);
        assert!(one > 0.035 && two > 0.035, "all were welcomed within the first rounds: {one} {two}");
        run.until(1200, Host::Drives);
        let [one, two, three] = run.until(3500, Host::Recorded);
        // The others roll on for as long as the last command was valid.
        assert!(one < 0.006 && three < 0.006, "{one} {three}");
        assert_eq!(two > 0.0, obeys_records, "{two} m");
        let [one, two, _] = run.until(4500, Host::Drives);
        // 50 mm in a second, but for a round until it says hello.
        assert!(one > 0.046 && two > 0.040, "{one} {two}");
        assert!(two < 0.051);
    }
}

#[test]
fn it_says_hello_in_each_slot_until_it_is_welcomed() {
    let mut run = Run::new(setup(Some(key()), vec![]), &[]);
    assert_eq!(run.until(1000, Host::WelcomesNobody), [0.0; 3]);
    for robot in 1..=3 {
        assert!((9..=10).contains(&run.hellos.iter().filter(|(_, other)| *other == robot).count()));
    }
    run.hellos.clear();
    assert!(run.until(2000, Host::Drives).iter().all(|way| *way > 0.040));
    assert!(run.hellos.len() <= 3, "once each: {:?}", run.hellos);
}

/// Robot 2 hears robots alone, not the base station; robot 1 passes on. Two are switched on at once.
#[test]
fn hello_and_welcome_are_relayed() {
    let far = (0, 9000, FaultKind::Far { robots: vec![1] });
    let both = (1000, 1300, FaultKind::Off { robots: vec![0, 1] });
    let mut run = Run::new(setup(Some(key()), vec![far.clone(), both.clone()]), &[1]);
    run.until(500, Host::Drives);
    assert!(run.until(1000, Host::Drives)[1] > 0.022);
    run.until(1300, Host::Drives);
    // First robot 1 is welcomed, then it passes on what robot 2 says.
    run.until(1700, Host::Drives);
    assert!(run.until(2700, Host::Drives).iter().all(|way| *way > 0.045));
    let mut alone = Run::new(setup(Some(key()), vec![far, both]), &[]);
    assert_eq!(alone.until(2700, Host::Drives)[1], 0.0, "nobody passes on");
}

#[test]
fn numbers_differ_between_lives_robots_and_processes_alone() {
    let drawn = |nonces: u64| {
        let mut setup = setup(Some(key()), vec![off(200, 300), off(500, 600)]);
        setup.nonces = nonces;
        let mut run = Run::new(setup, &[]);
        let mut numbers = Vec::new();
        while run.ms < 1000 {
            run.ms += 1;
            run.bed.advance(START + run.ms * MS);
            numbers.extend(run.hear());
        }
        numbers
    };
    let (one, again, other) = (drawn(1), drawn(1), drawn(2));
    assert_eq!(one, again);
    let mut all: Vec<u64> = one.iter().chain(&other).map(|(_, nonce)| *nonce).collect();
    let count = all.len();
    assert!(count > 50, "{count}");
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), count);
}

/// Counts from its switch on: time and steps.
#[test]
fn a_robot_switched_on_anew_counts_from_zero() {
    let mut run = Run::new(setup(None, vec![off(1000, 1300)]), &[]);
    let mut last = [None; 4];
    while run.ms < 1450 {
        let end = run.ms + 1;
        // Commands as ever; what it hears is looked at here.
        run.ms = end;
        run.bed.advance(START + end * MS);
        while let Some(output) = run.bed.pop_output() {
            let Output::Serial { bytes, .. } = output else { continue };
            run.heard.push(&bytes, |frame| {
                let LinkFrame::Uplink { packet, .. } = frame else { return };
                let report = *Packet::decode(packet, None).unwrap().payload.report().unwrap();
                last[usize::from(report.robot)] = Some(report);
            });
        }
        if end.is_multiple_of(33) && end < 1300 {
            run.send(forward());
        }
    }
    let (one, two) = (last[1].unwrap(), last[2].unwrap());
    assert!(one.uptime_ms > 1300 && one.steps_left > 0, "{one:?}");
    assert!(two.uptime_ms <= 150 && two.steps_left == 0, "{two:?}");
}
