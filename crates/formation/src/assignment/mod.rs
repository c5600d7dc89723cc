//! Assignment of robots to queues and places.
//!
//! Shares become numbers of places ([`robots_per_queue`]); robots get places at the least sum of squared distances, kept
//! while nothing is clearly better ([`assign_to_queues`], [`reassign`]); the optimum carries its proof ([`Optimum`]).
mod cheapest;
mod hysteresis;
mod search;
mod shares;
mod solve;

pub use hysteresis::{Hysteresis, assign_to_queues, reassign};
pub use shares::robots_per_queue;
pub use solve::{Optimum, solve, solve_again};

use crate::Vector2;
use thiserror::Error;

/// Why there is no assignment.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum AssignmentError {
    /// A cost that is NaN or infinite.
    #[error("the cost of row {row} and column {column} is {value}: every robot and place needs a finite position")]
    NotFinite {
        /// Robot.
        row: usize,
        /// Place.
        column: usize,
        /// The cost.
        value: f64,
    },
    /// Numbers that do not make a matrix.
    #[error("{values} values do not fit {columns} columns: give one value for each robot and queue")]
    Shape {
        /// Values given.
        values: usize,
        /// Columns wanted.
        columns: usize,
    },
    /// More robots than places.
    #[error("{rows} robots do not fit into {columns} places: raise the shares or remove robots")]
    TooFewPlaces {
        /// Robots.
        rows: usize,
        /// Places.
        columns: usize,
    },
    /// A share that is no fraction.
    #[error("the share of queue {queue} is {value}, but must be between 0 and 1")]
    Share {
        /// Which queue.
        queue: usize,
        /// Its share.
        value: f64,
    },
    /// Shares that leave robots over.
    #[error("the shares of the queues add up to {0}, but must add up to 1")]
    ShareSum(f64),
}

/// Costs of rows (robots) in columns (places), finite by construction.
#[derive(Debug, Clone, PartialEq)]
pub struct CostMatrix {
    values: Vec<f64>,
    rows: usize,
    columns: usize,
}

impl CostMatrix {
    /// From values row by row.
    ///
    /// # Errors
    /// Values that are not finite, or not `rows` times `columns` many.
    pub fn new(values: Vec<f64>, rows: usize, columns: usize) -> Result<Self, AssignmentError> {
        if rows.checked_mul(columns) != Some(values.len()) {
            return Err(AssignmentError::Shape { values: values.len(), columns });
        }
        // To look at all is quicker than to stop at the first.
        if values.iter().fold(true, |finite, value| finite & value.is_finite()) {
            return Ok(Self { values, rows, columns });
        }
        let at = values.iter().position(|value| !value.is_finite()).unwrap_or(0);
        Err(AssignmentError::NotFinite { row: at / columns, column: at % columns, value: values[at] })
    }

    /// Squared distances (m^2) of robots, a row each, from places, a column each.
    ///
    /// # Errors
    /// Positions that are not finite, or too far apart to square.
    pub fn squared_distances(robots: &[Vector2<f64>], places: &[Vector2<f64>]) -> Result<Self, AssignmentError> {
        let mut values = Vec::with_capacity(robots.len() * places.len());
        for robot in robots {
            values.extend(places.iter().map(|place| (robot - place).norm_squared()));
        }
        Self::new(values, robots.len(), places.len())
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Costs of a row in all columns.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.columns..(row + 1) * self.columns]
    }

    /// Cost of a row in a column.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.columns + column]
    }
}
