//! `trench calibrate colours`

use super::super::say;
use super::error::{CalibrateError, open, read, write};
use image::RgbImage;
use std::path::PathBuf;
use trench_calibrate::{Samples, learn_colours};
use trench_harness::vision::{Frame, Light};
use trench_optics::CameraInfo;

/// Learns the pads' colours: from a picture and a click into the middle of some yellow and some blue discs.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A PNG or JPEG picture of the field with robots on it.
    picture: PathBuf,
    /// Pixels in the middle of yellow discs: column and row of each.
    #[arg(long, required = true, value_name = "U,V", value_parser = pixel)]
    yellow: Vec<[f64; 2]>,
    /// Pixels in the middle of blue discs.
    #[arg(long, required = true, value_name = "U,V", value_parser = pixel)]
    blue: Vec<[f64; 2]>,
    /// The lens file: the picture must be of this camera, and the colours are for it.
    #[arg(long, default_value = "lens.yaml")]
    lens: PathBuf,
    /// The parameter file for the localizer.
    #[arg(long, default_value = "colours.yaml")]
    out: PathBuf,
}

/// Half the side of the square of pixels that a click stands for: well inside a disc of 20 pixels.
const REACH: i64 = 4;
/// Pixels so near to a click, in columns and rows, are no sample of the rest.
const NEAR: f64 = 40.0;
/// Every so many pixels and rows is a sample of the rest.
const STRIDE: usize = 7;

fn pixel(text: &str) -> Result<[f64; 2], String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    <[f64; 2]>::try_from(numbers).map_err(|_| format!("{text} is no pixel; write column,row"))
}

pub(super) fn run(arguments: &Arguments) -> Result<bool, CalibrateError> {
    let info = CameraInfo::parse(&arguments.lens.display().to_string(), &read(&arguments.lens)?)?;
    let picture = open(&arguments.picture)?.into_rgb8();
    let (width, height) = picture.dimensions();
    let expected = [info.lens.width, info.lens.height];
    if [width, height] != expected {
        return Err(CalibrateError::OtherCamera { path: arguments.picture.clone(), width, height, expected });
    }
    // The localizer takes the light's colour out before it compares.
    let (size, mut room) = (expected.map(|side| side as usize), Vec::new());
    let frame = Frame::new(size, "rgb8", size, 3 * size[0], picture.as_raw(), &mut room);
    let light = Light::of(frame.map_err(|error| CalibrateError::Frame { path: arguments.picture.clone(), error })?);
    let picture = in_white_light(&picture, light);
    let clicks: Vec<[f64; 2]> = arguments.yellow.iter().chain(&arguments.blue).copied().collect();
    let samples = Samples {
        yellow: around(&picture, &arguments.yellow)?,
        blue: around(&picture, &arguments.blue)?,
        rest: rest(&picture, &clicks),
    };
    let colours = learn_colours(&samples)?;
    say(format_args!(
        "yellow from {:.3}, blue from {:.3}, minimum {:.0}\n",
        colours.yellow, colours.blue, colours.minimum
    ));
    write(&arguments.out, colours.to_yaml(&info.name))?;
    Ok(true)
}

fn in_white_light(picture: &RgbImage, light: Light) -> RgbImage {
    let mut white = picture.clone();
    white.pixels_mut().for_each(|pixel| pixel.0 = light.take_out(pixel.0));
    white
}

fn around(picture: &RgbImage, clicks: &[[f64; 2]]) -> Result<Vec<[u8; 3]>, CalibrateError> {
    let mut pixels = Vec::new();
    for &[u, v] in clicks {
        let place = |offset: i64| {
            let (column, row) =
                (u as i64 + offset % (2 * REACH + 1) - REACH, v as i64 + offset / (2 * REACH + 1) - REACH);
            picture.get_pixel_checked(u32::try_from(column).ok()?, u32::try_from(row).ok()?)
        };
        let square: Option<Vec<[u8; 3]>> =
            (0..(2 * REACH + 1) * (2 * REACH + 1)).map(|offset| place(offset).map(|pixel| pixel.0)).collect();
        pixels.extend(square.ok_or(CalibrateError::Outside { u, v })?);
    }
    Ok(pixels)
}

/// What is far from all clicks; other robots' discs are few pixels of many.
fn rest(picture: &RgbImage, clicks: &[[f64; 2]]) -> Vec<[u8; 3]> {
    let far = |u: u32, v: u32| {
        clicks.iter().all(|[column, row]| (f64::from(u) - column).abs() > NEAR || (f64::from(v) - row).abs() > NEAR)
    };
    let sampled = picture.enumerate_rows().step_by(STRIDE).flat_map(|(_, row)| row.step_by(STRIDE));
    sampled.filter(|(u, v, _)| far(*u, *v)).map(|(_, _, pixel)| pixel.0).collect()
}
