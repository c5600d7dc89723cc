//! What the RoboCup Small Size League's SSL-Vision says of robots, and the logs in which the league keeps it.
//!
//! Its tools see our robots, its cameras can feed our controllers, its games are test data. Bytes in, bytes out: sockets and
//! files are the callers'.

mod log;
mod packet;

pub use log::{LogError, LogReader, Record, VISION};
pub use packet::{Ball, Frame, Packet, PacketError, Robot, Seen, Team, frame_of, packet_of};

/// The multicast group and port on which SSL-Vision speaks.
pub const GROUP: ([u8; 4], u16) = ([224, 5, 23, 2], 10_006);
