//! `trench calibrate field`

use super::super::say;
use super::error::{CalibrateError, read, write};
use std::path::PathBuf;
use trench_calibrate::{field_picture, field_text, fit_field, read_points};
use trench_optics::{CameraInfo, Mount};

/// Finds where the camera hangs, and the pads' height, from points whose places on the field are known: five or more, best
/// near the corners. Names the point that does not agree with the others.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The points: `points: [{name: a, pixel: [31.5, 540.2], map: [0.1, 0.1]}, ...]`, pixels and metres.
    points: PathBuf,
    /// The lens file, of `trench calibrate lens`.
    #[arg(long, default_value = "lens.yaml")]
    lens: PathBuf,
    /// About where the camera hangs: x, y and height, m. By default 3 m above the middle of the points.
    #[arg(long, value_delimiter = ',', num_args = 3)]
    near: Vec<f64>,
    /// The greatest residual to be content with, m.
    #[arg(long, default_value_t = 0.003)]
    accept: f64,
    /// The mount file; the report and the picture get its name with .txt and .svg.
    #[arg(long, default_value = "mount.yaml")]
    out: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<bool, CalibrateError> {
    let points = read_points(&arguments.points.display().to_string(), &read(&arguments.points)?)?;
    let lens = CameraInfo::parse(&arguments.lens.display().to_string(), &read(&arguments.lens)?)?.lens;
    let guess = match arguments.near.as_slice() {
        &[x, y, height] => Mount { x, y, height, ..Mount::nominal() },
        _ => {
            let count = points.len().max(1) as f64;
            let middle =
                |place: fn(&trench_calibrate::KnownPoint) -> f64| points.iter().map(place).sum::<f64>() / count;
            Mount { x: middle(|point| point.x), y: middle(|point| point.y), ..Mount::nominal() }
        }
    };
    let field = fit_field(&lens, &points, &guess)?;
    let report = field_text(&field);
    say(&report);
    write(&arguments.out, field.mount.to_yaml())?;
    write(&arguments.out.with_extension("txt"), report)?;
    write(&arguments.out.with_extension("svg"), field_picture(&field, &points, [lens.width, lens.height]))?;
    Ok(field.bad.is_none() && field.rms <= arguments.accept)
}
