//! From pixels to discs.
//!
//! One look at every eighth pixel of every eighth row cannot miss a disc 20 pixels wide; only around the hits are pixels
//! read one by one. So a frame costs a few ten thousand pixel reads instead of 442,368.

mod balance;
mod blob;
mod centroid;
mod chroma;
pub mod coded;
mod detector;
mod faint;
mod frame;
mod looks;
mod packed;
mod pad_fit;
mod partner;
mod rim;
mod weigh;
mod yuyv;

pub use balance::Light;
pub use chroma::{Colour, ColourLimits};
pub use detector::{Detector, Disc, Expectation};
pub use frame::{ChannelOrder, Frame, FrameError};
pub use packed::decode;
