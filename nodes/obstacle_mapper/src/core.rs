//! The node core.

use crate::markers::{PICTURES, Picture};
use crate::report::Report;
use crate::scans::{Clusters, Memory, Watch, check, locate};
use crate::settings::{ScanSettings, Settings, descriptors};
use crate::sources::{Known, Sources};
use crate::team::{Team, Whereabouts};
use std::collections::{BTreeMap, VecDeque};
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Advertise, Condition, Event, Files, Health, Interface, Local, Master, NodeContext, NodeCore, NodeDescription, Qos,
    Refusals, RosTime, Sink, Source, StartError, Steady, Subscribe, Times, resolve_name,
};
use trench_formation::Vector2;
use trench_formation::hull::{ApparentObstacle, Obstacle, combine_unless};
use trench_msgs::Message;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{self, ApparentObstacleArray, ObstacleArray, Point2, TeamState};
use trench_msgs::sensor_msgs::LaserScan;
use trench_msgs::std_msgs::Header;
use trench_msgs::visualization_msgs::MarkerArray;
use trench_optics::Pose2;

/// Ports of subscriptions; the team and the robots' scans are there only if robots are named.
const OBSTACLES: usize = 0;
const TEAM: usize = 1;
const SCANS: usize = 2;

const APPARENT_OBSTACLES: usize = 0;
const MARKERS: usize = 1;
const DIAGNOSTICS: usize = 2;

/// Room for some hundred hulls in shared memory.
const HULLS: Local = Local::SharedMemory { max_len: 65_536 };
/// Scans that wait for the robots' poses.
const MOST_WAITING: usize = 64;
/// How long they wait, s.
const PATIENCE: f64 = 0.3;

/// Combines what all sources tell of.
pub struct ObstacleMapper {
    interface: Interface,
    settings: Settings,
    sources: Sources,
    team: Team,
    /// Who writes /team_state.
    localizer: Master,
    /// Who writes each robot's scans.
    lasers: Vec<Master>,
    /// Scans that are newer than the last team state, with the robot and when they came.
    waiting: VecDeque<(usize, LaserScan, Steady)>,
    memory: Memory,
    /// Whose lasers have fallen silent.
    watch: Watch,
    clusters: Clusters,
    health: Health,
    of_obstacles: Report,
    of_scans: Report,
    /// Messages on /team_state that are none or from the future, and those of publishers that do not count.
    refusals: Refusals,
    scans_taken: u64,
    wakeup: Option<Steady>,
    last_picture: Option<Steady>,
    points: Vec<Vector2<f64>>,
}

/// The node as processes and the simulator make it.
#[must_use]
pub fn description() -> NodeDescription {
    NodeDescription {
        name: "obstacle_mapper",
        about: "Turns obstacles into apparent obstacles: convex hulls, combined where no robot passes between them",
        parameters: descriptors,
        build: |context, parameters, files| Ok(Box::new(ObstacleMapper::new(context, parameters, files)?)),
    }
}

impl ObstacleMapper {
    /// A mapper that knows of nothing yet.
    ///
    /// # Errors
    /// When a parameter is not admissible.
    pub fn new(context: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Self, StartError> {
        let settings = Settings::read(parameters)?;
        let mut subscriptions = vec![Subscribe::to::<ObstacleArray>("/obstacles", Qos::RELIABLE)];
        if !settings.robots.is_empty() {
            subscriptions.push(Subscribe::to::<TeamState>("/team_state", Qos::RELIABLE));
        }
        subscriptions.extend(
            settings.robots.iter().map(|robot| Subscribe::to::<LaserScan>(format!("/{robot}/scan"), Qos::SENSOR)),
        );
        let interface = Interface {
            subscriptions,
            publications: vec![
                Advertise::of::<ApparentObstacleArray>("/apparent_obstacles", Qos::RELIABLE, HULLS),
                Advertise::of::<MarkerArray>("/markers", Qos::RELIABLE, Local::NetworkOnly),
                Advertise::of::<DiagnosticArray>("/diagnostics", Qos::RELIABLE, Local::NetworkOnly),
            ],
            ..Interface::default()
        };
        Ok(Self {
            interface,
            lasers: vec![Master::default(); settings.robots.len()],
            settings,
            sources: Sources::default(),
            team: Team::default(),
            localizer: Master::default(),
            waiting: VecDeque::new(),
            memory: Memory::default(),
            watch: Watch::default(),
            clusters: Clusters::default(),
            health: Health::new(resolve_name("~", &context.namespace, &context.name)),
            of_obstacles: Report::new("obstacles"),
            of_scans: Report::new("scans"),
            refusals: Refusals::default(),
            scans_taken: 0,
            wakeup: None,
            last_picture: None,
            points: Vec::new(),
        })
    }

    /// A cycle: all that is known now, combined. While somebody is silent who must speak, hulls would be without what only that one
    /// knows of, and as fresh as ever: none go out, so that controllers rest.
    fn publish(&mut self, at: Times, sink: &mut dyn Sink) {
        self.wakeup = Some(at.steady.plus_seconds(self.settings.period));
        self.sources.forget(at);
        let waits = self.waits(at, sink);
        self.memory.expire(at.steady, self.settings.scans.memory);
        let mut known: Vec<Known> = self.sources.at(at).collect();
        let ScanSettings { gap, longest, .. } = self.settings.scans;
        let mut walls = BTreeMap::new();
        for boundary in self.clusters.find(&mut self.memory, gap, longest, self.settings.clearance) {
            walls.extend(boundary.wall.map(|wall| (boundary.known.id, wall)));
            known.push(boundary.known);
        }
        let adjoin = |a: u32, b: u32| walls.get(&a).is_some_and(|wall| walls.get(&b) == Some(wall));
        let obstacles: Vec<Obstacle> =
            known.iter().map(|known| Obstacle { id: known.id, shape: known.shape.clone() }).collect();
        let combined = match combine_unless(&obstacles, self.settings.clearance, adjoin) {
            Ok(combined) => combined,
            Err(error) => {
                self.health.set("hulls", Condition::Error, error.to_string());
                return;
            }
        };
        let apparent: Vec<msg::ApparentObstacle> = combined.iter().map(|one| to_message(one, &known)).collect();
        self.diagnose(apparent.len());
        if self.last_picture.is_none_or(|last| at.steady.seconds_since(last) >= PICTURES) {
            let picture = Picture { apparent: &apparent, known: &known, memory: &self.memory };
            if let Some(markers) = picture.markers(at.ros) {
                self.last_picture = Some(at.steady);
                sink.publish(MARKERS, &markers);
            }
        }
        if waits {
            return;
        }
        let header = Header { stamp: at.ros.into(), frame_id: "map".to_owned() };
        let clearance = self.settings.clearance;
        let members = known.iter().map(Known::to_message).collect();
        sink.publish(APPARENT_OBSTACLES, &ApparentObstacleArray { header, clearance, obstacles: apparent, members });
    }

    /// Whether somebody is silent who must speak; says who.
    fn waits(&mut self, at: Times, sink: &mut dyn Sink) -> bool {
        let Settings { sources, source_age, scan_age, ref robots, .. } = self.settings;
        let untold = self.sources.silence(at, sources, source_age);
        let unseen = self.watch.silence(at.steady, scan_age, robots, &self.team);
        // Both are told of.
        self.of_obstacles.wait(at.steady, untold, &mut self.health, sink)
            | self.of_scans.wait(at.steady, unseen, &mut self.health, sink)
    }

    fn diagnose(&mut self, hulls: usize) {
        let message = format!("{hulls} of {} obstacles", self.sources.len());
        self.health.set("hulls", Condition::Ok, message);
        match self.sources.orphans() {
            0 => {}
            orphans => {
                let message = format!("{orphans} publishers have gone, nobody knows which: all obstacles are kept");
                self.health.set("hulls", Condition::Warn, message);
            }
        }
        if !self.settings.robots.is_empty() {
            self.health.value("hulls", "cells", self.memory.cells.len());
            self.health.value("hulls", "scans", self.scans_taken);
        }
    }

    fn obstacles(&mut self, at: Times, gid: [u8; 16], cdr: &[u8], sink: &mut dyn Sink) {
        match ObstacleArray::decode(cdr) {
            Ok(message) => {
                for complaint in self.sources.take(at, gid, &message) {
                    self.of_obstacles.refuse(&complaint, &mut self.health, sink);
                }
                if self.sources.complaints().next().is_none() {
                    self.of_obstacles.accept("all are taken", &mut self.health);
                }
                self.publish(at, sink);
            }
            Err(error) => {
                let what = format!("a message on /obstacles was dropped: {error}");
                self.of_obstacles.refuse(&what, &mut self.health, sink);
            }
        }
    }

    fn poses(&mut self, at: Times, source: Source, cdr: &[u8], sink: &mut dyn Sink) {
        let admitted = TeamState::decode(cdr).map_err(|error| error.to_string()).and_then(|message| {
            self.localizer.check(source, at.steady, Master::SILENCE).map_err(|error| error.to_string())?;
            timely(at, &message.header)?;
            self.localizer.pin(source, at.steady);
            Ok(message)
        });
        match admitted {
            Ok(message) => {
                self.team.take(&message);
                self.watch.excuse(at.steady, &self.settings.robots, &self.team);
                self.take_scans(at, sink);
            }
            Err(error) => {
                self.refusals.tell_dropped(at.steady, (&self.interface, TEAM), error, &mut self.health, sink);
            }
        }
    }

    fn scan(&mut self, at: Times, port: usize, source: Source, cdr: &[u8], sink: &mut dyn Sink) {
        let robot = port.saturating_sub(SCANS);
        let Some(laser) = self.lasers.get_mut(robot) else { return };
        if let Err(error) = laser.check(source, at.steady, Master::SILENCE) {
            return self.refusals.tell_dropped(at.steady, (&self.interface, port), error, &mut self.health, sink);
        }
        let checked = LaserScan::decode(cdr).map_err(|error| error.to_string()).and_then(|scan| {
            check(&scan)?;
            timely(at, &scan.header)?;
            Ok(scan)
        });
        match checked {
            Ok(scan) => {
                laser.pin(source, at.steady);
                if self.waiting.len() == MOST_WAITING {
                    self.waiting.pop_front();
                }
                self.waiting.push_back((robot, scan, at.steady));
                self.take_scans(at, sink);
            }
            Err(reason) => {
                let name = self.settings.robots.get(robot).map_or("?", String::as_str);
                let what = format!("a scan of {name} was dropped: {reason}");
                self.of_scans.refuse(&what, &mut self.health, sink);
            }
        }
    }

    /// Takes the scans whose robots' poses are known by now.
    fn take_scans(&mut self, at: Times, sink: &mut dyn Sink) {
        let mut known: Option<Vec<Known>> = None;
        for (robot, scan, came) in std::mem::take(&mut self.waiting) {
            let Some(name) = self.settings.robots.get(robot) else { continue };
            let stamp = RosTime::from(&scan.header.stamp);
            let pose = match self.team.whereabouts(name, stamp) {
                Whereabouts::Later if at.steady.seconds_since(came) <= PATIENCE => {
                    self.waiting.push_back((robot, scan, came));
                    continue;
                }
                Whereabouts::At(pose) => pose,
                Whereabouts::Later | Whereabouts::Unknown => {
                    let what = format!("a scan of {name} was dropped: where it was taken is not known");
                    self.of_scans.refuse(&what, &mut self.health, sink);
                    continue;
                }
            };
            let known = known.get_or_insert_with(|| self.sources.at(at).collect());
            let bodies: Vec<Pose2> = self.team.all(stamp).collect();
            let beams = locate(&scan, pose, &bodies, known, &self.settings.scans, &mut self.points);
            let all = self.memory.see(at.steady, &self.points);
            self.memory.clear(at.steady, &beams);
            self.watch.saw(robot, came, pose);
            self.scans_taken += 1;
            if all {
                self.of_scans.accept("scans are taken", &mut self.health);
            } else {
                self.of_scans.refuse("lasers see more than there is memory for", &mut self.health, sink);
            }
        }
    }
}

/// Whether what a message tells of can have been by now.
fn timely(at: Times, header: &Header) -> Result<(), String> {
    at.timely(RosTime::from(&header.stamp)).map_err(|_| "its stamp is in the future".to_owned())
}

/// An apparent obstacle with the velocity of its fastest member.
fn to_message(apparent: &ApparentObstacle, known: &[Known]) -> msg::ApparentObstacle {
    let members = known.iter().filter(|known| apparent.members.contains(&known.id));
    let velocity = members.map(|known| known.velocity).max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
    let velocity = velocity.unwrap_or_default();
    let outline = apparent.shape.outline();
    msg::ApparentObstacle {
        id: apparent.id,
        hull: outline.points.iter().map(|point| Point2 { x: point.x, y: point.y }).collect(),
        radius: outline.radius,
        velocity: Point2 { x: velocity.x, y: velocity.y },
        members: apparent.members.clone(),
    }
}

impl NodeCore for ObstacleMapper {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Started | Event::Wakeup => self.publish(at, sink),
            Event::Matched { port: OBSTACLES, writers } => self.sources.connected(writers),
            Event::Message { port: OBSTACLES, source, cdr, .. } => self.obstacles(at, source.gid, cdr, sink),
            Event::Message { port: TEAM, source, cdr, .. } => self.poses(at, source, cdr, sink),
            Event::Message { port, source, cdr, .. } => self.scan(at, port, source, cdr, sink),
            _ => {}
        }
        self.refusals.settle(at.steady, &mut self.health);
        self.health.publish(at, DIAGNOSTICS, sink);
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.wakeup
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        self.settings = Settings::read(parameters)?;
        Ok(())
    }
}
