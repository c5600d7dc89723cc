//! Robots, obstacles and the field, moving on in fixed steps of 1 ms.

use crate::contact::Surroundings;
use crate::history::History;
use crate::unicycle::{rolled, wrapped};
use crate::{Field, Laser, Motor, Obstacle, Random, Thing, Truth, Wheel, overlaps, range_sensor};
use std::collections::BTreeSet;
use trench_optics::Pose2;

/// Length of a step, ns.
pub const STEP: u64 = 1_000_000;

const STEP_SECONDS: f64 = 0.001;

/// A contact ends when the gap is larger than this, m: bodies that tremble at each other are reported once.
const RELEASE_GAP: f64 = 0.002;

/// What all robots have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Of the round body, m.
    pub radius: f64,
    /// From the centre to a wheel, m.
    pub half_axle: f64,
    /// The wheels' motors.
    pub motor: Motor,
}

impl Body {
    /// The MRKIT robot.
    pub const MRKIT: Self = Self { radius: 0.08, half_axle: 0.06, motor: Motor::HONEST };
}

/// A robot's body begins to touch something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// When, ns.
    pub at: u64,
    /// Index of the robot.
    pub robot: usize,
    /// What it touches.
    pub thing: Thing,
    /// Where the robot is.
    pub pose: Pose2,
}

/// The world.
#[derive(Debug, Clone)]
pub struct World {
    now: u64,
    body: Body,
    field: Field,
    obstacles: Vec<Obstacle>,
    poses: Vec<Pose2>,
    wheels: Vec<[Wheel; 2]>,
    told: Vec<[f64; 2]>,
    /// Share of a wheel's way by which it moves the robot.
    grip: Vec<[f64; 2]>,
    /// Share of their steps that a robot's motors miss.
    missing: Vec<f64>,
    histories: Vec<History>,
    touching: BTreeSet<(usize, Thing)>,
    contacts: Vec<Contact>,
}

impl World {
    /// Robots at rest at their poses, at time `start` (ns). Bodies that overlap there touch from the start.
    #[must_use]
    pub fn new(start: u64, body: Body, field: Field, obstacles: Vec<Obstacle>, poses: Vec<Pose2>) -> Self {
        let count = poses.len();
        let histories = poses.iter().map(|&pose| History::new(start, Truth { pose, v: 0.0, omega: 0.0 })).collect();
        let overlaps = overlaps(&poses, &obstacles, field, body.radius);
        let mut world = Self {
            now: start,
            body,
            field,
            obstacles,
            poses,
            wheels: vec![[Wheel::default(); 2]; count],
            told: vec![[0.0; 2]; count],
            grip: vec![[1.0; 2]; count],
            missing: vec![0.0; count],
            histories,
            touching: BTreeSet::new(),
            contacts: Vec::new(),
        };
        for overlap in overlaps {
            world.report(overlap.robot, overlap.thing);
        }
        world
    }

    /// The time it has reached, ns.
    #[must_use]
    pub fn now(&self) -> u64 {
        self.now
    }

    /// Tells a robot's left and right wheel their speeds, m/s, from now on.
    pub fn tell(&mut self, robot: usize, speeds: [f64; 2]) {
        if let Some(told) = self.told.get_mut(robot) {
            *told = speeds;
        }
    }

    /// From now on a robot's left and right wheel move it by these shares of their ways.
    pub fn set_grip(&mut self, robot: usize, grip: [f64; 2]) {
        if let Some(old) = self.grip.get_mut(robot) {
            *old = grip;
        }
    }

    /// From now on a robot's motors miss this share of their steps.
    pub fn set_missing(&mut self, robot: usize, share: f64) {
        if let Some(old) = self.missing.get_mut(robot) {
            *old = share;
        }
    }

    /// Carries a robot somewhere else, at rest.
    pub fn place(&mut self, robot: usize, pose: Pose2) {
        if let (Some(place), Some(wheels)) = (self.poses.get_mut(robot), self.wheels.get_mut(robot)) {
            *place = pose;
            wheels.iter_mut().for_each(|wheel| wheel.speed = 0.0);
        }
    }

    /// Where the robots are.
    #[must_use]
    pub fn poses(&self) -> &[Pose2] {
        &self.poses
    }

    /// A robot's left and right wheel.
    #[must_use]
    pub fn wheels(&self, robot: usize) -> Option<&[Wheel; 2]> {
        self.wheels.get(robot)
    }

    /// What stands in the field.
    #[must_use]
    pub fn obstacles(&self) -> &[Obstacle] {
        &self.obstacles
    }

    /// A robot's state at a time of the last quarter of a second.
    #[must_use]
    pub fn truth(&self, robot: usize, at: u64) -> Option<Truth> {
        self.histories.get(robot).map(|history| history.at(at))
    }

    /// What a robot's range sensors read, in cm.
    #[must_use]
    pub fn ranges(&self, robot: usize) -> [u8; range_sensor::DIRECTIONS.len()] {
        range_sensor::readings(&self.surroundings(), robot)
    }

    /// What a robot's laser measures, m; a little wrong by chance.
    #[must_use]
    pub fn scan(&self, robot: usize, laser: &Laser, random: &mut Random) -> Vec<f32> {
        laser.scan(&self.surroundings(), robot, random)
    }

    /// Takes the contacts that began since the last call.
    pub fn take_contacts(&mut self) -> Vec<Contact> {
        std::mem::take(&mut self.contacts)
    }

    /// Moves on by [`STEP`].
    pub fn step(&mut self) {
        self.now += STEP;
        for obstacle in &mut self.obstacles {
            obstacle.advance(STEP_SECONDS);
        }
        for robot in 0..self.poses.len() {
            self.move_robot(robot);
        }
        self.release_contacts();
    }

    fn move_robot(&mut self, robot: usize) {
        let (old, told) = (self.poses[robot], self.told[robot]);
        let [left, right] = &mut self.wheels[robot];
        let [left_grip, right_grip] = self.grip[robot];
        let (missing, motor) = (self.missing[robot], self.body.motor);
        let left = left_grip * left.turn(motor, told[0], missing, STEP_SECONDS);
        let right = right_grip * right.turn(motor, told[1], missing, STEP_SECONDS);
        let free = rolled(old, left, right, self.body.half_axle);
        let mut touched = Vec::new();
        let end = self.surroundings().blocked(robot, [old.x, old.y], [free.x, free.y], |thing| touched.push(thing));
        let end = self.pushed(robot, end, &mut touched);
        let pose = Pose2 { x: end[0], y: end[1], theta: free.theta };
        self.poses[robot] = pose;
        for thing in touched {
            self.report(robot, thing);
        }
        let (sin, cos) = libm::sincos(old.theta);
        let v = ((pose.x - old.x) * cos + (pose.y - old.y) * sin) / STEP_SECONDS;
        let omega = wrapped(pose.theta - old.theta) / STEP_SECONDS;
        self.histories[robot].push(Truth { pose, v, omega });
    }

    /// Where a robot is after the obstacles that came upon it have pushed it aside, as far as there is room.
    fn pushed(&self, robot: usize, from: [f64; 2], touched: &mut Vec<Thing>) -> [f64; 2] {
        let mut end = from;
        for (number, obstacle) in self.obstacles.iter().enumerate() {
            let Some((clearance, away)) = obstacle.clearance_within(end, self.body.radius) else { continue };
            let depth = self.body.radius - clearance;
            if depth <= 0.0 {
                continue;
            }
            touched.push(Thing::Obstacle(number));
            if obstacle.velocity() != [0.0, 0.0] {
                let aside = [end[0] + depth * away[0], end[1] + depth * away[1]];
                end = self.surroundings().blocked(robot, end, aside, |thing| touched.push(thing));
            }
        }
        end
    }

    fn report(&mut self, robot: usize, thing: Thing) {
        let known_from_the_other_side =
            matches!(thing, Thing::Robot(other) if self.touching.contains(&(other, Thing::Robot(robot))));
        if !known_from_the_other_side && self.touching.insert((robot, thing)) {
            self.contacts.push(Contact { at: self.now, robot, thing, pose: self.poses[robot] });
        }
    }

    fn release_contacts(&mut self) {
        let mut touching = std::mem::take(&mut self.touching);
        touching.retain(|&(robot, thing)| {
            let pose = self.poses[robot];
            self.surroundings().near(robot, [pose.x, pose.y], RELEASE_GAP).any(|near| near.thing == thing)
        });
        self.touching = touching;
    }

    fn surroundings(&self) -> Surroundings<'_> {
        Surroundings { poses: &self.poses, obstacles: &self.obstacles, field: self.field, radius: self.body.radius }
    }
}
