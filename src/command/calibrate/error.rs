//! What can go wrong, and reading and writing files with the name in the error.

use std::path::{Path, PathBuf};
use trench_calibrate::{ColourError, FieldError, LensError};

#[derive(Debug, thiserror::Error)]
pub(super) enum CalibrateError {
    #[error("{}: {source}", path.display())]
    Io { path: PathBuf, source: std::io::Error },
    #[error("{}: {source}", path.display())]
    Image { path: PathBuf, source: image::ImageError },
    #[error("--square {0}: a side between 0.1 mm and 10 m is meant")]
    Square(f64),
    #[error("{}: it has {width} x {height} pixels, the first picture {}x{}", path.display(), expected[0], expected[1])]
    Size { path: PathBuf, width: u32, height: u32, expected: [u32; 2] },
    #[error("{}: it is no picture of the lens's camera: {width} x {height} pixels instead of {}x{}", path.display(), expected[0], expected[1])]
    OtherCamera { path: PathBuf, width: u32, height: u32, expected: [u32; 2] },
    #[error("{}: {error}", path.display())]
    Frame { path: PathBuf, error: trench_harness::vision::FrameError },
    #[error("({u}, {v}) is outside the picture")]
    Outside { u: f64, v: f64 },
    #[error(transparent)]
    Config(#[from] trench_config::ConfigError),
    #[error(transparent)]
    Lens(#[from] LensError),
    #[error(transparent)]
    Field(#[from] FieldError),
    #[error(transparent)]
    Colours(#[from] ColourError),
}

pub(super) fn read(path: &Path) -> Result<String, CalibrateError> {
    std::fs::read_to_string(path).map_err(|source| CalibrateError::Io { path: path.to_owned(), source })
}

pub(super) fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), CalibrateError> {
    std::fs::write(path, content).map_err(|source| CalibrateError::Io { path: path.to_owned(), source })?;
    super::super::say(format_args!("wrote {}\n", path.display()));
    Ok(())
}

pub(super) fn open(path: &Path) -> Result<image::DynamicImage, CalibrateError> {
    image::open(path).map_err(|source| CalibrateError::Image { path: path.to_owned(), source })
}
