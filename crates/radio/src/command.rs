//! The broadcast command: the wheels of all robots in one packet.

use crate::{PacketError, WheelTimer, Wheels};

/// Robots a base station can address: their ids are 0 to 31.
pub const MAX_ROBOTS: usize = 32;

/// A set of robots by id, bit `i` for robot `i`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RobotSet(pub u32);

impl RobotSet {
    /// Every robot.
    pub const ALL: Self = Self(u32::MAX);

    /// Whether `robot` is in the set.
    #[must_use]
    pub fn contains(self, robot: u8) -> bool {
        usize::from(robot) < MAX_ROBOTS && self.0 >> robot & 1 == 1
    }
}

/// Wheel timers for some of the robots, with the time for which they may be obeyed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Commands {
    /// Remaining validity in ms, counted by the robot from the moment it receives the packet.
    pub validity_ms: u8,
    /// By robot id. A robot without an entry is not addressed: what it obeys now goes on until its validity ends.
    pub wheels: [Option<Wheels>; MAX_ROBOTS],
}

impl Commands {
    /// The robots that are addressed.
    #[must_use]
    pub fn robots(&self) -> RobotSet {
        RobotSet(self.wheels.iter().enumerate().map(|(id, wheels)| u32::from(wheels.is_some()) << id).sum())
    }

    /// Appends validity, set of robots, timers, and direction bits.
    pub(crate) fn encode(&self, out: &mut Vec<u8>) {
        out.push(self.validity_ms);
        out.extend(self.robots().0.to_le_bytes());
        for wheels in self.wheels.iter().flatten() {
            out.extend(wheels.left.magnitude().to_le_bytes());
            out.extend(wheels.right.magnitude().to_le_bytes());
        }
        let (mut bits, mut filled) = (0, 0);
        for wheels in self.wheels.iter().flatten() {
            bits |= (u8::from(wheels.left.is_reverse()) | u8::from(wheels.right.is_reverse()) << 1) << filled;
            filled += 2;
            if filled == 8 {
                out.push(bits);
                (bits, filled) = (0, 0);
            }
        }
        if filled > 0 {
            out.push(bits);
        }
    }

    /// Reads what [`Commands::encode`] writes.
    pub(crate) fn decode(bytes: &[u8]) -> Result<Self, PacketError> {
        let wrong_length = PacketError::Length(bytes.len());
        let (&validity_ms, rest) = bytes.split_first().ok_or(wrong_length)?;
        let (set, rest) = rest.split_first_chunk::<4>().ok_or(wrong_length)?;
        let robots = RobotSet(u32::from_le_bytes(*set));
        let count = robots.0.count_ones() as usize;
        let (timers, directions) = rest.split_at_checked(4 * count).ok_or(wrong_length)?;
        if directions.len() != (2 * count).div_ceil(8) {
            return Err(wrong_length);
        }
        let mut commands = Self { validity_ms, ..Self::default() };
        let addressed = commands.wheels.iter_mut().enumerate().filter(|(id, _)| robots.contains(*id as u8));
        for (index, ((_, slot), timers)) in addressed.zip(timers.chunks_exact(4)).enumerate() {
            let bits = directions[index / 4] >> (2 * (index % 4));
            *slot = Some(Wheels {
                left: WheelTimer::from_wire(u16::from_le_bytes([timers[0], timers[1]]), bits & 1 != 0)?,
                right: WheelTimer::from_wire(u16::from_le_bytes([timers[2], timers[3]]), bits & 2 != 0)?,
            });
        }
        Ok(commands)
    }
}
