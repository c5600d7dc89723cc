//! What the page draws and no other node's markers say, for RViz2 and Foxglove: trails, links, Lyapunov values with their bounds, alarms.

use crate::alarms::Alarm;
use crate::control::Monitor;
use crate::history::History;
use crate::team::{Link, Robot, Team};
use std::collections::BTreeMap;
use trench_core::RosTime;
use trench_msgs::geometry_msgs;
use trench_msgs::std_msgs::ColorRGBA;
use trench_msgs::visualization_msgs::{Marker, MarkerArray};

/// Namespaces begin with this; the page draws them from their own topics.
pub(crate) const NAMESPACE: &str = "view/";
/// What is shown of a view that has ended goes away after this, s.
const LIFETIME: f64 = 2.5;
/// Every so many samples of a trail are enough for a line: half a second.
const THINNED: usize = 5;
/// Width of a trail, diameter of a link's light, height of letters, m.
const LINE: f64 = 0.006;
const LIGHT: f64 = 0.03;
const LETTERS: f64 = 0.05;
/// From a robot's centre to its link's light, and to its value, m.
const BESIDE: f64 = 0.06;
const BELOW: f64 = 0.14;
/// Lines of alarms at most.
const MOST_ALARMS: usize = 8;

const fn colour(r: f32, g: f32, b: f32) -> ColorRGBA {
    ColorRGBA { r, g, b, a: 0.9 }
}
const GOOD: ColorRGBA = colour(0.1, 0.6, 0.3);
const WEAK: ColorRGBA = colour(0.85, 0.5, 0.1);
const BAD: ColorRGBA = colour(0.8, 0.2, 0.15);
const GREY: ColorRGBA = colour(0.4, 0.4, 0.4);

/// The parts of the picture that are shown.
pub(crate) struct Shown<'a> {
    pub(crate) now: RosTime,
    pub(crate) team: &'a Team,
    pub(crate) history: &'a History,
    pub(crate) links: &'a BTreeMap<String, Link>,
    pub(crate) stability: &'a BTreeMap<String, Monitor>,
    pub(crate) alarms: Vec<Alarm<'a>>,
}

impl Shown<'_> {
    pub(crate) fn markers(&self) -> MarkerArray {
        let mut markers = Vec::new();
        for (id, robot) in (0..).zip(&self.team.robots) {
            let place = |across: f64, up: f64| Some(level(robot.at[0]? + across, robot.at[1]? + up));
            markers.extend(self.trail(id, robot));
            let light = self.links.get(&robot.name).zip(place(BESIDE, BESIDE));
            markers.extend(light.map(|(link, at)| self.light(id, link, at)));
            let value = self.stability.get(&robot.name).zip(place(0.0, -BELOW));
            markers.extend(value.and_then(|(monitor, at)| self.value(id, monitor, at)));
        }
        markers.extend(self.alarms());
        MarkerArray { markers }
    }

    fn marker(&self, part: &str, id: i32, kind: i32, color: ColorRGBA) -> Marker {
        trench_core::marker(self.now, format!("{NAMESPACE}{part}"), id, kind, color, LIFETIME)
    }

    /// The last minute of a robot.
    fn trail(&self, id: i32, robot: &Robot) -> Option<Marker> {
        let samples = self.history.trails.get(&robot.name)?;
        let points = samples.iter().step_by(THINNED).filter_map(|(_, at)| Some(level(at[0]?, at[1]?)));
        let mut marker = self.marker("trails", id, Marker::LINE_STRIP, GREY);
        marker.scale.x = LINE;
        marker.points = points.collect();
        // A line needs two.
        (marker.points.len() > 1).then_some(marker)
    }

    /// A light: whether the robot hears commands.
    fn light(&self, id: i32, link: &Link, at: geometry_msgs::Point) -> Marker {
        let colour = match (link.up, link.is_weak()) {
            (false, _) => BAD,
            (true, true) => WEAK,
            (true, false) => GOOD,
        };
        let mut marker = self.marker("links", id, Marker::SPHERE, colour);
        (marker.scale.x, marker.scale.y, marker.scale.z) = (LIGHT, LIGHT, LIGHT);
        marker.pose.position = at;
        marker
    }

    /// V and what it may be at most; what is violated, where something is.
    fn value(&self, id: i32, monitor: &Monitor, at: geometry_msgs::Point) -> Option<Marker> {
        let (value, bound) = (monitor.value?, monitor.bound);
        let bound = bound.map_or(String::new(), |bound| format!(" <= {bound:.1e}"));
        let (text, colour) = match monitor.holds {
            true => (format!("V {value:.1e}{bound}"), GREY),
            false => (monitor.violation.clone(), BAD),
        };
        Some(self.text("stability", id, colour, text, at))
    }

    /// Above the team, the worst first.
    fn alarms(&self) -> Option<Marker> {
        let first = self.alarms.first()?;
        let colour = if first.level == "warn" { WEAK } else { BAD };
        let lines = self.alarms.iter().take(MOST_ALARMS);
        let lines: Vec<String> = lines.map(|alarm| format!("{}: {}", alarm.name, alarm.message)).collect();
        let places = || self.team.robots.iter().filter_map(|robot| Some((robot.at[0]?, robot.at[1]?)));
        let (across, count) = places().fold((0.0, 0.0), |(sum, count), (x, _)| (sum + x, count + 1.0));
        let top = places().map(|(_, y)| y).fold(f64::NEG_INFINITY, f64::max);
        let above = top + LETTERS * (2.0 + lines.len() as f64);
        let at = if count > 0.0 { level(across / count, above) } else { level(0.0, 0.0) };
        Some(self.text("alarms", 0, colour, lines.join("\n"), at))
    }

    fn text(&self, part: &str, id: i32, colour: ColorRGBA, text: String, at: geometry_msgs::Point) -> Marker {
        let mut marker = self.marker(part, id, Marker::TEXT_VIEW_FACING, colour);
        marker.scale.z = LETTERS;
        marker.pose.position = at;
        marker.text = text;
        marker
    }
}

fn level(x: f64, y: f64) -> geometry_msgs::Point {
    geometry_msgs::Point { x, y, z: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Role, View};
    use trench_msgs::Encode;
    use trench_msgs::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
    use trench_msgs::msg::{LinkStatus, RobotState, Stability, TeamState};

    fn take(view: &mut View, at: f64, role: Role, message: &dyn Encode) {
        let mut cdr = vec![0; message.encoded_len()];
        message.encode_into(&mut cdr);
        view.take(RosTime(0).plus_seconds(at), &role, &cdr);
    }

    fn of<'a>(array: &'a MarkerArray, part: &str) -> Vec<&'a Marker> {
        array.markers.iter().filter(|marker| marker.ns == format!("view/{part}")).collect()
    }

    #[test]
    fn what_the_page_draws_goes_out_as_markers() {
        let mut view = View::default();
        assert!(view.markers().markers.is_empty(), "nothing is known");
        for tick in 0..60 {
            let x = 0.01 * f64::from(tick);
            let robot = RobotState { name: "robot1".to_owned(), x, y: 0.5, ..RobotState::default() };
            take(
                &mut view,
                0.1 * f64::from(tick),
                Role::Team,
                &TeamState { robots: vec![robot], ..Default::default() },
            );
        }
        let stability = Stability { value: 1.5e-3, bound: 4.0e-3, holds: true, ..Stability::default() };
        take(&mut view, 6.0, Role::Stability("robot1".to_owned()), &stability);
        take(
            &mut view,
            6.0,
            Role::Link("robot1".to_owned()),
            &LinkStatus { up: true, loss: 0.5, ..Default::default() },
        );
        let all = view.markers();
        assert_eq!(of(&all, "trails")[0].points.len(), 12, "a place each half second");
        assert_eq!(of(&all, "links")[0].color, WEAK, "half of its packets are lost");
        let value = of(&all, "stability")[0];
        assert_eq!((value.text.as_str(), value.color), ("V 1.5e-3 <= 4.0e-3", GREY));
        assert!((value.pose.position.x - 0.59).abs() < 1e-9 && value.pose.position.y < 0.5);
        assert!(of(&all, "alarms").is_empty());

        let broken = Stability { holds: false, violation: "(A.10): V grows".to_owned(), ..stability };
        take(&mut view, 6.1, Role::Stability("robot1".to_owned()), &broken);
        take(&mut view, 6.1, Role::Link("robot1".to_owned()), &LinkStatus::default());
        let status =
            DiagnosticStatus { level: 2, name: "/a: b".to_owned(), message: "c".to_owned(), ..Default::default() };
        take(&mut view, 6.1, Role::Diagnostics, &DiagnosticArray { status: vec![status], ..Default::default() });
        let all = view.markers();
        assert_eq!((of(&all, "stability")[0].text.as_str(), of(&all, "stability")[0].color), ("(A.10): V grows", BAD));
        assert_eq!(of(&all, "links")[0].color, BAD);
        assert_eq!((of(&all, "alarms")[0].text.as_str(), of(&all, "alarms")[0].color), ("/a: b: c", BAD));
        // The page that hears them again has all of this from its own topics.
        take(&mut view, 6.2, Role::Markers, &all);
        assert!(!format!("{:?}", view.snapshot(false)).contains("view/"));
    }
}
