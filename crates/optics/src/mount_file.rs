//! Mount files: where one camera hangs, or where several do.
//!
//! ```yaml
//! mount:
//!   position: [1.24, 0.915, 3.0]   # optical centre in the map, m
//!   orientation: [0.0, 0.0, 0.0]   # roll, pitch, yaw, rad; optional
//! ```
//!
//! ```yaml
//! mounts:                          # several cameras with one map
//! - {camera: west, position: [1.16, 1.4, 3.0]}
//! - {camera: east, position: [2.84, 1.4, 3.0]}
//! ```

use crate::Mount;
use trench_config::ConfigError;
use trench_config::yaml::{self, Map};

impl Mount {
    /// Reads the text of a mount file of one camera; `file` names it in errors.
    ///
    /// # Errors
    /// With line and key, when the text is not YAML, a key is missing, unknown or of the wrong type, or the camera would
    /// not look down on the floor.
    pub fn parse(file: &str, text: &str) -> Result<Self, ConfigError> {
        let root = yaml::parse(file, text)?;
        let top = root.map()?;
        let map = top.map("mount")?;
        let mount = Self::read(&map)?;
        map.finish()?;
        top.finish()?;
        mount.validate().map_err(|error| top.error("mount", error.to_string(), "measure the camera's place again"))?;
        Ok(mount)
    }

    /// Reads the text of a mount file of one camera, which has no name, or of several, in the order of the file.
    ///
    /// # Errors
    /// As [`Mount::parse`]; when no camera is there, two have one name, or a name cannot be part of a topic's.
    pub fn parse_all(file: &str, text: &str) -> Result<Vec<(Option<String>, Self)>, ConfigError> {
        let root = yaml::parse(file, text)?;
        let top = root.map()?;
        if top.opt_node("mounts").is_none() {
            return Ok(vec![(None, Self::parse(file, text)?)]);
        }
        let mut mounts: Vec<(Option<String>, Self)> = Vec::new();
        for node in top.list("mounts")? {
            let map = node.map()?;
            let name = map.str("camera")?.to_owned();
            let mount = Self::read(&map)?;
            map.finish()?;
            if !is_part_of_a_topic(&name) {
                let remedy = "write a word of small letters, digits and underscores that begins with a letter";
                return Err(map.error("camera", "cannot be part of a topic's name", remedy));
            }
            if mounts.iter().any(|(other, _)| other.as_ref() == Some(&name)) {
                return Err(map.error("camera", "is there twice", "give each camera its own name"));
            }
            mount.validate().map_err(|error| map.error("position", error.to_string(), "measure its place again"))?;
            mounts.push((Some(name), mount));
        }
        top.finish()?;
        if mounts.is_empty() {
            return Err(top.error("mounts", "names no camera", "write at least one"));
        }
        Ok(mounts)
    }

    fn read(map: &Map<'_>) -> Result<Self, ConfigError> {
        let [x, y, height] = map.get("position")?;
        let [roll, pitch, yaw] = map.get_or("orientation", [0.0; 3])?;
        Ok(Self { x, y, height, roll, pitch, yaw })
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

fn is_part_of_a_topic(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_lowercase())
        && name.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_')
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

    #[test]
    fn several_cameras_have_names_of_their_own() {
        let parse = |text: &str| Mount::parse_all("mount.yaml", text);
        assert_eq!(parse("mount: {position: [1, 1, 3]}").unwrap()[0].0, None);
        let two = "mounts:\n- {camera: west, position: [1, 1, 3]}\n- {camera: east, position: [3, 1, 3]}\n";
        let mounts = parse(two).unwrap();
        assert_eq!((mounts.len(), mounts[1].0.as_deref(), mounts[1].1.x), (2, Some("east"), 3.0));
        let check = |text: &str, expected: &str| {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        };
        check(&two.replace("east", "west"), "is there twice");
        check(&two.replace("east", "e/st"), "cannot be part of a topic's name");
        check(&two.replace("[3, 1, 3]", "[3, 1, -3]"), "height must be greater than zero");
        check("mounts: []\n", "names no camera");
    }
}
