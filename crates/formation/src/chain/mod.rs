//! Chains of leader-follower pairs (6.2.1) and how they change (8.4, A.22).
mod organise;

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
    /// A robot that is not there.
    #[error("robot `{0}` is not in the chain")]
    Unknown(String),
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

    /// A robot quits: the one behind it follows the one ahead of it, no other pair changes (A.22, case 2.1).
    ///
    /// # Errors
    /// A robot that is not in the chain.
    pub fn quit(&mut self, name: &str) -> Result<(), ChainError> {
        let rank = self.rank(name).ok_or_else(|| ChainError::Unknown(name.to_owned()))?;
        self.names.remove(rank - 1);
        Ok(())
    }

    /// A robot joins where it lengthens the chain least, measured from the team goal along the pairs; to the rear of
    /// equals. The order of the others stays, so one pair at most is taken apart (A.22, case 2.2). `robots` has at
    /// least the members and the newcomer.
    ///
    /// # Errors
    /// A newcomer who is already a member; positions that are missing or not finite; two robots of one name.
    pub fn join(&mut self, newcomer: &str, robots: &[Robot<'_>], goal: Vector2<f64>) -> Result<(), ChainError> {
        check(robots)?;
        if self.rank(newcomer).is_some() {
            return Err(ChainError::DuplicateName(newcomer.to_owned()));
        }
        let position = |name: &str| {
            let robot = robots.iter().find(|robot| robot.name == name);
            robot.map(|robot| robot.position).ok_or_else(|| ChainError::Unknown(name.to_owned()))
        };
        let own = position(newcomer)?;
        let (mut best, mut ahead) = ((f64::INFINITY, 0), goal);
        for index in 0..=self.names.len() {
            let detour = match self.names.get(index) {
                Some(behind) => {
                    let behind = position(behind)?;
                    let detour = (own - ahead).norm() + (behind - own).norm() - (behind - ahead).norm();
                    ahead = behind;
                    detour
                }
                None => (own - ahead).norm(),
            };
            if detour <= best.0 {
                best = (detour, index);
            }
        }
        self.names.insert(best.1, newcomer.to_owned());
        Ok(())
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
