//! The cameras over one field: one, or several that overlap, with one map.

use crate::{Camera, CameraInfo, Mount};
use trench_config::ConfigError;

/// Stands for the camera's name in the name of a lens file.
const PLACEHOLDER: &str = "{camera}";

/// A camera, and its name where there are several.
#[derive(Debug, Clone, PartialEq)]
pub struct Overhead {
    /// Part of its topics' names; the only camera has none.
    pub name: Option<String>,
    /// Lens and mount.
    pub camera: Camera,
    /// What the lens file calls it.
    pub lens_name: String,
}

impl Overhead {
    /// All cameras of a mount file (its name and its text). Their lenses are in `lens_file`, in which `{camera}` stands for
    /// the camera's name; `read` gives the text of a file.
    ///
    /// # Errors
    /// When a file cannot be read, or is not what it should be.
    pub fn all(
        lens_file: &str,
        (mount_file, mounts): (&str, &str),
        read: impl Fn(&str) -> Result<String, ConfigError>,
    ) -> Result<Vec<Self>, ConfigError> {
        let mounts = Mount::parse_all(mount_file, mounts)?;
        let camera = |(name, mount): (Option<String>, Mount)| {
            let path = lens_file.replace(PLACEHOLDER, name.as_deref().unwrap_or("overhead"));
            let CameraInfo { name: lens_name, lens } = CameraInfo::parse(&path, &read(&path)?)?;
            // Both files are checked: what is left to go wrong is not the reader's business.
            let camera = Camera::new(lens, mount).map_err(|error| ConfigError {
                origin: trench_config::Origin::new(path.as_str(), 1),
                key: "camera_matrix".to_owned(),
                value: String::new(),
                problem: error.to_string(),
                remedy: "calibrate the camera again".to_owned(),
            })?;
            Ok(Self { name, camera, lens_name })
        };
        mounts.into_iter().map(camera).collect()
    }

    /// A topic of this camera: `/overhead/image_raw`, or `/overhead/west/image_raw` of several.
    #[must_use]
    pub fn topic(&self, what: &str) -> String {
        match &self.name {
            Some(name) => format!("/overhead/{name}/{what}"),
            None => format!("/overhead/{what}"),
        }
    }

    /// The frame of its messages.
    #[must_use]
    pub fn frame_id(&self) -> String {
        match &self.name {
            Some(name) => format!("overhead_camera_{name}"),
            None => "overhead_camera".to_owned(),
        }
    }
}
