//! What a robot reports about itself.

use crate::{MAX_ROBOTS, PacketError, RobotSet};

/// A round of telemetry, ns: every robot reports once, in its slot.
pub const TELEMETRY_ROUND: u64 = 100_000_000;

/// Range sensors a robot can report.
pub const MAX_RANGES: usize = 8;

/// The range in cm that says: nothing within the sensor's reach.
pub const NOTHING_IN_RANGE: u8 = 255;

/// Bytes of a telemetry payload without its ranges.
const FIXED: usize = 27;

/// Fault bits, the same as in trench_msgs/LinkStatus.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Fault(pub u8);

impl Fault {
    /// No valid command within the validity of the last: the robot has stopped by itself.
    pub const COMMAND_TIMEOUT: Self = Self(1);
    /// Stopped until a reset packet.
    pub const EMERGENCY_STOP: Self = Self(2);
    /// The battery needs charging.
    pub const LOW_BATTERY: Self = Self(4);
    /// The motors were driven beyond their ramp, or blocked.
    pub const MISSED_STEPS: Self = Self(8);
    /// Since the last report it heard packets without the key's tag: forged ones, or spoilt ones.
    pub const NOT_AUTHENTIC: Self = Self(16);
    /// Since the last report it heard authentic packets again that are long over.
    pub const REPLAYED: Self = Self(32);

    /// Whether all bits of `other` are set.
    #[must_use]
    pub fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Sets the bits of `other`.
    pub fn set(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

/// The readings of up to [`MAX_RANGES`] sensors in cm, in the order in which they sit on the robot, counter-clockwise
/// from the front. [`NOTHING_IN_RANGE`] where there is nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Ranges {
    values: [u8; MAX_RANGES],
    count: u8,
}

impl Ranges {
    /// Takes the first [`MAX_RANGES`] readings.
    #[must_use]
    pub fn new(readings: &[u8]) -> Self {
        let count = readings.len().min(MAX_RANGES);
        let mut values = [0; MAX_RANGES];
        values[..count].copy_from_slice(&readings[..count]);
        Self { values, count: count as u8 }
    }

    /// The readings in cm.
    #[must_use]
    pub fn as_slice(&self) -> &[u8] {
        &self.values[..usize::from(self.count)]
    }
}

/// A robot's report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Telemetry {
    /// The robot's id.
    pub robot: u8,
    /// What is wrong with it.
    pub fault: Fault,
    /// The lowest 16 bits of the counter of the last packet it accepted.
    pub last_counter: u16,
    /// How long before this report it accepted that packet, in ms; 255: that or longer.
    pub last_age_ms: u8,
    /// How often that packet was relayed.
    pub last_relayed: u8,
    /// Packets of the base that it accepted; wraps. The base knows how many it sent.
    pub received: u16,
    /// The robots whose reports it heard lately, without a relay.
    pub neighbours: RobotSet,
    /// Battery voltage in mV.
    pub battery_mv: u16,
    /// Strength in dBm at which it heard the last packet.
    pub signal_dbm: i8,
    /// Steps the left motor was told to make, forwards positive; wraps.
    pub steps_left: i32,
    /// Steps the right motor was told to make.
    pub steps_right: i32,
    /// Time since it was switched on, in ms; wraps.
    pub uptime_ms: u32,
    /// Its range sensors.
    pub ranges: Ranges,
}

impl Telemetry {
    /// Appends the fields in the order of the structure, least significant byte first.
    pub(crate) fn encode(&self, out: &mut Vec<u8>) {
        out.extend([self.robot, self.fault.0]);
        out.extend(self.last_counter.to_le_bytes());
        out.extend([self.last_age_ms, self.last_relayed]);
        out.extend(self.received.to_le_bytes());
        out.extend(self.neighbours.0.to_le_bytes());
        out.extend(self.battery_mv.to_le_bytes());
        out.extend(self.signal_dbm.to_le_bytes());
        out.extend(self.steps_left.to_le_bytes());
        out.extend(self.steps_right.to_le_bytes());
        out.extend(self.uptime_ms.to_le_bytes());
        out.extend(self.ranges.as_slice());
    }

    /// Reads what [`Telemetry::encode`] writes; what lies behind the fixed fields are ranges.
    pub(crate) fn decode(bytes: &[u8]) -> Result<Self, PacketError> {
        let (fixed, ranges) = bytes.split_first_chunk::<FIXED>().ok_or(PacketError::Length(bytes.len()))?;
        if ranges.len() > MAX_RANGES {
            return Err(PacketError::Length(bytes.len()));
        }
        let pair = |at: usize| u16::from_le_bytes([fixed[at], fixed[at + 1]]);
        let four = |at: usize| u32::from(pair(at)) | u32::from(pair(at + 2)) << 16;
        if usize::from(fixed[0]) >= MAX_ROBOTS {
            return Err(PacketError::Robot(fixed[0]));
        }
        Ok(Self {
            robot: fixed[0],
            fault: Fault(fixed[1]),
            last_counter: pair(2),
            last_age_ms: fixed[4],
            last_relayed: fixed[5],
            received: pair(6),
            neighbours: RobotSet(four(8)),
            battery_mv: pair(12),
            signal_dbm: fixed[14] as i8,
            steps_left: four(15) as i32,
            steps_right: four(19) as i32,
            uptime_ms: four(23),
            ranges: Ranges::new(ranges),
        })
    }
}
