//! Running a scenario.

use crate::law::ChosenLaw;
use crate::{Bounds, ComparedCase, GoalCase, GoalLaw, Plant, Scenario, Task};
use trench_formation::Vector2;
use trench_formation::compared::{AnyGuide, Trip};
use trench_formation::hull::{ApparentObstacle, Obstacle};
use trench_formation::kinematics::{HandState, HilareState, PointState, Twist};
use trench_formation::laws::Steered;
use trench_formation::simulate::{
    BoundedTeam, ChainSimulation, GoalTeam, HilareTeam, QueueChange, QueueTeam, Regulation, ScenarioError, WaveGoals,
    WheelEffort, Workers, ZonedChain,
};
use trench_formation::trench::{AnyDamping, AnyTrench};

/// Why a run cannot go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RunError {
    /// See [`ScenarioError`].
    #[error(transparent)]
    Chain(#[from] ScenarioError),
    /// A launch file is driven by node cores, not by this crate.
    #[error("the scenario names a launch file, which has node cores of its own")]
    Launch,
    /// A number overflowed: gains too high for the step.
    #[error("at {time} s the state of {robot} is no longer finite: make the step smaller, or the gains")]
    Diverged {
        /// s.
        time: f64,
        /// Which.
        robot: String,
    },
}

/// One robot at one time, SI units, frame `map`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// m.
    pub position: Vector2<f64>,
    /// m/s.
    pub velocity: Vector2<f64>,
    /// m/s^2; 0 for unicycles.
    pub acceleration: Vector2<f64>,
    /// rad: of the body, or of the velocity.
    pub heading: f64,
    /// m/s, forward; of Hilare robots v, while position and velocity are those of the hand.
    pub speed: f64,
    /// rad/s.
    pub turn_rate: f64,
    /// What draws it, m.
    pub goal: Option<Vector2<f64>>,
    /// Distance from its goal or nearest point, m; infinite before the first step of a chain.
    pub deviation: f64,
    /// phi of chapter 4, rad; 0 for double integrators.
    pub misalignment: f64,
    /// Integral of v^2 + omega^2 (Table 4.1); 0 for double integrators.
    pub effort: f64,
    /// V of the law and its rate; none where no law was asked.
    pub lyapunov: Option<[f64; 2]>,
    /// Power that what moves around the robot brings into V besides that rate, m^2/s^3.
    pub power: f64,
}

enum Running {
    Regulating(Vec<Regulation<ChosenLaw>>),
    Goals(WaveGoals, Vec<(Team, GoalLaw)>),
    Directed(Box<ZonedChain<AnyTrench>>),
    Nearest(Box<ChainSimulation<AnyTrench>>, Vec<Trip<AnyGuide>>),
    Queue(Box<QueueTeam>),
}

/// Robots that track goal points.
enum Team {
    Points(GoalTeam),
    Bounded(BoundedTeam<AnyTrench, AnyDamping>),
    Bodies(HilareTeam),
}

/// A scenario under way.
pub struct Simulation {
    running: Running,
    names: Vec<String>,
    /// Last heading of each robot, for those that stand.
    headings: Vec<f64>,
    /// The velocities with which the robots of a chain of chapter 7 last moved, m/s: their headings, not yet asked for.
    moved: Vec<Vector2<f64>>,
    step: f64,
    steps: u64,
}

impl Simulation {
    /// Robots at their start.
    ///
    /// # Errors
    /// Scenarios that are launch files; chains that cannot be built.
    pub fn new(scenario: &Scenario) -> Result<Self, RunError> {
        let timing = scenario.timing;
        let running = match &scenario.task {
            Task::Regulating(task) => {
                let robots = task.cases.iter().flat_map(|case| {
                    let robot = |start: &crate::Start| {
                        Regulation::new(case.law, start.0, task.goal, timing.integration, timing.step)
                    };
                    task.starts.iter().map(robot)
                });
                Running::Regulating(robots.collect())
            }
            Task::GoalTracking(task) => {
                let hands = task.robots.iter().zip(&task.headings);
                let hands: Vec<HandState> = hands.map(|(&hand, &theta)| HandState { hand, theta }).collect();
                let fastest = task.goals.fastest();
                let team = |case: &GoalCase| match (case.plant, case.bounds, &case.law) {
                    (Some(Plant { body, drive, commanded }), ..) => {
                        let team = HilareTeam::new(body, &hands, timing.integration, timing.step);
                        Team::Bodies(match drive {
                            Some(drive) if commanded => team.driven_by(drive).commanded(),
                            Some(drive) => team.driven_by(drive),
                            None => team,
                        })
                    }
                    (None, Some(Bounds { limits, radius }), GoalLaw::Trench(law)) => {
                        let (bodies, clock) = ((radius, fastest), (timing.integration, timing.step));
                        Team::Bounded(BoundedTeam::new(task.robots.clone(), law.clone(), limits, bodies, clock))
                    }
                    _ => Team::Points(GoalTeam::new(task.robots.clone(), timing.integration, timing.step)),
                };
                Running::Goals(task.goals, task.cases.iter().map(|case| (team(case), case.law.clone())).collect())
            }
            Task::Directed(task) => {
                Running::Directed(Box::new(ZonedChain::new(task.chain.clone(), timing.integration, timing.step)))
            }
            Task::Nearest(chain, _) => {
                let start = chain.robots.first().map_or_else(Vector2::zeros, |robot| robot.position);
                let trip = |case: &ComparedCase| Trip::new(case.course.clone(), case.guide.clone(), start);
                let compared = scenario.compared.iter().flat_map(|compared| &compared.cases);
                let trips = compared.map(trip).collect::<Result<_, _>>().map_err(ScenarioError::from)?;
                Running::Nearest(Box::new(ChainSimulation::new((**chain).clone())?), trips)
            }
            Task::Queue(task) => {
                Running::Queue(Box::new(QueueTeam::new(task.queue.clone(), timing.integration, timing.step)))
            }
            Task::Launch(_) => return Err(RunError::Launch),
        };
        let names: Vec<String> = scenario.seats().into_iter().map(|seat| seat.name).collect();
        let headings = vec![0.0; names.len()];
        let moved = match &running {
            Running::Nearest(chain, _) => vec![Vector2::zeros(); chain.robots().len()],
            _ => Vec::new(),
        };
        let mut simulation = Self { running, names, headings, moved, step: timing.step, steps: 0 };
        simulation.follow()?;
        Ok(simulation)
    }

    /// Lets others do the work of the robots of a chain of chapter 7, see [`ChainSimulation::with`]. The motion is the same, bit for bit.
    #[must_use]
    pub fn with(self, workers: impl Workers + Send + Sync + 'static) -> Self {
        let running = match self.running {
            Running::Nearest(chain, trips) => Running::Nearest(Box::new(chain.with(workers)), trips),
            other => other,
        };
        Self { running, ..self }
    }

    /// Advances by one step.
    ///
    /// # Errors
    /// States that are no longer finite.
    pub fn step(&mut self) -> Result<(), RunError> {
        match &mut self.running {
            Running::Regulating(robots) => robots.iter_mut().for_each(Regulation::step),
            Running::Goals(goals, teams) => {
                for (team, law) in teams {
                    let (goal, law) = (|index, time| goals.at(index, time), |robot, goal| law.steer(robot, goal));
                    match team {
                        Team::Points(team) => team.step(goal, law),
                        Team::Bounded(team) => team.step(goal),
                        Team::Bodies(team) => team.step(goal, law),
                    }
                }
            }
            Running::Directed(chain) => chain.step(),
            Running::Queue(team) => team.step(),
            Running::Nearest(chain, trips) => {
                chain.step()?;
                trips.iter_mut().for_each(|trip| trip.step(self.step));
            }
        }
        self.steps += 1;
        self.follow()
    }

    /// Looks at the robots of a chain of chapter 7 after every step, whether or not somebody asks for samples.
    fn follow(&mut self) -> Result<(), RunError> {
        let Running::Nearest(chain, _) = &self.running else { return Ok(()) };
        let is_finite = |robot: &PointState| {
            let PointState { position, velocity } = robot;
            (position.x + position.y + velocity.x + velocity.y).is_finite()
        };
        let mut all_finite = true;
        for (robot, moved) in chain.robots().iter().zip(&mut self.moved) {
            all_finite &= is_finite(robot);
            if robot.velocity.norm_squared() > STANDS_SQUARED {
                *moved = robot.velocity;
            }
        }
        if all_finite {
            return Ok(());
        }
        let first = chain.robots().iter().position(|robot| !is_finite(robot));
        first.map_or(Ok(()), |index| Err(self.diverged(index)))
    }

    fn diverged(&self, index: usize) -> RunError {
        RunError::Diverged { time: self.time(), robot: self.names.get(index).cloned().unwrap_or_default() }
    }

    /// Whether [`Measures::take`](crate::Measures::take) needs no samples: a chain of chapter 7, and nothing beside it, tells of its steps itself.
    #[must_use]
    pub fn tells_itself(&self) -> bool {
        self.alone().is_some()
    }

    /// The chain of chapter 7 that is all there is.
    pub(crate) fn alone(&self) -> Option<&ChainSimulation<AnyTrench>> {
        match &self.running {
            Running::Nearest(chain, trips) if trips.is_empty() => Some(chain),
            _ => None,
        }
    }

    /// Seconds simulated.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.step
    }

    /// All robots now, in the order of [`Scenario::seats`], into `samples`. With `wholly` the law is asked again for accelerations
    /// and Lyapunov functions.
    ///
    /// # Errors
    /// States that are no longer finite.
    pub fn sample(&mut self, wholly: bool, samples: &mut Vec<Sample>) -> Result<(), RunError> {
        samples.clear();
        match &self.running {
            Running::Regulating(robots) => samples.extend(robots.iter().map(of_regulation)),
            Running::Goals(goals, teams) => {
                let time = self.steps as f64 * self.step;
                let sample = |law: &GoalLaw, index: usize, robot: PointState| {
                    let goal = goals.at(index, time);
                    let deviation = (goal.position - robot.position).norm();
                    of_point(robot, Some(law.steer(robot, goal)), Some(goal.position), deviation)
                };
                let points = |robots: &[PointState], law: &GoalLaw, samples: &mut Vec<Sample>| {
                    samples.extend(robots.iter().enumerate().map(|(index, robot)| sample(law, index, *robot)));
                };
                for (team, law) in teams {
                    match team {
                        Team::Points(team) => points(team.robots(), law, samples),
                        Team::Bounded(team) => points(team.robots(), law, samples),
                        Team::Bodies(team) => {
                            let seen = team.hands().zip(team.robots()).enumerate();
                            samples.extend(seen.map(|(index, (hand, body))| of_body(sample(law, index, hand), *body)));
                        }
                    }
                }
            }
            Running::Directed(chain) => {
                for (index, robot) in chain.robots().iter().enumerate() {
                    let point = chain.point_of_attraction(index);
                    let steered = wholly.then(|| chain.steered(index));
                    let sample = of_point(*robot, steered, Some(point), (point - robot.position).norm());
                    samples.push(Sample { power: if wholly { chain.power(index) } else { 0.0 }, ..sample });
                }
            }
            Running::Queue(team) => {
                for (index, robot) in team.robots().iter().enumerate() {
                    let (acceleration, point) = team.drawn(index);
                    let sample = of_point(*robot, None, Some(point), (point - robot.position).norm());
                    samples.push(Sample { acceleration, ..sample });
                }
            }
            Running::Nearest(chain, trips) => {
                for (index, robot) in chain.robots().iter().enumerate() {
                    let action = chain.outcomes().get(index);
                    let goal = action.and_then(|action| action.attraction);
                    let deviation = chain.deviations().get(index).copied().unwrap_or(f64::INFINITY);
                    let sample = of_point(*robot, action.map(|action| action.steered), goal, deviation);
                    samples.push(Sample { power: action.map_or(0.0, |action| action.power), ..sample });
                }
                samples.extend(trips.iter().map(|trip| {
                    let (robot, goal) = (trip.robot(), trip.goal());
                    of_point(robot, None, Some(goal), (goal - robot.position).norm())
                }));
            }
        }
        for (heading, moved) in self.headings.iter_mut().zip(&self.moved) {
            *heading = libm::atan2(moved.y, moved.x);
        }
        for (index, (sample, heading)) in samples.iter_mut().zip(&mut self.headings).enumerate() {
            if !(sample.position.x + sample.position.y + sample.velocity.x + sample.velocity.y).is_finite() {
                return Err(self.diverged(index));
            }
            // A point without velocity looks where it last went.
            if sample.heading.is_nan() {
                sample.heading = *heading;
            }
            *heading = sample.heading;
        }
        Ok(())
    }

    /// What has befallen a queue, or the links of a chain, so far, in time.
    #[must_use]
    pub fn changes(&self) -> &[QueueChange] {
        match &self.running {
            Running::Queue(team) => team.changes(),
            Running::Directed(chain) => chain.changes(),
            Running::Nearest(chain, _) => chain.changes(),
            _ => &[],
        }
    }

    /// What the motors of each robot of a case were asked for so far, by rank; nothing where robots have none.
    #[must_use]
    pub fn wheel_efforts(&self, case: usize) -> &[WheelEffort] {
        match &self.running {
            Running::Goals(_, teams) => match teams.get(case) {
                Some((Team::Bodies(team), _)) => team.efforts(),
                _ => &[],
            },
            _ => &[],
        }
    }

    /// Real obstacles as the robots know them and apparent ones, now.
    #[must_use]
    pub fn known_obstacles(&self) -> Option<(&[Obstacle], &[ApparentObstacle])> {
        match &self.running {
            Running::Nearest(chain, _) => Some((chain.known_obstacles(), chain.obstacles())),
            _ => None,
        }
    }

    /// Real obstacles, now.
    #[must_use]
    pub fn obstacles(&self) -> Option<&[Obstacle]> {
        match &self.running {
            Running::Nearest(chain, _) => Some(chain.real_obstacles()),
            _ => None,
        }
    }
}

fn of_regulation(robot: &Regulation<ChosenLaw>) -> Sample {
    let (pose, twist, polar) = (robot.pose(), robot.twist(), robot.polar());
    let lyapunov = trench_formation::laws::Lyapunov::of(polar, twist);
    Sample {
        position: pose.position(),
        velocity: twist.v * pose.heading(),
        acceleration: Vector2::zeros(),
        heading: pose.theta,
        speed: twist.v,
        turn_rate: twist.omega,
        goal: Some(robot.goal()),
        deviation: polar.distance,
        misalignment: polar.misalignment,
        effort: robot.effort(),
        lyapunov: Some([lyapunov.value, lyapunov.rate]),
        power: 0.0,
    }
}

/// Below this speed a point has no heading, m/s.
const STANDS: f64 = 1e-9;

/// The greatest square of which the root is no more, m^2/s^2.
const STANDS_SQUARED: f64 = 1.0000000000000003e-18;

/// A hand, with the heading and the speeds of its body.
fn of_body(hand: Sample, HilareState { pose, twist: Twist { v, omega } }: HilareState) -> Sample {
    Sample { heading: pose.theta, speed: v, turn_rate: omega, ..hand }
}

fn of_point(robot: PointState, steered: Option<Steered>, goal: Option<Vector2<f64>>, deviation: f64) -> Sample {
    let PointState { position, velocity } = robot;
    let acceleration = steered.map_or_else(Vector2::zeros, |steered| steered.acceleration);
    let speed = velocity.norm();
    let moves = speed > STANDS;
    Sample {
        position,
        velocity,
        acceleration,
        heading: if moves { libm::atan2(velocity.y, velocity.x) } else { f64::NAN },
        speed,
        turn_rate: if moves { velocity.perp(&acceleration) / (speed * speed) } else { 0.0 },
        goal,
        deviation,
        misalignment: 0.0,
        effort: 0.0,
        lyapunov: steered.map(|steered| [steered.lyapunov, steered.lyapunov_rate]),
        power: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_stands_is_known_by_the_square() {
        assert!(STANDS_SQUARED.sqrt() <= STANDS && STANDS_SQUARED.next_up().sqrt() > STANDS);
    }
}
