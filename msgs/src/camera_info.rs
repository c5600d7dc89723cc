//! The matrices of a camera without rectification.

use crate::sensor_msgs::CameraInfo;
use crate::std_msgs::Header;

impl CameraInfo {
    /// A camera with `plumb_bob` distortion (k1, k2, p1, p2, k3) whose images are not rectified; `focal` and `centre` in
    /// pixels.
    #[must_use]
    pub fn plumb_bob(
        header: Header,
        [width, height]: [u32; 2],
        [fx, fy]: [f64; 2],
        [cx, cy]: [f64; 2],
        distortion: [f64; 5],
    ) -> Self {
        Self {
            header,
            height,
            width,
            distortion_model: "plumb_bob".to_owned(),
            d: distortion.to_vec(),
            k: [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
            r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            p: [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
            ..Self::default()
        }
    }
}
