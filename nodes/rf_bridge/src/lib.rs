//! Carries wheel commands to the robots and telemetry back over the radio base station's serial port.
