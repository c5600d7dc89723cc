//! Configuration against the theory, before anything moves: what `trench check` says.
//!
//! Everything here takes what has been read (parameters, plans, scenarios) and gives [`Verdict`]s: what was looked at, whether it holds,
//! the equation that decides. Nothing reads a file.

mod approach;
mod bounds;
mod chain;
mod chatter;
mod chatter_of_scenario;
mod clearance;
mod connection;
mod controller;
mod damping;
mod damping_of_scenario;
mod direction;
mod drawn;
mod gains;
mod gaps;
mod goal;
mod goal_among_obstacles;
mod growth;
mod limits;
mod passing;
mod potential;
mod queue;
mod queue_of_scenario;
mod report;
mod room;
mod scenario;
mod separation;
mod separation_of_goals;
mod separation_of_queue;
mod standing;
mod starts;
mod starts_of_scenario;
mod step;
mod step_of_scenario;
mod stiffness;
mod stopping;
mod stopping_of_scenario;
mod team;
mod transits;
mod verdict;
mod vertices;
mod walls;
mod walls_of_controller;
mod walls_of_scenario;
mod zones;

pub use chain::{ChainOfRobots, chain};
pub use controller::{Controller, controller};
pub use direction::{Approach, direction};
pub use gaps::{Passing, gaps};
pub use potential::potential;
pub use queue::formation;
pub use report::Report;
pub use scenario::{infeasible, scenario};
pub use standing::Standing;
pub use team::{Along, Start, Team, team};
pub use verdict::{Values, Verdict};
pub use zones::zones;
