//! What a scenario file says.

use crate::{ChosenLaw, GoalLaw, Launch};
use trench_formation::Vector2;
use trench_formation::compared::{AnyGuide, Course};
use trench_formation::curve::{Curve, CurveShape};
use trench_formation::kinematics::{Hilare, PointState, Pose, WheelDrive};
use trench_formation::laws::Capability;
use trench_formation::simulate::{ChainScenario, Integration, QueueScenario, WaveGoals, ZonedChainScenario};
use trench_formation::stability::TwoGainLaw;
use trench_formation::trench::AnyTrench;
use trench_formation::zoning::Zoning;

/// A simulation, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Its name.
    pub name: String,
    /// The section of the thesis that it reproduces; empty for others.
    pub section: String,
    /// A robot conforms once it is for good within this distance of what draws it, m.
    pub tolerance: f64,
    /// Step and duration.
    pub timing: Timing,
    /// What is simulated.
    pub task: Task,
    /// Other methods of 7.8, for a robot that starts where the chain's only one does.
    pub compared: Option<Compared>,
    /// The pictures that the thesis shows of it.
    pub figures: Vec<Figure>,
}

/// What apparent obstacles are compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// What legends say of the scheme itself.
    pub label: String,
    /// The others.
    pub cases: Vec<ComparedCase>,
}

/// A robot under another method (7.8).
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedCase {
    /// Part of its robot's name.
    pub name: String,
    /// What legends say.
    pub label: String,
    /// Its walls and potentials.
    pub course: Course,
    /// What leads it besides.
    pub guide: AnyGuide,
}

/// When and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// s.
    pub duration: f64,
    /// s.
    pub step: f64,
    /// How the equations are integrated.
    pub integration: Integration,
    /// Steps between two recorded instants.
    pub record_every: u64,
}

/// What is simulated.
#[derive(Debug, Clone, PartialEq)]
pub enum Task {
    /// 4.4.
    Regulating(Regulating),
    /// 5.5, 5.6.
    GoalTracking(GoalTracking),
    /// 6.5.
    Directed(Box<Directed>),
    /// Chapter 7.
    Nearest(Box<ChainScenario<AnyTrench>>, CurveShape),
    /// Chapter 8.
    Queue(Box<Queue>),
    /// 4.6: node cores in lock-step.
    Launch(Launch),
}

/// Unicycles under laws of chapter 4, one team a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Regulating {
    /// Where they go, m.
    pub goal: Vector2<f64>,
    /// The laws.
    pub cases: Vec<RegulatingCase>,
    /// Where robots start.
    pub starts: Vec<Start>,
}

/// A start of a unicycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start(pub Pose);

/// One of several laws.
#[derive(Debug, Clone, PartialEq)]
pub struct RegulatingCase {
    /// Part of its robots' names.
    pub name: String,
    /// What legends say.
    pub label: String,
    /// Its law.
    pub law: ChosenLaw,
}

/// Double integrators, or robots that feedback makes double integrators of, with goal points on a wave.
#[derive(Debug, Clone, PartialEq)]
pub struct GoalTracking {
    /// The goal points.
    pub goals: WaveGoals,
    /// The laws.
    pub cases: Vec<GoalCase>,
    /// Robots of each case; of Hilare robots their hands.
    pub robots: Vec<PointState>,
    /// Headings of their bodies at the start, rad.
    pub headings: Vec<f64>,
}

/// One of several laws.
#[derive(Debug, Clone, PartialEq)]
pub struct GoalCase {
    /// Part of its robots' names.
    pub name: String,
    /// What legends say.
    pub label: String,
    /// Its law.
    pub law: GoalLaw,
    /// The body that the law drives through T1 and T2 (3.1.1); none: the robots are double integrators (3.4).
    pub plant: Option<Plant>,
    /// What the robots can do (9.2), of double integrators under [`GoalLaw::Trench`]; none: whatever the law asks for.
    pub bounds: Option<Bounds>,
}

/// A robot of 3.1.1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plant {
    /// Its body.
    pub body: Hilare,
    /// The motors that move it; none: force and torque are what the feedback asks for.
    pub drive: Option<WheelDrive>,
    /// Whether the robot takes the wheel speeds that its motors would bring about, and not their torques.
    pub commanded: bool,
}

/// Bounded actuators, and bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Relative to goal points.
    pub limits: Capability,
    /// m, with what is to be left between bodies: the law ends in the safety filter; none: robots are points.
    pub radius: Option<f64>,
}

/// A chain along directions of attraction.
#[derive(Debug, Clone, PartialEq)]
pub struct Directed {
    /// What is simulated.
    pub chain: ZonedChainScenario<AnyTrench>,
    /// The whole segment, m.
    pub segment: CurveShape,
    /// The same with its open ends.
    pub curve: Curve,
}

/// A queue under the linear laws (8.7) and (8.11).
#[derive(Debug, Clone, PartialEq)]
pub struct Queue {
    /// What is simulated.
    pub queue: QueueScenario,
    /// The whole segment, m.
    pub segment: CurveShape,
}

/// A picture of the thesis.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Its number, for example "6.7".
    pub number: String,
    /// What it shows, for people.
    pub title: String,
    /// What is drawn.
    pub drawing: Drawing,
    /// Only these robots (`r5`) of each case; all where it is empty.
    pub robots: Vec<String>,
    /// Only these cases; all where it is empty.
    pub cases: Vec<String>,
    /// When, s: snapshots, or the end of paths.
    pub at: Vec<f64>,
    /// Part of the map, m, or of time and values: left, right, bottom, top.
    pub window: Option<[f64; 4]>,
}

impl Figure {
    /// The name of its picture's file, without an extension.
    pub fn file_name(&self) -> String {
        let plain = |letter: char| if letter.is_ascii_alphanumeric() || letter == '.' { letter } else { '-' };
        let name: String = format!("figure-{}", self.number).chars().map(plain).collect();
        name.replace("--", "-").trim_end_matches('-').to_owned()
    }
}

/// Kinds of pictures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drawing {
    /// Paths.
    Trajectories,
    /// Where everything is at some times.
    Snapshots,
    /// Distance to what draws each robot, over time.
    Errors,
    /// phi over time.
    Misalignments,
    /// Distance to the leader over time.
    LeaderDistances,
    /// Value of each robot's Lyapunov function over time.
    Lyapunov,
    /// Curvature of the path over time.
    Curvatures,
    /// Forward and turning speed and heading over time.
    Speeds,
    /// Si(x) and Si(2x)/2 (4.2.1), which need no run.
    SineIntegrals,
    /// S1 of (3.9) or S2 of (3.10) (4.2.3), which need no run.
    CurvatureTrends(TwoGainLaw),
    /// Where phi = -K4/K2 sin(2 phi) (4.3.1), about the ratio beyond which it has more solutions than 0. Needs no run.
    Solutions {
        /// c1 or c2.
        critical: f64,
    },
    /// The stable wedge of 4.3.1, which needs no run.
    StableWedge {
        /// K2 up to which it is drawn, 1/s; negative for the other half of the plane.
        most: f64,
    },
    /// The same among K1, K2 and K3 themselves, which needs no run.
    WedgeInSpace,
}

/// A robot's place in a scenario.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seat {
    /// Unique: `r3`, or `<case>_r3` where there are several cases.
    pub name: String,
    /// Index of its case.
    pub case: usize,
    /// Place in its case or chain, from 1.
    pub rank: usize,
    /// Index of its leader among all seats, in chains.
    pub leader: Option<usize>,
}

impl Scenario {
    /// Name and label of each case: one without a name where there are no several.
    #[must_use]
    pub fn cases(&self) -> Vec<(&str, &str)> {
        match &self.task {
            Task::Regulating(task) => task.cases.iter().map(|case| (&*case.name, &*case.label)).collect(),
            Task::GoalTracking(task) => task.cases.iter().map(|case| (&*case.name, &*case.label)).collect(),
            Task::Directed(_) | Task::Nearest(..) => match &self.compared {
                Some(compared) => core::iter::once(("apparent", &*compared.label))
                    .chain(compared.cases.iter().map(|case| (&*case.name, &*case.label)))
                    .collect(),
                None => vec![("", &*self.name)],
            },
            Task::Queue(_) => vec![("", &*self.name)],
            Task::Launch(_) => Vec::new(),
        }
    }

    /// All robots, by case and rank.
    #[must_use]
    pub fn seats(&self) -> Vec<Seat> {
        let (count, is_chain) = match &self.task {
            Task::Regulating(task) => (task.starts.len(), false),
            Task::GoalTracking(task) => (task.robots.len(), false),
            Task::Directed(task) => (task.chain.robots.len(), true),
            Task::Nearest(chain, _) => (chain.robots.len(), true),
            // Where robots come and go nobody follows the same one all the time.
            Task::Queue(task) => (task.queue.robots.len(), task.queue.is_settled()),
            Task::Launch(_) => (0, false),
        };
        let mut seats = Vec::new();
        let cases = self.cases();
        for (case, (name, _)) in cases.iter().enumerate() {
            for rank in 1..=count {
                let name = if cases.len() > 1 { format!("{name}_r{rank}") } else { format!("r{rank}") };
                let leader = (is_chain && rank > 1).then(|| seats.len() - 1);
                seats.push(Seat { name, case, rank, leader });
            }
        }
        seats
    }

    /// The zones of a chain.
    #[must_use]
    pub fn zoning(&self) -> Option<&Zoning> {
        match &self.task {
            Task::Directed(task) => Some(&task.chain.law.zoning),
            Task::Nearest(chain, _) => Some(&chain.zoning),
            _ => None,
        }
    }
}
