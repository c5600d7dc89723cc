//! The serial protocol of the radio base station and the wheel timers of the MRKIT robot.
//!
//! Three layers, each in a file of its own, outermost first: [`framing`] puts a body between delimiters on the serial
//! line (COBS and CRC-16), [`LinkFrame`] says what host and base station tell each other, [`Packet`] is what goes over
//! the air, authenticated by a [`Key`]. `docs/protocols/radio.md` writes them down byte by byte; its test vectors are
//! tests of this crate.
//!
//! Architecture invariant: pure. No clock, port or randomness; times come in from the caller.

mod age;
mod command;
mod decoder;
mod error;
pub mod framing;
mod freshness;
mod key;
mod link;
mod packet;
mod relays;
mod telemetry;
mod timer;
mod welcome;

pub use age::{AgeMeter, COUNTER_TICK, USUAL_AGE};
pub use command::{Commands, MAX_ROBOTS, RobotSet};
pub use decoder::StreamDecoder;
pub use error::{ErrorCounts, LinkError, PacketError};
pub use freshness::{Freshness, Stale};
pub use key::{Key, KeyError};
pub use link::{Ack, AckStatus, LinkFrame};
pub use packet::{COUNTER_LIMIT, Packet, Payload, VERSION, relayed_once_more};
pub use relays::{MAX_RELAYS, RELAY_SLOT, RelayList, Relaying};
pub use telemetry::{Fault, MAX_RANGES, NOTHING_IN_RANGE, Ranges, TELEMETRY_ROUND, Telemetry};
pub use timer::{METRES_PER_STEP, SPEED_TIMES_TIMER, TIMER_FASTEST, TIMER_SLOWEST, WheelTimer, Wheels, wheel_speed};
pub use welcome::{MAX_WELCOMED, Welcome};
