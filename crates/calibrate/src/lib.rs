//! Calibration: what a camera's lens does to straight lines, and where the camera hangs.
//!
//! | what | where |
//! |---|---|
//! | the board that is printed | [`Board`] |
//! | its corners in a picture | [`find_corners`] |
//! | lens from several pictures of it (Zhang 2000, Brown 1966) | [`fit_lens`] |
//! | camera's place, tilt and the pads' height from known points | [`fit_field`] |
//! | limits of the pads' colours from samples | [`learn_colours`] |
//!
//! Pure: pictures come as grey pixels, reports leave as text and SVG.

mod board;
mod colours;
mod corners;
mod field;
mod grid;
mod homography;
mod least_squares;
mod lens;
mod picture;
mod report;
mod rotation;

pub use board::Board;
pub use colours::{ColourError, Colours, Samples, learn_colours};
pub use corners::{CornerError, find_corners};
pub use field::{Field, FieldError, KnownPoint, Misfit, fit_field, read_points};
pub use lens::{FittedLens, LensError, LensModel, fit_lens};
pub use picture::Picture;
pub use report::{field_picture, field_text, lens_picture, lens_text};
