//! Assigns robots to queues, orders teams into chains, publishes goals and the run state.
//!
//! | what | where | source |
//! |---|---|---|
//! | formation file to queues | `trench_plan` | Definition 2.1.1 |
//! | robots to places, chains | [`organise`] | 2.1, 6.2.1 |
//! | robots that quit and join, links that break | `structure`, `members`, `team` | 8.4, A.22 |
//! | goal points | [`virtual_point`] | 4.6 |
//! | the formation's frame | [`Target`] | 2.1: formations move with the target |
//! | markers | `markers` | for RViz2 and Foxglove |
//! | run state | [`RunMachine`] | services arm, start, stop, reset |

mod assign;
mod carrier;
mod checkpoint;
mod core;
mod held;
mod markers;
mod members;
mod organise;
mod room;
mod run_machine;
mod services;
mod settings;
mod structure;
mod target;
mod team;
mod tick;
mod virtual_point;
mod watch;

pub use crate::core::{LeaderAssignment, description};
pub use carrier::Carrier;
pub use organise::{ChainOrder, OrganiseError, Seated, Seating, organise};
pub use run_machine::{Request, RunMachine, state_name};
pub use target::{Target, TargetLimits, TargetRefusal};
pub use virtual_point::{VirtualPoint, virtual_point};
