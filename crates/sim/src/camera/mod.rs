//! The overhead camera's picture of the world: what the localizer gets in place of a real frame.
//!
//! Every pixel's line of sight comes from the camera model (distortion, tilt and height included), so discs and bodies
//! appear exactly where [`trench_optics::Camera`] says, edges anti-aliased by their distance in pixels: the centre of
//! area of a disc is right in the mean to a few thousandths of a pixel.

mod appearance;
mod background;
mod board;
mod noise;
mod obstacle;
mod renderer;
mod robot;
mod shape;

pub use appearance::{Appearance, BALANCED_FOR, Background, Colour};
pub use board::{HeldBoard, render_board};
pub use noise::Noise;
pub use obstacle::Obstacle;
pub use renderer::{RenderError, Renderer, Scene};
