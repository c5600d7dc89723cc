//! The serial protocol of the radio base station and the wheel timers of the MRKIT robot.
