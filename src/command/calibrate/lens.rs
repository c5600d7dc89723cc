//! `trench calibrate lens`

use super::super::say;
use super::BoardArguments;
use super::error::{CalibrateError, open, write};
use std::path::PathBuf;
use trench_calibrate::{LensError, LensModel, Picture, find_corners, fit_lens, lens_picture, lens_text};
use trench_optics::CameraInfo;

/// Finds the lens from pictures of the board: ten or more, tilted by 20 to 40 degrees in all directions, all over the
/// picture. Writes ROS's camera_info format, a report and a picture of the residuals.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// PNG or JPEG pictures; those that do not show the whole board are left out, and named.
    #[arg(required = true)]
    pictures: Vec<PathBuf>,
    #[command(flatten)]
    board: BoardArguments,
    /// The camera's name in the file.
    #[arg(long, default_value = "overhead")]
    camera: String,
    /// Fits k3 too: for wide lenses, with boards up to the corners.
    #[arg(long)]
    three_radial: bool,
    /// The greatest residual to be content with, pixels.
    #[arg(long, default_value_t = 0.5)]
    accept: f64,
    /// The lens file; the report and the picture get its name with .txt and .svg.
    #[arg(long, default_value = "lens.yaml")]
    out: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<bool, CalibrateError> {
    let board = arguments.board.board()?;
    let (mut size, mut names, mut found) = (None, Vec::new(), Vec::new());
    for path in &arguments.pictures {
        let grey = open(path)?.into_luma8();
        let (width, height) = grey.dimensions();
        let expected = *size.get_or_insert([width, height]);
        if expected != [width, height] {
            return Err(CalibrateError::Size { path: path.clone(), width, height, expected });
        }
        let Some(picture) = Picture::new(width as usize, height as usize, grey.into_raw()) else { continue };
        match find_corners(&picture, &board) {
            Ok(corners) => {
                names.push(path.display().to_string());
                found.push(corners);
            }
            Err(reason) => say(format_args!("left out {}: {reason}\n", path.display())),
        }
    }
    let size = size.ok_or(LensError::Few(0))?;
    let model = if arguments.three_radial { LensModel::ThreeRadial } else { LensModel::TwoRadial };
    let fitted = fit_lens(&board, size, &found, model)?;
    let report = lens_text(&fitted, &names, model);
    say(&report);
    write(&arguments.out, CameraInfo { name: arguments.camera.clone(), lens: fitted.lens }.to_yaml())?;
    write(&arguments.out.with_extension("txt"), report)?;
    write(&arguments.out.with_extension("svg"), lens_picture(&fitted, &found))?;
    Ok(fitted.rms <= arguments.accept)
}
