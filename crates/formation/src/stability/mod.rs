//! Stable zone, closed forms of chapter 4, input-to-state bounds of chapter 8.
mod balance;
mod cascade;
mod closed_form;
mod curvature;
mod eigenvalues;
mod energy;
mod input_to_state;
mod integrate;
mod lyapunov_equation;
mod mismatch;
mod product;
mod special;
mod stable_zone;
mod uniform;
mod violation;

pub use balance::{Balance, Balanced, Input, Moment, Supply};
pub use cascade::cascade_bounds;
pub use closed_form::{ClosedForm, TwoGainLaw};
pub use energy::velocity_energy;
pub use input_to_state::{
    ChainError, Coupling, InputToState, QueueRobot, input_to_state, longest_within, recursive_bounds,
};
pub use integrate::rk4;
pub use lyapunov_equation::{LyapunovError, solve_lyapunov};
pub use mismatch::final_misalignment;
pub use special::{entire_cosine_integral, sine_integral};
pub use stable_zone::{C1, C2, LAMBDA_STAR, StableZone};
pub use uniform::uniform_bounds;
pub use violation::Violation;
