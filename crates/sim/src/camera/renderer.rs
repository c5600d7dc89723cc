//! One frame: floor, obstacles, robots, noise.

use super::appearance::{Appearance, Light};
use super::noise::{Noise, SplitMix};
use super::obstacle::{self, Obstacle};
use super::{background, robot};
use trench_optics::{Camera, Pad, Pose2, RayTable};

/// What stands on the floor while the shutter is open.
#[derive(Debug, Clone, Copy, Default)]
pub struct Scene<'a> {
    /// For each robot its poses at equally spaced instants of the exposure, first to last: one for a sharp image, four
    /// for a realistic blur.
    pub robots: &'a [Vec<Pose2>],
    /// On the floor; robots stand in front of them.
    pub obstacles: &'a [Obstacle],
}

/// Why a frame was not rendered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum RenderError {
    /// The image has another size than the camera's.
    #[error("an rgb8 frame of this camera has {expected} bytes, the image has {actual}")]
    Size {
        /// Width times height times three.
        expected: usize,
        /// What was given.
        actual: usize,
    },
}

/// Renders frames of one camera into rgb8 images.
#[derive(Debug, Clone)]
pub struct Renderer {
    camera: Camera,
    rays: RayTable,
    pad: Pad,
    appearance: Appearance,
    light: Light,
    floor: Vec<u8>,
    noise: Noise,
}

impl Renderer {
    /// Follows every line of sight and paints the floor once (about 0.1 s).
    #[must_use]
    pub fn new(camera: Camera, pad: Pad, appearance: Appearance) -> Self {
        let (width, height) = (camera.lens().width as usize, camera.lens().height as usize);
        let light = Light::new(&appearance, width, height);
        let mut floor = vec![0; 3 * width * height];
        background::paint(&appearance, light, width, &mut floor);
        let noise = Noise::new(appearance.noise, 3 * width, appearance.seed);
        Self { rays: RayTable::new(&camera), camera, pad, appearance, light, floor, noise }
    }

    /// The camera whose frames these are.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Bytes of a frame.
    #[must_use]
    pub fn frame_len(&self) -> usize {
        self.floor.len()
    }

    /// Renders frame number `frame` (its noise differs from that of every other number).
    ///
    /// # Errors
    /// When `image` has not [`Renderer::frame_len`] bytes; it is left alone.
    pub fn render(&self, scene: Scene<'_>, frame: u64, image: &mut [u8]) -> Result<(), RenderError> {
        if image.len() != self.floor.len() {
            return Err(RenderError::Size { expected: self.floor.len(), actual: image.len() });
        }
        image.copy_from_slice(&self.floor);
        for shape in scene.obstacles {
            obstacle::draw(&self.camera, &self.rays, &self.appearance, self.light, shape, image);
        }
        for poses in scene.robots {
            robot::draw(&self.camera, &self.rays, &self.pad, &self.appearance, self.light, poses, image);
        }
        // Mixed first: consecutive frames must not start at neighbouring places of one random sequence.
        self.noise.add(SplitMix(self.appearance.seed ^ frame.rotate_left(32)).next(), image);
        Ok(())
    }
}

/// Puts a colour over a pixel with the given opacity.
pub(super) fn blend(pixel: &mut [u8], colour: [f32; 3], opacity: f32) {
    for (value, colour) in pixel.iter_mut().zip(colour) {
        // Adding a half rounds; the conversion saturates at 0 and 255.
        *value = (f32::from(*value) + opacity * (colour - f32::from(*value)) + 0.5) as u8;
    }
}

#[cfg(test)]
mod tests;
