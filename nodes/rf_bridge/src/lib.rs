//! Carries wheel commands to the robots and telemetry back over the radio base station's serial port.
//!
//! | stage | where |
//! |---|---|
//! | command accepted: writer, numbers, stamp | `robot` |
//! | twist to wheel speeds, speeds below the motors' minimum | `drive`, `dither` |
//! | one broadcast a camera frame, ages | `broadcast`, `downlink` |
//! | the turns that tell robots apart, while nothing else may move | `identify` |
//! | relays for robots out of reach | `relays` |
//! | emergency stop and reset | `stop`, `stopping` |
//! | robots that were switched on, two radios of one id | `welcome`, `twins` |
//! | telemetry to topics | `uplink`, `report`, `monitor`, `odometry` |
//!
//! Architecture invariant: no command leaves this node older than its age limits (invariant 8): what is old, broken or
//! not wanted in the present run state becomes silence or zero.

mod broadcast;
mod capacity;
mod channel;
mod core;
mod diagnosis;
mod dither;
mod downlink;
mod drive;
mod identify;
mod interface;
mod monitor;
mod odometry;
mod relays;
mod report;
mod robot;
mod run;
mod settings;
mod stop;
mod stopping;
mod twins;
mod uplink;
mod welcome;

pub use crate::core::RfBridge;
pub use interface::description;
