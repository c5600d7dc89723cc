//! The overhead camera as geometry: pinhole, plumb-bob distortion, several cameras over one map, pads at a height, camera_info files.
//!
//! # Frames
//!
//! * `map`: metres, right-handed, z up from the floor (REP-103). Seen in the image, its origin is the lower left corner
//!   of the view, x runs along the image's columns to the right, y against its rows, upwards.
//! * camera: ROS's optical frame: x right along columns, y down along rows, z along the line of sight.
//! * pixels: `u` along columns, `v` along rows; the centre of the image's first pixel is (0, 0), so the picture covers
//!   u in [-0.5, width - 0.5] and v in [-0.5, height - 0.5].
//!
//! Architecture invariant: all functions are pure, and use `libm` for what is not plain arithmetic: equal bits on any
//! x86-64.

mod camera;
mod camera_info;
mod distortion;
mod lens;
mod mount;
mod mount_file;
mod overhead;
mod pad;
mod ray_table;

pub use camera::{Camera, CameraError};
pub use camera_info::CameraInfo;
pub use distortion::PlumbBob;
pub use lens::{Lens, LensError, Pixel};
pub use mount::{Mount, MountError};
pub use overhead::Overhead;
pub use pad::{Pad, Pose2};
pub use ray_table::RayTable;
