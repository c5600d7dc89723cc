//! Coded pads: the Small Size League's pattern. A dot of the team's colour in the middle, four dots of green or pink around it; where
//! they are tells the heading, which of them are green tells the robot.

use super::balance::Light;
use super::frame::{ChannelOrder, Frame};
use nalgebra::{Point2, Point3, Vector2};
use trench_optics::{Camera, Pixel, Pose2};

/// A pad whose code was read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CodedPad {
    /// The middle of the pad and where its front is, in the map.
    pub pose: Pose2,
    /// The league's number of the pattern, 0 to 15.
    pub id: u32,
}

/// Diameter of the dot in the middle, and of those around it, m (the league's rules).
pub const MIDDLE: f64 = 0.05;
const DOT: f64 = 0.04;
/// Where the dots are in the robot's frame, m: front left, front right, rear right, rear left.
pub const DOTS: [[f64; 2]; 4] = [[0.035, 0.054_772], [0.035, -0.054_772], [-0.054_772, -0.035], [-0.054_772, 0.035]];
/// Of each number which dots are green, in that order; the others are pink.
pub const GREEN: [[bool; 4]; 16] = {
    const fn dots(green: u8) -> [bool; 4] {
        [green & 8 != 0, green & 4 != 0, green & 2 != 0, green & 1 != 0]
    }
    [
        dots(0b0001),
        dots(0b1001),
        dots(0b1101),
        dots(0b0101),
        dots(0b0010),
        dots(0b1010),
        dots(0b1110),
        dots(0b0110),
        dots(0b1111),
        dots(0b0000),
        dots(0b0011),
        dots(0b1100),
        dots(0b1011),
        dots(0b1000),
        dots(0b0111),
        dots(0b0100),
    ]
};

/// Looks around the ring on which the dots lie: every 3 degrees.
const LOOKS: usize = 120;
/// A dot covers so many looks on either side of its middle.
const HALF: usize = 4;
/// From the middle to the middle of each dot, m.
const REACH: f64 = 0.065;
/// So far off it the ring is looked at, too, m.
const BESIDE: f64 = 0.008;
/// Least greenness or pinkness of each dot, of 510.
const LEAST: f64 = 25.0;
/// The dots together are so much greener or pinker than what is between them.
const CONTRAST: f64 = 3.0;
/// Pixels with less than this part of a dot's colour are its ground.
const GROUND: f64 = 0.3;

/// Reads codes below one camera.
#[derive(Debug, Clone)]
pub struct CodeReader {
    camera: Camera,
    /// Of the pads above the floor, m.
    height: f64,
}

impl CodeReader {
    /// For pads at this height (m).
    #[must_use]
    pub fn new(camera: Camera, height: f64) -> Self {
        Self { camera, height }
    }

    /// The pad around the dot of its team's colour at `middle`; None where four dots are not all seen.
    #[must_use]
    pub fn read(&self, frame: Frame<'_>, light: Light, middle: Pixel) -> Option<CodedPad> {
        let colour = Greenness { frame, light };
        let middle = self.camera.unproject(middle, self.height)?;
        let mut ring = [0.0; LOOKS];
        for (index, look) in ring.iter_mut().enumerate() {
            let (sine, cosine) = libm::sincos(std::f64::consts::TAU * index as f64 / LOOKS as f64);
            for reach in [REACH - BESIDE, REACH, REACH + BESIDE] {
                *look += colour.at(self.pixel(middle + reach * Vector2::new(cosine, sine))?) / 3.0;
            }
        }
        let turned = heading(&ring)?;
        let mut green = [false; 4];
        let mut dots = [Vector2::zeros(); 4];
        for (index, dot) in DOTS.iter().enumerate() {
            let strength = around(&ring, turned + look_of(*dot));
            green[index] = strength > 0.0;
            let expected = middle + turn(*dot, angle_of(turned));
            dots[index] = self.dot(&colour, expected, strength)? - middle;
        }
        let id = GREEN.iter().position(|pattern| *pattern == green)?;
        Some(CodedPad { pose: pose(middle, &dots), id: u32::try_from(id).ok()? })
    }

    fn pixel(&self, place: Point2<f64>) -> Option<Pixel> {
        self.camera.project(Point3::new(place.x, place.y, self.height))
    }

    /// The centre of area of the dot near `expected`, m; `strength` is its colour on the ring.
    fn dot(&self, colour: &Greenness<'_>, expected: Point2<f64>, strength: f64) -> Option<Point2<f64>> {
        let centre = self.pixel(expected)?;
        let edge = self.pixel(expected + Vector2::new(0.65 * DOT, 0.65 * DOT))?;
        let half = [(edge.u - centre.u).abs(), (edge.v - centre.v).abs()];
        let (mut sum, mut sum_u, mut sum_v) = (0.0, 0.0, 0.0);
        let range = |centre: f64, half: f64| (centre - half).ceil() as i64..=(centre + half).floor() as i64;
        for v in range(centre.v, half[1]) {
            for u in range(centre.u, half[0]) {
                let weight = colour.at_pixel(u, v)? * strength.signum() - GROUND * strength.abs();
                let weight = weight.clamp(0.0, strength.abs());
                (sum, sum_u, sum_v) = (sum + weight, sum_u + weight * u as f64, sum_v + weight * v as f64);
            }
        }
        if sum <= 0.0 {
            return None;
        }
        self.camera.unproject(Pixel { u: sum_u / sum, v: sum_v / sum }, self.height)
    }
}

/// 2 G - R - B in white light: green above zero, pink below, all else of a pad and its ground about zero.
struct Greenness<'a> {
    frame: Frame<'a>,
    light: Light,
}

impl Greenness<'_> {
    fn at(&self, Pixel { u, v }: Pixel) -> f64 {
        self.at_pixel(u.round() as i64, v.round() as i64).unwrap_or(0.0)
    }

    /// None outside the picture.
    fn at_pixel(&self, u: i64, v: i64) -> Option<f64> {
        let (u, v) = (usize::try_from(u).ok()?, usize::try_from(v).ok()?);
        let Some(&[first, green, last]) = self.frame.row(v).get(3 * u..3 * u + 3) else { return None };
        let (red, blue) = if self.frame.order == ChannelOrder::Rgb { (first, last) } else { (last, first) };
        let [red, green, blue] = self.light.take_out([red, green, blue]).map(f64::from);
        Some(2.0 * green - red - blue)
    }
}

/// The look that a dot's direction falls on, for a robot that is not turned.
fn look_of([x, y]: [f64; 2]) -> usize {
    let part = libm::atan2(y, x) / std::f64::consts::TAU;
    ((part + 1.0) * LOOKS as f64).round() as usize % LOOKS
}

fn angle_of(look: usize) -> f64 {
    std::f64::consts::TAU * look as f64 / LOOKS as f64
}

fn turn([x, y]: [f64; 2], angle: f64) -> Vector2<f64> {
    let (sine, cosine) = libm::sincos(angle);
    Vector2::new(cosine * x - sine * y, sine * x + cosine * y)
}

/// The mean around a look.
fn around(ring: &[f64; LOOKS], look: usize) -> f64 {
    let looks = look + LOOKS - HALF..=look + LOOKS + HALF;
    looks.map(|look| ring[look % LOOKS]).sum::<f64>() / (2 * HALF + 1) as f64
}

/// How the robot is turned, in looks: the gaps between the dots differ, so that one turn alone fits. None where no turn does.
fn heading(ring: &[f64; LOOKS]) -> Option<usize> {
    let looks = DOTS.map(look_of);
    let score = |turned: usize| looks.iter().map(|look| around(ring, turned + look).abs()).sum::<f64>();
    let best = (0..LOOKS).max_by(|a, b| score(*a).total_cmp(&score(*b)))?;
    let weakest = looks.iter().map(|look| around(ring, best + look).abs()).fold(f64::MAX, f64::min);
    // Midway between neighbours there is the pad's ground.
    let mut sorted = looks.map(|look| (best + look) % LOOKS);
    sorted.sort_unstable();
    let between = |index: usize| {
        let (from, to) = (sorted[index], sorted[(index + 1) % 4]);
        (from + (to + LOOKS - from) % LOOKS / 2) % LOOKS
    };
    let ground = (0..4).map(|index| ring[between(index)].abs()).sum::<f64>() / 4.0;
    (weakest >= LEAST && weakest >= CONTRAST * ground).then_some(best)
}

/// The pose that lays the pattern best on the dots, which are given from `middle`.
fn pose(middle: Point2<f64>, dots: &[Vector2<f64>; 4]) -> Pose2 {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (dot, [x, y]) in dots.iter().zip(DOTS) {
        sine += x * dot.y - y * dot.x;
        cosine += x * dot.x + y * dot.y;
    }
    let theta = libm::atan2(sine, cosine);
    // The middle counts as each of the dots does.
    let off = dots.iter().zip(DOTS).map(|(dot, place)| dot - turn(place, theta)).sum::<Vector2<f64>>() / 5.0;
    Pose2 { x: middle.x + off.x, y: middle.y + off.y, theta }
}
