//! The simulated test bed: plants, motors, bodies, camera renderer, radio medium, firmware.

pub mod camera;
