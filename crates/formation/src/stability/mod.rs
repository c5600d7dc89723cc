//! Stable zone, closed forms of chapter 4, input-to-state bounds of chapter 8.
mod closed_form;
mod curvature;
mod energy;
mod integrate;
mod mismatch;
mod special;
mod stable_zone;

pub use closed_form::{ClosedForm, TwoGainLaw};
pub use energy::velocity_energy;
pub use integrate::rk4;
pub use mismatch::final_misalignment;
pub use special::{entire_cosine_integral, sine_integral};
pub use stable_zone::{C1, C2, LAMBDA_STAR, StableZone, Violation};
