//! Drives one robot to its place in the formation.
//!
//! A tick is the arrival of a team state: predict the robot's pose from the exposure to the moment the command will act,
//! extrapolate the goal to the same moment, apply the law, keep what the motors can follow, pass the safety filter, send.
//!
//! | stage | where | source |
//! |---|---|---|
//! | prediction | [`Predictor`] | commands sent since the exposure |
//! | law | [`Law`] | (3.9), (3.10), (3.13), (4.4), (3.13) with feed-forward |
//! | dynamic laws | `dynamic`, `steer` | (5.1)-(5.3), (6.1), (7.4), (7.13), driven through 3.1.1 |
//! | monitor | `monitor`, `trench_formation::stability::Balance` | A.10, A.12, A.18, chapter 8 |
//! | team link | `team_link`, `recovery` | Remarks 6.2.1, 8.4.1 |
//! | motors | `trench_formation::kinematics::{saturate, Ramp}` | 4.5.2, 4.6.3 |
//! | facing as the formation does, at rest | `face`, `trench_formation::kinematics::Facing` | docs/decisions/0013-headings.md |
//! | a turn on the spot while nobody knows which robot it is | `identify` | docs/decisions/0010-identities.md |
//! | safety | `trench_formation::safety` | invariant 8 of docs/ARCHITECTURE.md |

mod chain;
mod core;
mod deviation;
mod dynamic;
mod face;
mod following;
mod hold;
mod identify;
mod inputs;
mod law;
mod markers;
mod monitor;
mod ports;
mod predictor;
mod recovery;
mod refusal;
mod report;
mod robot;
mod safe;
mod segments;
mod settings;
mod steer;
mod team_link;
mod tick;
mod track;

pub use crate::core::{FormationController, description};
pub use deviation::Deviation;
pub use following::Following;
pub use law::Law;
pub use predictor::Predictor;
