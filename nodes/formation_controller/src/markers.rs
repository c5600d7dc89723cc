//! What a controller goes by, as RViz2 and Foxglove draw it: zones, hulls merged with the robots ahead, what is left of the segment,
//! the repulsive areas that it is in, the point that draws the robot, forces, the way out of a minimum (Figures 7.4 to 7.14).

use trench_core::RosTime;
use trench_formation::Vector2;
use trench_formation::agent::{Action, Agent, Surroundings};
use trench_formation::curve::{Interval, Placed};
use trench_formation::trench::AnyTrench;
use trench_formation::zoning::Radii;
use trench_msgs::geometry_msgs::{Point, Vector3};
use trench_msgs::std_msgs::ColorRGBA;
use trench_msgs::visualization_msgs::{Marker, MarkerArray};

/// What a viewer shows of a controller that has ended goes away after this, s.
const LIFETIME: f64 = 1.2;
/// Thickness of lines, m.
const LINE: f64 = 0.008;
/// Length of an arrow, m for 1 m/s^2.
const FORCE: f64 = 0.4;
/// Shorter arrows are not drawn, m.
const LEAST: f64 = 0.004;
/// Directions in which a merged hull is looked at.
const DIRECTIONS: usize = 24;
/// Pieces of the arcs of a repulsive sector.
const ARC: usize = 6;
/// Length of the straight pieces that fragments are drawn in, m.
const PIECE: f64 = 0.1;
/// Pieces of one fragment at most.
const MOST_PIECES: f64 = 100.0;

const fn colour(r: f32, g: f32, b: f32, a: f32) -> ColorRGBA {
    ColorRGBA { r, g, b, a }
}
const GREEN: ColorRGBA = colour(0.1, 0.6, 0.3, 0.9);
const RED: ColorRGBA = colour(0.8, 0.2, 0.15, 0.9);
const BLUE: ColorRGBA = colour(0.1, 0.45, 0.8, 0.9);
const ORANGE: ColorRGBA = colour(0.85, 0.5, 0.1, 0.9);
const PURPLE: ColorRGBA = colour(0.5, 0.3, 0.7, 0.9);
const GREY: ColorRGBA = colour(0.4, 0.4, 0.4, 0.9);

/// A tick of one controller.
pub(crate) struct Picture<'a> {
    pub(crate) robot: &'a str,
    pub(crate) agent: &'a Agent<AnyTrench>,
    pub(crate) around: &'a Surroundings<'a>,
    /// The point that is steered, m.
    pub(crate) point: Vector2<f64>,
    pub(crate) action: &'a Action,
    /// Zones, where they matter.
    pub(crate) radii: Option<&'a Radii>,
}

impl Picture<'_> {
    pub(crate) fn markers(&self, stamp: RosTime) -> MarkerArray {
        let mut drawn = Drawn { stamp, first: first_id(self.robot), markers: Vec::new() };
        self.zones(&mut drawn);
        self.segment(&mut drawn);
        self.hulls(&mut drawn);
        self.sectors(&mut drawn);
        if let Some(attraction) = self.action.attraction {
            drawn.line("nearest", BLUE, &[self.point, attraction]);
        }
        self.forces(&mut drawn);
        let way = self.agent.way_out(self.point);
        if !way.is_empty() {
            drawn.line("remedy", ORANGE, &way);
        }
        MarkerArray { markers: drawn.markers }
    }

    fn zones(&self, drawn: &mut Drawn) {
        let Some(radii) = self.radii else { return };
        let zones = [
            (radii.rho_underbar, RED),
            (radii.rho_hat, ORANGE),
            (radii.rho, GREEN),
            (radii.rho_check, BLUE),
            (radii.rho_bar, GREY),
        ];
        for (radius, colour) in zones {
            let disc = drawn.add("zones", Marker::CYLINDER, ColorRGBA { a: 0.06, ..colour });
            disc.scale = Vector3 { x: 2.0 * radius, y: 2.0 * radius, z: 0.001 };
            (disc.pose.position.x, disc.pose.position.y) = (self.point.x, self.point.y);
        }
    }

    /// Qualified fragments, and what is encroached.
    fn segment(&self, drawn: &mut Drawn) {
        let segment = Placed::new(self.around.curve, self.around.map_from_segment);
        let fragments = self.agent.fragments();
        drawn.pieces("fragments", GREEN, &segment, fragments);
        let (mut from, end) = (0.0, self.around.curve.length());
        let mut encroached: Vec<Interval> = Vec::new();
        for &(start, stop) in fragments {
            encroached.push((from, start));
            from = stop;
        }
        encroached.push((from, end));
        encroached.retain(|(start, stop)| stop - start > 1e-6);
        drawn.pieces("encroached", RED, &segment, &encroached);
    }

    /// Hulls that the robots ahead are part of: the mapper draws the others.
    fn hulls(&self, drawn: &mut Drawn) {
        let Ok(merged) = self.agent.merged(self.around) else { return };
        let is_new = |id: &u32| !self.around.real.iter().any(|real| real.id == *id);
        for hull in merged.iter().filter(|hull| hull.members.iter().any(is_new)) {
            drawn.line("hulls", PURPLE, &hull.shape.outline().boundary(DIRECTIONS));
        }
    }

    /// Fig. 7.9: the areas before faces and at corners of what repels the robot now.
    fn sectors(&self, drawn: &mut Drawn) {
        let reach = self.agent.settings().potential.cut();
        for obstacle in self.around.apparent {
            let outline = obstacle.shape.outline();
            if outline.approach(self.point).gap >= reach {
                continue;
            }
            let marker = drawn.add("sectors", Marker::LINE_LIST, ColorRGBA { a: 0.5, ..ORANGE });
            marker.scale.x = 0.5 * LINE;
            let areas = outline.repulsive_areas(reach, ARC);
            marker.points = areas.iter().flat_map(|area| area.windows(2)).flatten().copied().map(level).collect();
        }
    }

    fn forces(&self, drawn: &mut Drawn) {
        let forces = &self.action.forces;
        let all = [
            (forces.trench, BLUE),
            (forces.zoning, GREEN),
            (forces.robots, ORANGE),
            (forces.obstacles, RED),
            (forces.damping, GREY),
        ];
        for (force, colour) in all.into_iter().filter(|(force, _)| FORCE * force.norm() >= LEAST) {
            let arrow = drawn.add("forces", Marker::ARROW, colour);
            arrow.scale = Vector3 { x: LINE, y: 3.0 * LINE, z: 4.0 * LINE };
            arrow.points = vec![level(self.point), level(self.point + FORCE * force)];
        }
    }
}

/// Markers so far. All controllers write one topic: ids of one robot begin where its name says.
struct Drawn {
    stamp: RosTime,
    first: i32,
    markers: Vec<Marker>,
}

impl Drawn {
    fn add(&mut self, part: &str, kind: i32, color: ColorRGBA) -> &mut Marker {
        let last = self.markers.len();
        let id = self.first + last as i32;
        self.markers.push(trench_core::marker(self.stamp, format!("controller/{part}"), id, kind, color, LIFETIME));
        &mut self.markers[last]
    }

    fn line(&mut self, part: &str, color: ColorRGBA, points: &[Vector2<f64>]) {
        let marker = self.add(part, Marker::LINE_STRIP, color);
        marker.scale.x = LINE;
        marker.points = points.iter().copied().map(level).collect();
    }

    fn pieces(&mut self, part: &str, color: ColorRGBA, segment: &Placed<'_>, intervals: &[Interval]) {
        for (from, to) in intervals {
            let count = libm::ceil((to - from) / PIECE).clamp(1.0, MOST_PIECES);
            let along = |step: u32| segment.at(from + (to - from) * f64::from(step) / count).point;
            let points: Vec<Vector2<f64>> = (0..=count as u32).map(along).collect();
            self.line(part, color, &points);
        }
    }
}

fn level(point: Vector2<f64>) -> Point {
    Point { x: point.x, y: point.y, z: 0.0 }
}

/// FNV-1a of the name, with room for 256 markers behind it.
fn first_id(robot: &str) -> i32 {
    let hash = robot.bytes().fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    ((hash & 0x007f_ffff) << 8) as i32
}
