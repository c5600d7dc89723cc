//! The state of the picture, message by message.

use crate::alarms::Alarms;
use crate::control::{Control, Monitor};
use crate::formation::{Formation, Goals, Place, Run, places};
use crate::history::History;
use crate::markers::Markers;
use crate::obstacles::Outline;
use crate::shown::Shown;
use crate::team::{Link, Posed, Team};
use crate::{Role, Snapshot, seconds};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use trench_core::RosTime;
use trench_msgs::Message;
use trench_msgs::cdr::CdrError;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{ApparentObstacleArray, LeaderState, LinkStatus, ObstacleArray, RunState, Stability, TeamState};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::std_msgs::Bool;
use trench_msgs::visualization_msgs::MarkerArray;

/// All that is drawn. Messages go in, [`View::snapshot`] gives what browsers get.
#[derive(Debug, Clone, Default)]
pub struct View {
    now: RosTime,
    team: Team,
    run: Run,
    formation: Option<Formation>,
    places: BTreeMap<String, Place>,
    goals: Goals,
    control: BTreeMap<String, Control>,
    stability: BTreeMap<String, Monitor>,
    links: BTreeMap<String, Link>,
    truth: BTreeMap<String, Posed>,
    target: Option<Posed>,
    obstacles: Vec<Outline>,
    hulls: Vec<Outline>,
    emergency_stop: bool,
    markers: Markers,
    alarms: Alarms,
    history: History,
    /// Messages that could not be read.
    undecodable: u64,
    /// When alarms were last looked at: they also change by growing old.
    alarms_seen: Option<RosTime>,
    changed: BTreeSet<&'static str>,
    snapshot: Snapshot,
}

/// Alarms are looked at this often though nothing was said, s.
const LOOK: f64 = 0.5;

impl View {
    /// Takes a message received at `now`. One that cannot be read is counted, and changes nothing.
    pub fn take(&mut self, now: RosTime, role: &Role, cdr: &[u8]) {
        self.now = now;
        if self.decode(now, role, cdr).is_err() {
            self.undecodable += 1;
            self.changed.insert("undecodable");
        }
    }

    /// Time goes on, message or not.
    pub fn advance(&mut self, now: RosTime) {
        self.now = now;
    }

    /// The names of the robots that the last team state told of.
    pub fn robots(&self) -> impl Iterator<Item = &str> {
        self.team.robots.iter().map(|robot| robot.name.as_str())
    }

    fn decode(&mut self, now: RosTime, role: &Role, cdr: &[u8]) -> Result<(), CdrError> {
        let part = match role {
            Role::Team => {
                self.team = Team::of(&TeamState::decode(cdr)?);
                for robot in &self.team.robots {
                    self.history.seen(&robot.name, seconds(now), robot.at);
                }
                "team"
            }
            Role::Goals => {
                self.goals = Goals::of(&Message::decode(cdr)?);
                "goals"
            }
            Role::Formation => {
                self.formation = Some(Formation::of(&Message::decode(cdr)?));
                "formation"
            }
            Role::Assignment => {
                self.places = places(&Message::decode(cdr)?);
                "places"
            }
            Role::RunState => {
                self.run = Run::of(&RunState::decode(cdr)?);
                "run"
            }
            Role::Target => {
                self.target = Some(Posed::of(&Odometry::decode(cdr)?));
                "target"
            }
            Role::Obstacles => {
                self.obstacles = ObstacleArray::decode(cdr)?.obstacles.iter().map(Outline::of_obstacle).collect();
                "obstacles"
            }
            Role::Hulls => {
                self.hulls = ApparentObstacleArray::decode(cdr)?.obstacles.iter().map(Outline::of_hull).collect();
                "hulls"
            }
            Role::EmergencyStop => {
                self.emergency_stop = Bool::decode(cdr)?.data;
                "emergency_stop"
            }
            Role::Markers => {
                let body = self.markers.body;
                let changed = self.markers.take(now, MarkerArray::decode(cdr)?);
                if self.markers.body != body {
                    self.changed.insert("body");
                }
                if !changed {
                    return Ok(());
                }
                "markers"
            }
            Role::Diagnostics => {
                if !self.alarms.take(now, DiagnosticArray::decode(cdr)?) {
                    return Ok(());
                }
                "alarms"
            }
            Role::Contacts => {
                self.alarms.collided(now, &DiagnosticArray::decode(cdr)?);
                "alarms"
            }
            Role::Leader(robot) => {
                let control = Control::of(&LeaderState::decode(cdr)?);
                // The monitor tells the bound too, where there is one.
                if !self.stability.contains_key(robot) {
                    self.history.valued(robot, seconds(now), control.value, None);
                }
                self.control.insert(robot.clone(), control);
                "control"
            }
            Role::Stability(robot) => {
                let monitor = Monitor::of(&Stability::decode(cdr)?);
                self.history.valued(robot, seconds(now), monitor.value, monitor.bound);
                self.stability.insert(robot.clone(), monitor);
                "stability"
            }
            Role::Link(robot) => {
                self.links.insert(robot.clone(), Link::of(&LinkStatus::decode(cdr)?));
                "links"
            }
            Role::Truth(robot) => {
                self.truth.insert(robot.clone(), Posed::of(&Odometry::decode(cdr)?));
                "truth"
            }
        };
        self.changed.insert(part);
        Ok(())
    }

    /// The picture as browsers get it; with the history where one of them starts with it.
    pub fn snapshot(&mut self, with_history: bool) -> Snapshot {
        if self.markers.expire(self.now) {
            self.changed.insert("markers");
        }
        if self.alarms_seen.is_none_or(|seen| self.now.seconds_since(seen).abs() >= LOOK) {
            self.changed.insert("alarms");
        }
        if self.changed.contains("alarms") {
            self.alarms_seen = Some(self.now);
        }
        for part in std::mem::take(&mut self.changed) {
            self.put(part, self.json(part));
        }
        self.put("now", text(&seconds(self.now)));
        self.snapshot.history = with_history.then(|| text(&self.history).into());
        self.snapshot.clone()
    }

    /// What the page draws and no other node's markers say: trails, links, Lyapunov values with their bounds, alarms. In the
    /// namespaces `view/..` of the frame `map`.
    #[must_use]
    pub fn markers(&self) -> MarkerArray {
        let alarms = self.alarms.list(self.now);
        let Self { now, team, history, links, stability, .. } = self;
        Shown { now: *now, team, history, links, stability, alarms }.markers()
    }

    /// Sets a part that comes from no topic: what kind of picture this is, where the player stands.
    pub fn put(&mut self, part: &'static str, json: String) {
        let (revision, old) = self.snapshot.parts.entry(part).or_insert_with(|| (0, Arc::from("")));
        // Many topics say the same again and again.
        if **old != *json {
            (*revision, *old) = (*revision + 1, json.into());
        }
    }

    fn json(&self, part: &str) -> String {
        match part {
            "team" => text(&self.team),
            "goals" => text(&self.goals),
            "formation" => text(&self.formation),
            "places" => text(&self.places),
            "run" => text(&self.run),
            "target" => text(&self.target),
            "obstacles" => text(&self.obstacles),
            "hulls" => text(&self.hulls),
            "emergency_stop" => text(&self.emergency_stop),
            "markers" => text(&self.markers.list()),
            "body" => text(&self.markers.body),
            "alarms" => text(&self.alarms.list(self.now)),
            "control" => text(&self.control),
            "stability" => text(&self.stability),
            "links" => text(&self.links),
            "truth" => text(&self.truth),
            _ => text(&self.undecodable),
        }
    }
}

/// JSON of something whose keys are strings: that always works.
fn text(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_else(|_| "null".to_owned())
}
