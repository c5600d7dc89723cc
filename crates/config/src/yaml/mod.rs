//! YAML that remembers where each value stands.
//!
//! ```
//! # fn main() -> Result<(), trench_config::ConfigError> {
//! use trench_config::yaml;
//! let root = yaml::parse("line.yaml", "queues:\n- {share: 1, vertices: [[0, 0.5], [1, 0.5]]}\n")?;
//! let map = root.map()?;
//! for queue in map.list("queues")? {
//!     let queue = queue.map()?;
//!     let share = queue.f64("share")?;
//!     let vertices: Vec<[f64; 2]> = queue.get("vertices")?;
//!     let tolerance = queue.opt_f64("tolerance")?.unwrap_or(0.01);
//!     queue.finish()?; // an error if the queue has other keys than those asked for
//!     assert_eq!((share, vertices.len(), tolerance), (1.0, 2, 0.01));
//! }
//! map.finish()
//! # }
//! ```
//!
//! Scalars resolve as in ROS 2's parameter files ([`Scalar`]); here, unlike there, an integer also serves as a real
//! number, and real numbers must be finite. Anchors, aliases, tags other than `!!str`, duplicate keys and several
//! documents in one file are errors.

mod bounded;
mod from_node;
mod load;
mod map;
mod node;
mod scalar;

pub use from_node::FromNode;
pub use load::parse;
pub use map::Map;
pub use node::{Entry, Node, Value};
pub use scalar::Scalar;

#[cfg(test)]
mod tests;
