//! Lens files in ROS's camera_info format, as camera_calibration writes them and camera_info_manager reads them.

use crate::{Lens, PlumbBob};
use std::fmt::Write as _;
use trench_config::ConfigError;
use trench_config::yaml::{self, Map};

/// A lens and the name that its file gives the camera.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraInfo {
    /// `camera_name`
    pub name: String,
    /// Everything else that matters here.
    pub lens: Lens,
}

impl CameraInfo {
    /// Reads the text of a file; `file` names it in errors. Rectification and projection matrices are for stereo
    /// pairs and rectified images: they are accepted and not used.
    ///
    /// # Errors
    /// With line and key, when the text is not YAML, a key is missing, unknown or of the wrong type, the distortion
    /// model is not `plumb_bob`, or the numbers are not those of a lens.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        let root = yaml::parse(file, text)?;
        let map = root.map()?;
        let name = map.opt_str("camera_name")?.unwrap_or("camera").to_owned();
        let (width, height) = (map.get("image_width")?, map.get("image_height")?);
        let [fx, skew, cx, _, fy, cy, ..] = matrix::<9>(&map, "camera_matrix")?;
        if skew != 0.0 {
            return Err(map.error(
                "camera_matrix",
                "has a skew",
                "write 0 as the second number: pixels are rectangles",
            ));
        }
        map.one_of("distortion_model", &[("plumb_bob", ())])?;
        let [k1, k2, p1, p2, k3] = matrix::<5>(&map, "distortion_coefficients")?;
        for unused in ["rectification_matrix", "projection_matrix"] {
            // Asking for them is what makes them known keys.
            let _ = map.opt_node(unused);
        }
        map.finish()?;
        let lens = Lens { width, height, fx, fy, cx, cy, distortion: PlumbBob { k1, k2, p1, p2, k3 } };
        lens.validate()
            .map_err(|error| map.error("camera_matrix", error.to_string(), "calibrate the camera's lens again"))?;
        Ok(Self { name, lens })
    }

    /// The text of a file that [`CameraInfo::parse`] reads back to the last bit.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        let Lens { width, height, fx, fy, cx, cy, distortion: PlumbBob { k1, k2, p1, p2, k3 } } = self.lens;
        let mut text = format!("image_width: {width}\nimage_height: {height}\ncamera_name: {:?}\n", self.name);
        let mut matrix = |name: &str, rows: usize, data: &[f64]| {
            let columns = data.len() / rows;
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{name}:\n  rows: {rows}\n  cols: {columns}\n  data: {data:?}");
        };
        matrix("camera_matrix", 3, &[fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]);
        matrix("distortion_coefficients", 1, &[k1, k2, p1, p2, k3]);
        matrix("rectification_matrix", 3, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
        matrix("projection_matrix", 3, &[fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0]);
        text + "distortion_model: plumb_bob\n"
    }
}

/// The numbers of a matrix in OpenCV's form: rows, cols, data.
fn matrix<const N: usize>(map: &Map<'_>, key: &str) -> Result<[f64; N], ConfigError> {
    let matrix = map.map(key)?;
    let (rows, columns): (usize, usize) = (matrix.get("rows")?, matrix.get("cols")?);
    let data = matrix.get("data")?;
    matrix.finish()?;
    if rows.saturating_mul(columns) != N {
        return Err(map.error(key, format!("is {rows} x {columns}"), format!("write {N} numbers")));
    }
    Ok(data)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text() -> String {
        let distortion = PlumbBob { k1: -0.123_456_789_012_345_6, k2: 1e-17, p1: 5e-4, p2: -4e-4, k3: 0.0 };
        CameraInfo { name: "over: head".to_owned(), lens: Lens { distortion, ..Lens::nominal() } }.to_yaml()
    }

    #[test]
    fn what_is_written_is_read_back_to_the_bit() {
        let info = CameraInfo::parse("lens.yaml", &text()).unwrap();
        assert_eq!(info.name, "over: head");
        assert_eq!(info.to_yaml(), text());
    }

    #[test]
    fn the_test_beds_files_are_a_camera_that_sees_the_field() {
        let info = CameraInfo::parse("overhead.yaml", include_str!("../../../config/cameras/overhead.yaml")).unwrap();
        let mount = include_str!("../../../config/cameras/overhead_mount.yaml");
        let camera = crate::Camera::new(info.lens, crate::Mount::parse("mount.yaml", mount).unwrap()).unwrap();
        for (x, y) in [(0.1, 0.1), (2.38, 0.1), (0.1, 1.73), (2.38, 1.73)] {
            let pixel = camera.project(nalgebra::Point3::new(x, y, 0.1)).unwrap();
            assert!(camera.lens().contains(pixel, 0.0), "({x}, {y}) is seen at {pixel:?}");
        }
    }

    #[test]
    fn errors_name_line_key_and_remedy() {
        let check = |from: &str, to: &str, expected: &str| {
            let wrong = text().replace(from, to);
            assert_ne!(wrong, text(), "{from} is not in the file");
            let error = CameraInfo::parse("lens.yaml", &wrong).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        };
        check("image_width: 768", "image_width: wide", "lens.yaml:1: image_width = wide: is a text; write an integer");
        check("image_width: 768", "image_width: -1", "lens.yaml:1: image_width = -1: is out of range");
        check("image_width: 768", "image_with: 768", "lens.yaml:1: image_width: is missing");
        check("plumb_bob", "equidistant", "lens.yaml:20: distortion_model = equidistant: is none of the allowed words");
        check("cols: 5", "cols: 4", "lens.yaml:9: distortion_coefficients: is 1 x 4; write 5 numbers");
        check("[929.08", "[.nan, 929.08", "lens.yaml:7: camera_matrix.data[0] = .nan: is not finite");
        check("[929.08", "[-929.08", "lens.yaml:5: camera_matrix: fx must be greater than zero");
    }
}
