//! A cycle of the mapper: twenty robots' scans of 180 rays and thirty obstacles, ten of them moving.
//!
//! `cargo bench -p obstacle_mapper --bench cycle`
#![expect(clippy::unwrap_used, reason = "a benchmark that cannot run fails")]

use criterion::{Criterion, criterion_group, criterion_main};
use obstacle_mapper::description;
use std::time::{Duration, Instant};
use trench_config::params::{Source as Setting, resolve};
use trench_config::{ConfigError, Parameters};
use trench_core::{Event, Files, NodeContext, NodeCore, Outbox, RosTime, Source, Steady, Times};
use trench_msgs::Encode;
use trench_msgs::msg::{Obstacle, ObstacleArray, Point2, RobotState, TeamState};
use trench_msgs::sensor_msgs::LaserScan;
use trench_msgs::std_msgs::Header;

const ROBOTS: usize = 20;
const OBSTACLES: usize = 30;
const RAYS: usize = 180;

struct NoFiles;

impl Files for NoFiles {
    fn read(&self, key: &str, _: &str) -> Result<String, ConfigError> {
        Err(Parameters::default().error(key, "cannot be read", "name no file"))
    }
}

fn robot(index: usize) -> [f64; 2] {
    [0.4 + 0.8 * (index % 5) as f64, 0.35 + 0.7 * (index / 5) as f64]
}

/// Discs and boxes between the robots, on a lattice of 6 by 5.
fn obstacle(index: usize) -> ([f64; 2], f64) {
    ([0.1 + 0.75 * (index % 6) as f64, 0.1 + 0.65 * (index / 6) as f64], 0.05 + 0.002 * index as f64)
}

fn messages(at: RosTime, told: usize) -> (ObstacleArray, TeamState, Vec<LaserScan>) {
    let header = Header { stamp: at.into(), ..Header::default() };
    let box_of = |index: usize| {
        let ([x, y], size) = obstacle(index);
        let corner = |dx: f64, dy: f64| Point2 { x: x + dx * size, y: y + dy * size };
        let velocity = Point2 { x: if index < 10 { 0.05 } else { 0.0 }, y: 0.0 };
        let polygon = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        Obstacle { id: index as u32, polygon, radius: 0.0, velocity }
    };
    let state = |index: usize| {
        let [x, y] = robot(index);
        let name = format!("robot{}", index + 1);
        RobotState { name, status: RobotState::STATUS_TRACKED, x, y, ..RobotState::default() }
    };
    let range = |from: [f64; 2], angle: f64| {
        let (sin, cos) = libm::sincos(angle);
        let circles = (0..OBSTACLES).map(obstacle).chain((0..ROBOTS).map(|index| (robot(index), 0.08)));
        let ranges = circles.filter_map(|([x, y], radius)| {
            let (dx, dy) = (x - from[0], y - from[1]);
            let (along, beside) = (dx * cos + dy * sin, dx * sin - dy * cos);
            let chord = radius * radius - beside * beside;
            (along > 0.05 && chord > 0.0).then(|| along - chord.sqrt())
        });
        ranges.fold(f64::INFINITY, f64::min) as f32
    };
    let scan = |index: usize| LaserScan {
        header: header.clone(),
        angle_increment: (std::f64::consts::TAU / RAYS as f64) as f32,
        range_min: 0.1,
        range_max: 3.5,
        ranges: (0..RAYS).map(|ray| range(robot(index), std::f64::consts::TAU * ray as f64 / RAYS as f64)).collect(),
        ..LaserScan::default()
    };
    (
        ObstacleArray { header: header.clone(), obstacles: (0..told).map(box_of).collect() },
        TeamState { header: header.clone(), robots: (0..ROBOTS).map(state).collect(), ..TeamState::default() },
        (0..ROBOTS).map(scan).collect(),
    )
}

/// The mapper and its time.
struct Cycle {
    core: Box<dyn NodeCore>,
    out: Outbox,
    tick: u64,
    /// Of the obstacles, how many are told of; lasers see all of them.
    told: usize,
}

impl Cycle {
    fn new(told: usize) -> Self {
        let names: Vec<String> = (1..=ROBOTS).map(|robot| format!("robot{robot}")).collect();
        let robots = format!("[{}]", names.join(", "));
        let node = description();
        let settings = [Setting::Override { node: None, name: "robots", value: &robots }];
        let parameters = resolve(&settings, "/", node.name, &(node.parameters)()).unwrap();
        let context = NodeContext { namespace: "/".to_owned(), name: node.name.to_owned(), ..NodeContext::default() };
        let core = (node.build)(&context, &parameters, &NoFiles).unwrap();
        Self { core, out: Outbox::default(), tick: 0, told }
    }

    fn at(&self) -> Times {
        Times { ros: RosTime(self.tick as i64 * 100_000_000), steady: Steady(self.tick * 100_000_000) }
    }

    /// The messages of the next tenth of a second: obstacles, team state, scans.
    fn input(&mut self) -> Vec<Vec<u8>> {
        self.tick += 1;
        self.out.take();
        let (obstacles, team, scans) = messages(self.at().ros, self.told);
        let mut cdr = vec![obstacles.to_cdr(), team.to_cdr()];
        cdr.extend(scans.iter().map(Encode::to_cdr));
        cdr
    }

    /// Takes them, obstacles last: with them the mapper publishes.
    fn run(&mut self, input: &[Vec<u8>]) {
        let (at, source) = (self.at(), Source::default());
        for (port, cdr) in input.iter().enumerate().skip(1).chain(input.iter().enumerate().take(1)) {
            self.core.handle(at, Event::Message { port, source, cdr, arrived: None }, &mut self.out);
        }
    }
}

fn cycle(criterion: &mut Criterion) {
    for told in [OBSTACLES, OBSTACLES / 2, 0] {
        criterion.bench_function(&format!("mapper cycle, 20 scans, {told} of 30 obstacles told"), |bencher| {
            let mut cycle = Cycle::new(told);
            bencher.iter_custom(|iterations| {
                let mut total = Duration::ZERO;
                for _ in 0..iterations {
                    let input = cycle.input();
                    let began = Instant::now();
                    cycle.run(&input);
                    total += began.elapsed();
                }
                total
            });
        });
    }
}

criterion_group!(benches, cycle);
criterion_main!(benches);
