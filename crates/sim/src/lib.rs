//! The simulated test bed: plants, motors, bodies, camera renderer, radio medium, firmware.
//!
//! [`World`] holds what moves: robots with stepper motors, bodies that block each other, obstacles, lasers. [`Bed`] puts the
//! radio before it (serial line, base station, air, firmware) and the camera's shutter above it. [`camera`] renders.
//! [`Faults`] go wrong at their times.
//!
//! Architecture invariant: pure and deterministic. Times are ns of a clock that the caller owns; chance comes from one
//! seed; what happens does not depend on how often the bed is advanced.

mod air;
mod base_station;
mod battery;
mod bed;
pub mod camera;
mod contact;
mod fault;
mod firmware;
mod greeting;
mod history;
mod interference;
mod intruder;
mod laser;
mod medium;
mod obstacle;
mod overlap;
mod path;
mod random;
mod range_sensor;
mod ray;
mod relay;
mod serial_line;
mod setup;
mod stepper;
mod switch;
mod unicycle;
mod world;

pub use base_station::BaseStation;
pub use bed::{Bed, Frame, Output, Scan};
pub use contact::{Field, Thing};
pub use fault::{Fault, FaultKind, Faults, FrameFault, Intrusion};
pub use firmware::{Firmware, Sensors};
pub use history::Truth;
pub use interference::Bursts;
pub use laser::Laser;
pub use medium::{Arrival, Medium, MediumSetup, Way};
pub use obstacle::Obstacle;
pub use overlap::{Overlap, overlaps};
pub use path::{Ending, Path};
pub use random::Random;
pub use range_sensor::{DIRECTIONS as RANGE_DIRECTIONS, REACH as RANGE_REACH};
pub use relay::Relayed;
pub use serial_line::SerialLine;
pub use setup::{BedSetup, Shutter, scattered};
pub use stepper::{Motor, Wheel};
pub use unicycle::{rolled, wrapped};
pub use world::{Body, Contact, STEP, World};
