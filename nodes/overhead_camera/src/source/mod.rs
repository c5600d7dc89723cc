//! Where frames come from: the only part of the node that touches files and devices.

mod bag;
mod controls;
mod decode;
mod device;
mod driver;
mod folder;
mod natural_order;
mod pace;

use crate::frame::Frame;
use trench_core::{Steady, Times};

pub use bag::BagSource;
pub use controls::Controls;
pub use device::{DeviceSource, PixelFormat};
pub use folder::FolderSource;

/// What a look at a source brought.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Taken {
    /// A frame was given.
    Frame,
    /// There is none yet.
    NotYet,
    /// There will be none any more.
    End,
}

/// Why a source gives no frame.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SourceError {
    /// This frame is unusable; the next may be good.
    #[error("{0}")]
    Frame(String),
    /// The source cannot be used; it tries again by itself later.
    #[error("{0}")]
    Away(String),
}

/// Gives frames, one after the other, when they are due. Nothing here ever blocks.
pub trait FrameSource: Send {
    /// The most bytes of pixels that a frame of it has.
    fn most_bytes(&self) -> usize;

    /// Sets the time of the first frame, for sources that choose it.
    fn start(&mut self, at: Steady);

    /// Hands the next frame to `give` if it is there; its pixels stay where they are.
    ///
    /// # Errors
    /// When the frame or the whole source is unusable. In either case the source goes on with the next call.
    fn take(&mut self, now: Times, give: &mut dyn FnMut(Frame<'_>)) -> Result<Taken, SourceError>;

    /// Sets exposure, gain and white balance, where there is a camera to be told.
    ///
    /// # Errors
    /// With the reason, when the camera refuses.
    fn control(&mut self, _: Controls) -> Result<(), String> {
        Ok(())
    }

    /// When to look again; nothing after the end.
    fn next_look(&self) -> Option<Steady>;
}
