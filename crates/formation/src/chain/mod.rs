//! Chains of leader-follower pairs (6.2.1), and where robots join them (A.22).

mod join;
mod organise;

pub use join::joining;
pub use organise::organise;

use nalgebra::Vector2;
use thiserror::Error;

/// A robot of a team.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robot<'a> {
    /// Unlike any other's.
    pub name: &'a str,
    /// Centre, m, frame `map`.
    pub position: Vector2<f64>,
}

/// Why a team cannot be a chain.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ChainError {
    /// A position that is NaN or infinite.
    #[error("the position of robot `{0}` is not finite: it must be localised before the team is organised")]
    NotFinite(String),
    /// A team goal that is NaN or infinite.
    #[error("the team goal is not finite: give its coordinates in metres")]
    GoalNotFinite,
    /// Two robots of one name.
    #[error("two robots are named `{0}`: give each its own name")]
    DuplicateName(String),
}

/// Whom a robot follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Leader<'a> {
    /// The team goal: this is r1, the chain leader.
    TeamGoal,
    /// The robot of this name.
    Robot(&'a str),
}

/// A team in order: r1, the chain leader, first.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Chain {
    names: Vec<String>,
}

impl Chain {
    /// Names by rank, the chain leader first.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Rank of a robot, 1 for the chain leader.
    pub fn rank(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|other| other == name).map(|index| index + 1)
    }

    /// Whom a robot follows; `None` if it is not in the chain.
    pub fn leader(&self, name: &str) -> Option<Leader<'_>> {
        match self.rank(name)? {
            1 => Some(Leader::TeamGoal),
            rank => Some(Leader::Robot(&self.names[rank - 2])),
        }
    }
}

fn check(robots: &[Robot<'_>]) -> Result<(), ChainError> {
    for (index, robot) in robots.iter().enumerate() {
        if !(robot.position.x.is_finite() && robot.position.y.is_finite()) {
            return Err(ChainError::NotFinite(robot.name.to_owned()));
        }
        if robots[..index].iter().any(|other| other.name == robot.name) {
            return Err(ChainError::DuplicateName(robot.name.to_owned()));
        }
    }
    Ok(())
}
