//! Differential-drive kinematics (3.5)-(3.8), (3.14)-(3.16), wheel limits and the dynamics of 3.1.
//!
//! Angles are radians in (-pi, pi], counter-clockwise from the x axis of the `map` frame; lengths are metres.
mod actuation;
mod angle;
mod double_integrator;
mod drive;
mod facing;
mod hilare;
mod limits;
mod polar;
mod pose;
mod wheels;

pub use actuation::WheelForces;
pub use angle::wrap;
pub use double_integrator::PointState;
pub use drive::{WheelDrive, WheelTorques};
pub use facing::Facing;
pub use hilare::{HandState, Hilare, HilareInput, HilareRates, HilareState, twist_of_hand};
pub use limits::{Limited, Ramp, saturate};
pub use polar::{Polar, PolarRates};
pub use pose::{Pose, Twist};
pub use wheels::{Axle, Wheels};
