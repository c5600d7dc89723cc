//! A test bed for the safety filter: unicycles with limited wheels, a camera's period and a pure delay.
use nalgebra::Vector2;
use trench_formation::kinematics::{Pose, Twist, wrap};
use trench_formation::safety::{MovingOutline, Neighbour, SafetyFilter, SafetyParameters, Scene, Wish};

pub(crate) const RADIUS: f64 = 0.08;
pub(crate) const HALF_AXLE: f64 = 0.06;
pub(crate) const MARGIN: f64 = 0.01;
pub(crate) const FIELD: [Vector2<f64>; 4] =
    [Vector2::new(0.0, 0.0), Vector2::new(2.48, 0.0), Vector2::new(2.48, 1.83), Vector2::new(0.0, 1.83)];
const MOST_WHEEL_SPEED: f64 = 0.3;
const WHEEL_ACCELERATION: f64 = 0.5;

/// SplitMix64: small, seeded, the same everywhere.
pub(crate) struct Random(pub u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Points in the field, pairwise at least `apart` apart; drawn anew until they fit.
    pub(crate) fn places(&mut self, count: usize, apart: f64) -> Vec<Vector2<f64>> {
        let inset = RADIUS + MARGIN;
        let mut places: Vec<Vector2<f64>> = Vec::new();
        while places.len() < count {
            let place = Vector2::new(self.between(inset, 2.48 - inset), self.between(inset, 1.83 - inset));
            if places.iter().all(|other| (other - place).norm() >= apart) {
                places.push(place);
            }
        }
        places
    }
}

#[derive(Clone)]
pub(crate) struct Robot {
    pub(crate) pose: Pose,
    pub(crate) goal: Vector2<f64>,
    wheels: [f64; 2],
    target: [f64; 2],
    /// Commands under way: when they act (ms) and the wheel speeds.
    pending: Vec<(u32, [f64; 2])>,
}

impl Robot {
    pub(crate) fn new(pose: Pose, goal: Vector2<f64>) -> Self {
        Self { pose, goal, wheels: [0.0; 2], target: [0.0; 2], pending: Vec::new() }
    }

    pub(crate) fn twist(&self) -> Twist {
        let [left, right] = self.wheels;
        Twist { v: 0.5 * (left + right), omega: (right - left) / (2.0 * HALF_AXLE) }
    }

    /// Under way with these wheel speeds (m/s), as it was told.
    pub(crate) fn running(self, wheels: [f64; 2]) -> Self {
        Self { wheels, target: wheels, ..self }
    }

    /// How far it gets at most until it stands, m, when it is told to `wait` (s) from now.
    fn stopping(&self, wait: f64) -> f64 {
        let [left, right] = self.wheels;
        let braking = (left * left + right * right) / (4.0 * WHEEL_ACCELERATION);
        self.twist().v.abs() * wait + braking
    }

    pub(crate) fn velocity(&self) -> Vector2<f64> {
        self.twist().v * self.pose.heading()
    }

    fn command(&mut self, at: u32, twist: Twist) {
        let turn = HALF_AXLE * twist.omega;
        let wheels = [twist.v - turn, twist.v + turn];
        let scale = (MOST_WHEEL_SPEED / wheels[0].abs().max(wheels[1].abs())).min(1.0);
        self.pending.push((at, wheels.map(|wheel| wheel * scale)));
    }

    fn step(&mut self, now: u32) {
        while self.pending.first().is_some_and(|(at, _)| *at <= now) {
            self.target = self.pending.remove(0).1;
        }
        for (wheel, target) in self.wheels.iter_mut().zip(self.target) {
            *wheel += (target - *wheel).clamp(-WHEEL_ACCELERATION * 0.001, WHEEL_ACCELERATION * 0.001);
        }
        self.pose = self.pose.advanced(self.twist(), 0.001);
    }

    /// Law (3.9) with its speed cut off.
    fn law(&self) -> Twist {
        let way = self.goal - self.pose.position();
        let distance = way.norm();
        if distance < 0.01 {
            return Twist::ZERO;
        }
        let error = wrap(libm::atan2(way.y, way.x) - self.pose.theta);
        Twist { v: distance.min(0.25) * libm::cos(error), omega: 2.0 * error }
    }

    pub(crate) fn arrived(&self) -> bool {
        (self.goal - self.pose.position()).norm() < 0.03
    }
}

pub(crate) struct Bed<'a> {
    pub(crate) robots: Vec<Robot>,
    /// Positions and velocities of robots that are carried by hand: they follow no filter, and all know it.
    pub(crate) intruders: Vec<(Vector2<f64>, Vector2<f64>)>,
    pub(crate) obstacles: Vec<MovingOutline<'a>>,
    pub(crate) period: u32,
    pub(crate) delay: u32,
    pub(crate) now: u32,
    pub(crate) filter: SafetyFilter,
}

impl<'a> Bed<'a> {
    pub(crate) fn new(robots: Vec<Robot>, period: u32, delay: u32) -> Self {
        let parameters = SafetyParameters {
            radius: RADIUS,
            half_axle: HALF_AXLE,
            delay: f64::from(delay) / 1000.0,
            period: f64::from(period) / 1000.0,
            braking: WHEEL_ACCELERATION,
            margin: MARGIN,
            detour_speed: 0.12,
        };
        let filter = SafetyFilter::new(parameters).unwrap();
        Self { robots, intruders: Vec::new(), obstacles: Vec::new(), period, delay, now: 0, filter }
    }

    /// One millisecond; a tick of all controllers when it is due.
    pub(crate) fn step(&mut self) {
        if self.now.is_multiple_of(self.period) {
            self.tick();
        }
        for robot in &mut self.robots {
            robot.step(self.now);
        }
        for (position, velocity) in &mut self.intruders {
            *position += 0.001 * *velocity;
        }
        self.now += 1;
    }

    fn tick(&mut self) {
        let seen = self.robots.clone();
        for (index, robot) in self.robots.iter_mut().enumerate() {
            let mut neighbours = Vec::new();
            for (other_index, other) in seen.iter().enumerate() {
                if other_index != index {
                    let (position, velocity) = (other.pose.position(), other.velocity());
                    let settled = other.arrived();
                    neighbours.push(Neighbour { position, velocity, radius: RADIUS, cooperative: true, settled });
                }
            }
            for &(position, velocity) in &self.intruders {
                neighbours.push(Neighbour { position, velocity, radius: RADIUS, cooperative: false, settled: false });
            }
            let scene = Scene { neighbours: &neighbours, obstacles: &self.obstacles, field: &FIELD };
            let wish = Wish { twist: robot.law(), goal: Some(robot.goal), kept: None, pace: 0.0 };
            let filtered = self.filter.apply(robot.pose, robot.twist(), wish, &scene);
            assert!(filtered.acted.is_some() || filtered.twist == wish.twist);
            robot.command(self.now + self.delay, filtered.twist);
        }
    }

    /// Least space between any two robots, and between robots and the edges of the field.
    pub(crate) fn least_gap(&self) -> f64 {
        let mut least = f64::INFINITY;
        for (index, robot) in self.robots.iter().enumerate() {
            let p = robot.pose.position();
            for other in &self.robots[..index] {
                least = least.min((p - other.pose.position()).norm() - 2.0 * RADIUS);
            }
            least = least.min(p.x.min(2.48 - p.x).min(p.y).min(1.83 - p.y) - RADIUS);
            for obstacle in &self.obstacles {
                least = least.min(obstacle.outline.approach(p).gap - RADIUS);
            }
        }
        least
    }

    pub(crate) fn all_arrived(&self) -> bool {
        self.robots.iter().all(Robot::arrived)
    }
}

/// Random poses and goals for `count` robots.
pub(crate) fn random_team(seed: u64, count: usize) -> Vec<Robot> {
    let random = &mut Random(seed);
    let starts = random.places(count, 2.0 * RADIUS + MARGIN);
    let goals = random.places(count, 2.0 * RADIUS + MARGIN);
    let place = |(start, goal): (&Vector2<f64>, &Vector2<f64>)| {
        Robot::new(Pose::new(start.x, start.y, random.between(-3.1, 3.1)), *goal)
    };
    starts.iter().zip(&goals).map(place).collect()
}

/// Random poses, goals and wheel speeds: any that leave each robot, as it is, room to stop, of which half is another robot's.
pub(crate) fn random_team_under_way(seed: u64, count: usize, wait: f64) -> Vec<Robot> {
    let random = &mut Random(seed + 31_415);
    let mut team = random_team(seed, count);
    for index in 0..count {
        let at = team[index].pose.position();
        let others = team.iter().enumerate().filter(|(other, _)| *other != index);
        let gaps = others.map(|(_, other)| 0.5 * ((other.pose.position() - at).norm() - 2.0 * RADIUS - MARGIN));
        let edge = at.x.min(2.48 - at.x).min(at.y).min(1.83 - at.y) - RADIUS - MARGIN;
        let room = gaps.fold(edge, f64::min);
        let mut wheel = || random.between(-MOST_WHEEL_SPEED, MOST_WHEEL_SPEED);
        let tried = (0..20).map(|_| team[index].clone().running([wheel(), wheel()]));
        if let Some(running) = tried.into_iter().find(|robot| robot.stopping(wait) <= room) {
            team[index] = running;
        }
    }
    team
}
