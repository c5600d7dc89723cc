//! Simulations as people write them: [`parse`] reads a scenario file, [`Simulation`] runs it in steps, [`Measures`] judges it.
//!
//! A file names one of the simulations of the thesis by its `kind`, and everything it needs in SI units: robots, segment,
//! law, gains, potentials, zones, obstacles, step, duration. docs/scenarios.md describes the format.

mod closest;
mod collisions;
mod course;
mod divergence;
mod four;
mod gaps;
mod launch;
mod law;
mod measures;
mod neutral;
mod read;
mod robots;
mod room;
mod scenario;
mod simulation;
mod summary;
mod team;
mod transits;

pub use launch::{Argument, Launch};
pub use law::{ChosenLaw, GoalLaw};
pub use measures::Measures;
pub use read::{is_scenario, parse};
pub use scenario::{
    Bounds, Compared, ComparedCase, Directed, Drawing, Figure, GoalCase, GoalTracking, Plant, Queue, Regulating,
    RegulatingCase, Scenario, Seat, Start, Task, Timing,
};
pub use simulation::{RunError, Sample, Simulation};
pub use summary::{
    CaseSummary, ChangeSummary, CollisionSummary, DivergedSummary, LyapunovSummary, ObstacleSummary, OutsideSummary,
    RobotSummary, Summary, TransitSummary, Transits, WheelSummary,
};
