//! Where the camera hangs and where it looks.

use nalgebra::{Matrix3, Point3};

/// The camera's pose in the map. Angles zero: it looks straight down, image columns along map x, rows against map y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mount {
    /// The optical centre, m.
    pub x: f64,
    /// The optical centre, m.
    pub y: f64,
    /// The optical centre above the floor, m.
    pub height: f64,
    /// Turn about the map's x axis, rad: applied first.
    pub roll: f64,
    /// Turn about the map's y axis, rad: applied second.
    pub pitch: f64,
    /// Turn about the map's z axis, rad: applied last.
    pub yaw: f64,
}

/// Why numbers are not a mount.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MountError {
    /// A number is NaN or infinite.
    #[error("{0} is not finite")]
    NotFinite(&'static str),
    /// The camera is not above what it looks at.
    #[error("the camera's height must be greater than zero")]
    Height,
    /// It does not look down.
    #[error("{0} tilts the camera by more than 45 degrees: it does not look down")]
    Tilt(&'static str),
}

impl Mount {
    /// The test bed's: 3 m above the middle of the 2.48 m x 1.83 m view, map origin in its lower left corner.
    #[must_use]
    pub fn nominal() -> Self {
        Self { x: 384.0 * 3.229e-3, y: 288.0 * 3.177e-3, height: 3.0, roll: 0.0, pitch: 0.0, yaw: 0.0 }
    }

    /// The optical centre in the map.
    #[must_use]
    pub fn position(&self) -> Point3<f64> {
        Point3::new(self.x, self.y, self.height)
    }

    /// Turns directions of the camera frame (x right, y down, z along the line of sight) into the map.
    #[must_use]
    pub fn map_from_camera(&self) -> Matrix3<f64> {
        let (sr, cr) = (libm::sin(self.roll), libm::cos(self.roll));
        let (sp, cp) = (libm::sin(self.pitch), libm::cos(self.pitch));
        let (sy, cy) = (libm::sin(self.yaw), libm::cos(self.yaw));
        let about_x = Matrix3::new(1.0, 0.0, 0.0, 0.0, cr, -sr, 0.0, sr, cr);
        let about_y = Matrix3::new(cp, 0.0, sp, 0.0, 1.0, 0.0, -sp, 0.0, cp);
        let about_z = Matrix3::new(cy, -sy, 0.0, sy, cy, 0.0, 0.0, 0.0, 1.0);
        let looking_down = Matrix3::new(1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0);
        about_z * about_y * about_x * looking_down
    }

    /// Checks that this is a camera above the field that looks down.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn validate(&self) -> Result<(), MountError> {
        let numbers = [
            ("x", self.x),
            ("y", self.y),
            ("height", self.height),
            ("roll", self.roll),
            ("pitch", self.pitch),
            ("yaw", self.yaw),
        ];
        for (name, value) in numbers {
            if !value.is_finite() {
                return Err(MountError::NotFinite(name));
            }
        }
        if self.height <= 0.0 {
            return Err(MountError::Height);
        }
        for (name, value) in [("roll", self.roll), ("pitch", self.pitch)] {
            if value.abs() > std::f64::consts::FRAC_PI_4 {
                return Err(MountError::Tilt(name));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn validate_names_what_is_wrong() {
        let check = |change: fn(&mut Mount), expected: Result<(), MountError>| {
            let mut mount = Mount::nominal();
            change(&mut mount);
            assert_eq!(mount.validate(), expected);
        };
        check(|_| (), Ok(()));
        check(|mount| mount.yaw = f64::NAN, Err(MountError::NotFinite("yaw")));
        check(|mount| mount.height = -3.0, Err(MountError::Height));
        check(|mount| mount.pitch = 3.0, Err(MountError::Tilt("pitch")));
    }
}
