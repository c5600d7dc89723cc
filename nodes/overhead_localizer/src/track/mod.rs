//! From discs to robots: pairs of discs, one identity a pair, one filter an identity.

mod assignment;
mod filter;
mod identity;
mod one_disc;
mod pairing;
mod recall;
mod settings;
mod strangers;
mod tracker;
mod turns;

pub use filter::{Filter, Motion, State, wrap};
pub use pairing::{MapDisc, Pair};
pub use recall::Remembered;
pub use settings::{Names, Robot, Settings};
pub use tracker::{NamedPose, Status, Track, Tracker};
pub use turns::Turn;
