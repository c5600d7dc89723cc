//! Lock-step simulation of chains of double integrators under (7.13), and of what chapters 4 to 6 simulate:
//! [`Regulation`] 4.4, [`GoalTeam`] 5.6 and within bounds [`BoundedTeam`], [`ZonedChain`] 6.5.
//!
//! Nothing is drawn at random and sums have a fixed order: the same scenario gives the same bytes. In a [`ChainSimulation`],
//! whose accelerations are held for fixed steps, what robots know of one another is sampled at ticks of several steps; steps
//! allocate nothing while the segment, or what encroaches on it, rests.
mod act;
mod bounded_team;
mod carriage;
mod chain;
mod goal_team;
mod grid;
mod hilare_team;
mod integrate;
mod judge;
mod links;
mod marks;
mod neighbours;
mod observe;
mod queue_team;
mod random;
mod regulation;
mod scenario;
mod sight;
mod vicinity;
mod workers;
mod zoned_chain;

pub use crate::agent::{Encroaching, Remedies};
pub use bounded_team::BoundedTeam;
pub use carriage::Carriage;
pub use chain::ChainSimulation;
pub use goal_team::{GoalTeam, WaveGoals};
pub use hilare_team::{HilareTeam, WheelEffort};
pub use integrate::Integration;
pub use judge::{Standard, Verdict, judge};
pub use neighbours::Neighbours;
pub use observe::Outcome;
pub use queue_team::{
    BrokenLink, QueueChange, QueueEvent, QueueRobotScenario, QueueScenario, QueueTeam, Quitting, Recovery,
};
pub use random::{
    BODY_RADIUS, CAPABILITY, random_team, random_team_among_concave_obstacles, random_team_on_other_segments,
};
pub use regulation::Regulation;
pub use scenario::{ChainScenario, Options, ScenarioError};
pub use sight::Sight;
pub use workers::{Alone, Share, Workers};
pub use zoned_chain::{ZonedChain, ZonedChainScenario};
