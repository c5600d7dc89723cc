//! From discs to robots: pairs of discs, one identity a pair, one filter an identity.

mod assignment;
mod filter;
mod identity;
mod pairing;
mod recall;
mod settings;
mod strangers;
mod tracker;

pub use filter::{Filter, Motion, State, wrap};
pub use pairing::{MapDisc, Pair};
pub use recall::Remembered;
pub use settings::{Robot, Settings};
pub use tracker::{Status, Track, Tracker};
