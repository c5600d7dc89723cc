//! Mount files: where the camera hangs.
//!
//! ```yaml
//! mount:
//!   position: [1.24, 0.915, 3.0]   # optical centre in the map, m
//!   orientation: [0.0, 0.0, 0.0]   # roll, pitch, yaw, rad; optional
//! ```

use crate::Mount;
use trench_config::{ConfigError, yaml};

impl Mount {
    /// Reads the text of a mount file; `file` names it in errors.
    ///
    /// # Errors
    /// With line and key, when the text is not YAML, a key is missing, unknown or of the wrong type, or the camera would
    /// not look down on the floor.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        let root = yaml::parse(file, text)?;
        let top = root.map()?;
        let map = top.map("mount")?;
        let [x, y, height] = map.get("position")?;
        let [roll, pitch, yaw] = map.get_or("orientation", [0.0; 3])?;
        map.finish()?;
        top.finish()?;
        let mount = Self { x, y, height, roll, pitch, yaw };
        mount.validate().map_err(|error| top.error("mount", error.to_string(), "measure the camera's place again"))?;
        Ok(mount)
    }

    /// The text of a file that [`Mount::parse`] reads back to the last bit.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        let Self { x, y, height, roll, pitch, yaw } = self;
        format!(
            "mount:\n  position: [{x:?}, {y:?}, {height:?}]  # optical centre in the map, m\n  \
             orientation: [{roll:?}, {pitch:?}, {yaw:?}]  # roll, pitch, yaw, rad\n"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back_to_the_bit() {
        let mount = Mount { roll: 0.1_f64.sqrt() * 1e-3, yaw: -0.04, ..Mount::nominal() };
        assert_eq!(Mount::parse("mount.yaml", &mount.to_yaml()), Ok(mount));
    }

    #[test]
    fn errors_name_line_key_and_remedy() {
        let check = |text: &str, expected: &str| {
            let error = Mount::parse("mount.yaml", text).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        };
        check("mount:\n  orientation: [0, 0, 0]\n", "mount.yaml:2: mount.position: is missing; add it");
        check("mount:\n  position: [1, 1]\n", "mount.yaml:2: mount.position: has 2 elements; write 3");
        check("mount:\n  position: [1, 1, 0]\n", "mount.yaml:2: mount: the camera's height must be greater than zero");
        check("mount:\n  position: [1, 1, 3]\n  hight: 3\n", "mount.yaml:3: mount.hight: unknown key");
    }
}
