//! The whole test bed: world, camera shutter, serial line, base station, air, firmware, in the order of time.

use crate::air::{Air, Station};
use crate::base_station::BaseStation;
use crate::fault::{Cuts, FaultKind, Faults, Intrusion};
use crate::firmware::Sensors;
use crate::medium::MediumSetup;
use crate::serial_line::SerialLine;
use crate::setup::{BedSetup, Shutter};
use crate::switch::{Robot, Switched};
use crate::world::STEP;
use crate::{Contact, Laser, Obstacle, Random, Truth, World, battery};
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use trench_optics::Pose2;
use trench_radio::{MAX_ROBOTS, Ranges, TELEMETRY_ROUND};

/// Instants of an exposure at which the robots are drawn.
const INSTANTS: usize = 4;

/// What comes out of the test bed.
#[derive(Debug, Clone, PartialEq)]
pub enum Output {
    /// Bytes from the base station have arrived at the host.
    Serial {
        /// When, ns.
        at: u64,
        /// The bytes.
        bytes: Vec<u8>,
    },
    /// A frame of the camera can be read.
    Frame(Frame),
    /// Bodies touch.
    Contact(Contact),
    /// A robot's laser has looked round.
    Scan(Scan),
}

/// What a laser measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// When, ns.
    pub at: u64,
    /// Index of the robot.
    pub robot: usize,
    /// m, counter-clockwise; see [`Laser`].
    pub ranges: Vec<f32>,
}

/// What the camera saw.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Counts from 0.
    pub number: u64,
    /// The middle of the exposure, ns.
    pub exposed_at: u64,
    /// When the frame can be read, ns.
    pub ready_at: u64,
    /// For each robot its poses at equally spaced instants of the exposure.
    pub exposure: Vec<Vec<Pose2>>,
    /// For each robot its state at the middle of the exposure.
    pub truth: Vec<Truth>,
    /// What stood in the field.
    pub obstacles: Vec<Obstacle>,
}

/// A packet that a relay sends on when its turn comes.
#[derive(Debug, Clone)]
struct Waiting {
    robot: usize,
    for_base: bool,
    packet: Arc<[u8]>,
}

/// The test bed. What happens in it depends on the times of the bytes written alone, not on how often it is advanced.
#[derive(Debug, Clone)]
pub struct Bed {
    world: World,
    robots: Vec<Robot>,
    air: Air,
    relayed: BTreeMap<(u64, u64), Waiting>,
    relays: u64,
    base: BaseStation,
    from_host: SerialLine,
    to_host: SerialLine,
    shutter: Shutter,
    lasers: Vec<usize>,
    laser: Laser,
    laser_noise: Random,
    start: u64,
    faults: Faults,
    /// How well the air carries without faults.
    medium: MediumSetup,
    /// When faults were put into force last and when they change next, ns.
    faults_since: Option<u64>,
    faults_until: u64,
    exposed: u64,
    scanned: u64,
    reports: Vec<u64>,
    frames: VecDeque<Frame>,
    outputs: VecDeque<Output>,
}

/// What is due next, in the order in which things of one instant happen: all of them after the world's step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Due {
    Exposed,
    Scanned,
    FrameReady,
    HostByte,
    AtRobot,
    Relayed,
    Report(usize),
    AtBase,
    ToHost,
}

impl Bed {
    /// Everything at rest at `setup.start`. The first frame is exposed one period later.
    #[must_use]
    pub fn new(setup: BedSetup) -> Self {
        let BedSetup {
            start,
            seed,
            robots,
            body,
            field,
            obstacles,
            medium,
            shutter,
            lasers,
            laser,
            baud,
            key,
            nonces,
            faults,
        } = setup;
        let poses = robots.iter().map(|(_, pose)| *pose).collect();
        let recorded = faults.any(|kind| matches!(kind, FaultKind::Intruder(Intrusion::Recorded)));
        let slot = |id: u8| start + u64::from(id) * (TELEMETRY_ROUND / MAX_ROBOTS as u64);
        Self {
            world: World::new(start, body, field, obstacles, poses),
            robots: robots.iter().map(|&(id, _)| Robot::new(id, key.clone(), start, nonces)).collect(),
            air: Air::new(medium, seed, start, recorded),
            relayed: BTreeMap::new(),
            relays: 0,
            base: BaseStation::default(),
            from_host: SerialLine::new(baud),
            to_host: SerialLine::new(baud),
            shutter,
            lasers,
            laser,
            laser_noise: Random::new(seed, 3),
            start,
            faults,
            medium,
            faults_since: None,
            faults_until: start,
            exposed: 0,
            scanned: 0,
            reports: robots.iter().map(|&(id, _)| slot(id)).collect(),
            frames: VecDeque::new(),
            outputs: VecDeque::new(),
        }
    }

    /// The world.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The world, for those who interfere with it.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The base station, for those who count its errors.
    #[must_use]
    pub fn base_station(&self) -> &BaseStation {
        &self.base
    }

    /// The air becomes better or worse.
    pub fn set_medium(&mut self, setup: MediumSetup) {
        self.medium = setup;
        self.air.set(setup, self.world.now());
    }

    /// The host writes to the line at time `now`, up to which the bed must have been advanced.
    pub fn write_serial(&mut self, now: u64, bytes: &[u8]) {
        self.from_host.write(now, bytes);
    }

    /// Lets time go on to `to` (ns), that instant included.
    pub fn advance(&mut self, to: u64) {
        loop {
            let next = self.dues().min().filter(|(at, _)| *at <= to);
            let until = next.map_or(to, |(at, _)| at);
            // Steps make nothing due: it is looked for between them no more than needed.
            while self.world.now() + STEP <= until {
                self.step();
            }
            let Some((at, due)) = next else { return };
            self.happen(at, due);
        }
    }

    /// Takes the next output, in the order of time.
    pub fn pop_output(&mut self) -> Option<Output> {
        self.outputs.pop_front()
    }

    /// Nothing comes out before this time unless bytes are written, ns.
    #[must_use]
    pub fn next_output(&self) -> Option<u64> {
        let relays = || self.robots.iter().any(|robot| robot.is_relay(self.world.now()));
        let silent = |due: &Due| matches!(due, Due::Exposed) || matches!(due, Due::AtRobot) && !relays();
        let frame = self.frame_ready();
        self.dues().filter(|(_, due)| !silent(due)).map(|(at, _)| at).chain([frame]).min()
    }

    fn exposure_middle(&self) -> u64 {
        self.start + (self.exposed + 1) * self.shutter.period
    }

    /// From the middle of an exposure until it is over and the world has stepped beyond it, ns.
    fn exposure_end(&self) -> u64 {
        self.shutter.exposure / 2 + STEP
    }

    fn frame_ready(&self) -> u64 {
        self.exposure_middle() + self.shutter.delay.max(self.exposure_end())
    }

    fn dues(&self) -> impl Iterator<Item = (u64, Due)> {
        let reports = self.reports.iter().enumerate().map(|(robot, at)| (*at, Due::Report(robot)));
        let line = |line: &SerialLine, due| line.next_arrival().map(|at| (at, due));
        let next_scan = self.start + (self.scanned + 1) * self.laser.period;
        let scan = (!self.lasers.is_empty()).then_some((next_scan, Due::Scanned));
        [
            Some((self.exposure_middle() + self.exposure_end(), Due::Exposed)),
            scan,
            self.frames.front().map(|frame| (frame.ready_at, Due::FrameReady)),
            line(&self.from_host, Due::HostByte),
            self.air.next_at_robot().map(|at| (at, Due::AtRobot)),
            self.relayed.keys().next().map(|(at, _)| (*at, Due::Relayed)),
            self.air.next_at_base().map(|at| (at, Due::AtBase)),
            line(&self.to_host, Due::ToHost),
        ]
        .into_iter()
        .flatten()
        .chain(reports)
    }

    fn happen(&mut self, at: u64, due: Due) {
        match due {
            Due::Exposed => self.expose(),
            Due::Scanned => self.scan(at),
            Due::FrameReady => self.outputs.extend(self.frames.pop_front().map(Output::Frame)),
            Due::HostByte => self.hear_host(at),
            Due::AtRobot => self.hear_at_robot(at),
            Due::Relayed => {
                if let Some((_, waiting)) = self.relayed.pop_first() {
                    let from = Station::Robot(waiting.robot);
                    self.air.send(at, from, self.world.poses(), &waiting.packet, waiting.for_base);
                }
            }
            Due::Report(robot) => self.report(at, robot),
            Due::AtBase => self.hear_robot(at),
            Due::ToHost => self.outputs.extend(self.to_host.read().map(|(at, bytes)| Output::Serial { at, bytes })),
        }
    }

    /// The motors turn for a millisecond as the firmware told them at its beginning.
    fn step(&mut self) {
        self.world.step();
        let now = self.world.now();
        if now >= self.faults_until {
            self.put_faults_into_force();
        }
        for (index, robot) in self.robots.iter_mut().enumerate() {
            let wheels = robot.wheels(now);
            self.world.tell(index, [wheels.left.speed(), wheels.right.speed()]);
        }
        self.outputs.extend(self.world.take_contacts().into_iter().map(Output::Contact));
    }

    /// The faults of this instant begin, those before are over.
    fn put_faults_into_force(&mut self) {
        let now = self.world.now();
        let time = now - self.start;
        for robot in 0..self.robots.len() {
            self.world.set_grip(robot, [1.0; 2]);
            self.world.set_missing(robot, 0.0);
        }
        for (robot, pose) in self.faults.carried(self.faults_since, time) {
            self.world.place(robot, pose);
        }
        let (mut cuts, mut medium, mut intrusion) = (Cuts::default(), self.medium, None);
        let ids: Vec<u8> = self.robots.iter().map(Robot::own_id).collect();
        let mut switched: Vec<Switched> = ids.iter().map(|id| Switched::On(*id)).collect();
        for fault in self.faults.at(time) {
            match fault {
                FaultKind::Slip { robots, grip } => robots.iter().for_each(|robot| self.world.set_grip(*robot, *grip)),
                FaultKind::Missed { robots, share } => {
                    robots.iter().for_each(|robot| self.world.set_missing(*robot, *share));
                }
                FaultKind::Silent { robots } => cuts.silent.extend(robots),
                FaultKind::Off { robots } => {
                    cuts.silent.extend(robots);
                    for robot in robots {
                        switched.get_mut(*robot).into_iter().for_each(|state| *state = Switched::Off);
                    }
                }
                FaultKind::Doubled { robot, like } => {
                    if let (Some(state), Some(id)) = (switched.get_mut(*robot), ids.get(*like)) {
                        *state = Switched::On(*id);
                    }
                }
                FaultKind::Far { robots } => cuts.far.extend(robots),
                FaultKind::Intruder(kind) => intrusion = Some(*kind),
                FaultKind::Parted { robots } => cuts.parted.push(robots.iter().copied().collect()),
                FaultKind::Loss { loss } => medium.loss = *loss,
                FaultKind::Carried { .. }
                | FaultKind::Battery { .. }
                | FaultKind::Covered { .. }
                | FaultKind::Frames(_)
                | FaultKind::Untold
                | FaultKind::Blind { .. } => {}
            }
        }
        for (index, (robot, state)) in self.robots.iter_mut().zip(switched).enumerate() {
            let wheels = self.world.wheels(index).copied().unwrap_or_default();
            robot.switch(state, now, wheels);
        }
        self.air.cut(cuts);
        self.air.intrude(intrusion);
        if self.air.setup() != medium {
            self.air.set(medium, now);
        }
        self.faults_since = Some(time);
        self.faults_until = self.faults.next_change(time).map_or(u64::MAX, |change| self.start + change);
    }

    /// The faults at `at` (ns).
    pub fn faults_at(&self, at: u64) -> impl Iterator<Item = &FaultKind> {
        self.faults.at(at.saturating_sub(self.start))
    }

    fn battery(&self, now: u64, robot: usize) -> u16 {
        let fault = self.faults_at(now).find_map(|fault| match fault {
            FaultKind::Battery { robots, millivolts } if robots.contains(&robot) => Some(*millivolts),
            _ => None,
        });
        fault.unwrap_or_else(|| battery::millivolts(now - self.start))
    }

    fn expose(&mut self) {
        let (middle, exposure) = (self.exposure_middle(), self.shutter.exposure);
        let robots = 0..self.robots.len();
        // The middles of equal parts of the exposure.
        let instant = |part: usize| middle - exposure / 2 + exposure * (2 * part as u64 + 1) / (2 * INSTANTS as u64);
        let truth = |robot: usize, at: u64| self.world.truth(robot, at).unwrap_or_default();
        let poses = |robot: usize| (0..INSTANTS).map(|part| truth(robot, instant(part)).pose).collect();
        self.frames.push_back(Frame {
            number: self.exposed,
            exposed_at: middle,
            ready_at: self.frame_ready(),
            exposure: robots.clone().map(poses).collect(),
            truth: robots.map(|robot| truth(robot, middle)).collect(),
            obstacles: self.world.obstacles().to_vec(),
        });
        self.exposed += 1;
    }

    fn scan(&mut self, at: u64) {
        self.scanned += 1;
        for &robot in &self.lasers {
            let ranges = self.world.scan(robot, &self.laser, &mut self.laser_noise);
            self.outputs.push_back(Output::Scan(Scan { at, robot, ranges }));
        }
    }

    fn hear_host(&mut self, now: u64) {
        let Some((_, bytes)) = self.from_host.read() else { return };
        let (mut packets, mut replies) = (Vec::<Arc<[u8]>>::new(), Vec::new());
        self.base.from_host(&bytes, |packet| packets.push(packet.into()), &mut replies);
        self.to_host.write(now, &replies);
        for packet in packets {
            self.air.send(now, Station::Base, self.world.poses(), &packet, false);
        }
    }

    fn report(&mut self, now: u64, robot: usize) {
        self.reports[robot] += TELEMETRY_ROUND;
        let wheels = self.world.wheels(robot).copied().unwrap_or_default();
        let (battery_mv, ranges) = (self.battery(now, robot), Ranges::new(&self.world.ranges(robot)));
        let mut packet = Vec::new();
        if let Some(robot) = self.robots.get_mut(robot) {
            let (steps, lost_steps) = robot.counted(wheels);
            robot.report(now, Sensors { battery_mv, steps, lost_steps, ranges }, &mut packet);
        }
        self.air.send(now, Station::Robot(robot), self.world.poses(), &packet.into(), true);
    }

    fn hear_at_robot(&mut self, now: u64) {
        let Some(flying) = self.air.pop_at_robot() else { return };
        let Some(robot) = self.robots.get_mut(flying.robot) else { return };
        if let Some(relayed) = robot.receive(now, &flying.packet, flying.signal_dbm) {
            self.relays += 1;
            let (robot, for_base, packet) = (flying.robot, relayed.for_base, relayed.packet.into());
            self.relayed.insert((now + relayed.after, self.relays), Waiting { robot, for_base, packet });
        }
    }

    fn hear_robot(&mut self, now: u64) {
        let Some(flying) = self.air.pop_at_base() else { return };
        let mut line = Vec::new();
        self.base.from_robot(&flying.packet, flying.signal_dbm, self.to_host.backlog(now), &mut line);
        self.to_host.write(now, &line);
    }
}
