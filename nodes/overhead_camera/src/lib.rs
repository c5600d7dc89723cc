//! Frames of a real camera, of an image folder or of a bag on /overhead/image_raw, through shared memory, stamped at
//! exposure.
//!
//! | part | where |
//! |---|---|
//! | what a frame is, what a source of frames does | [`frame`], [`FrameSource`] |
//! | frames to messages, faults to diagnostics | [`OverheadCamera`] |
//! | devices, folders, bags | [`source`] |
//!
//! Architecture invariant: only [`source`] touches files and devices. The core takes any source, and given what its source
//! gives, it does the same every time (docs/decisions/0006-cameras.md).

mod core;
pub mod frame;
mod info;
mod report;
mod settings;
pub mod source;

pub use crate::core::OverheadCamera;
pub use frame::{Encoding, Frame};
pub use settings::description;
pub use source::{FrameSource, SourceError, Taken};
