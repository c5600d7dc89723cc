//! How the test bed looks.

/// Red, green and blue as the camera would give them in full light.
pub type Colour = [u8; 3];

/// What the floor looks like; random parts come from [`Appearance::seed`] and stay the same from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Background {
    /// One colour.
    Plain(Colour),
    /// A colour with blotches, brighter and darker by up to `contrast` (0..1).
    Noisy(Colour, f32),
    /// Boards with a grain, along the image's rows.
    Wood,
}

/// Colours, light and sensor noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Appearance {
    /// The floor.
    pub background: Background,
    /// The front disc of each pad.
    pub yellow: Colour,
    /// The rear disc.
    pub blue: Colour,
    /// The robots' bodies and the pads' ground.
    pub body: Colour,
    /// Obstacles.
    pub obstacle: Colour,
    /// How much darker the darkest corner is than the brightest, 0..1.
    pub gradient: f64,
    /// The direction in the image in which it darkens, rad from +u towards +v.
    pub gradient_direction: f64,
    /// Standard deviation of every channel of every pixel, of 255.
    pub noise: f64,
    /// For background and noise.
    pub seed: u64,
}

impl Default for Appearance {
    /// A grey floor, a light gradient of 30 %, noise of 4/255.
    fn default() -> Self {
        Self {
            background: Background::Plain([150, 150, 145]),
            yellow: [235, 205, 45],
            blue: [35, 80, 200],
            body: [38, 38, 40],
            obstacle: [95, 95, 95],
            gradient: 0.3,
            gradient_direction: 0.6,
            noise: 4.0,
            seed: 0,
        }
    }
}

/// The light on each pixel as a linear function, 1 where it is brightest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Light {
    at_origin: f32,
    per_column: f32,
    per_row: f32,
}

impl Light {
    pub(super) fn new(appearance: &Appearance, width: usize, height: usize) -> Self {
        let direction = appearance.gradient_direction;
        let (along_u, along_v) = (libm::cos(direction) as f32, libm::sin(direction) as f32);
        // The position along the gradient runs from `lowest` to `lowest + span` over the image.
        let (across, down) = (along_u * width as f32, along_v * height as f32);
        let lowest = across.min(0.0) + down.min(0.0);
        let darkening = appearance.gradient as f32 / (across.abs() + down.abs()).max(1.0);
        Self { at_origin: 1.0 + darkening * lowest, per_column: -darkening * along_u, per_row: -darkening * along_v }
    }

    pub(super) fn at(&self, u: usize, v: usize) -> f32 {
        self.at_origin + self.per_column * u as f32 + self.per_row * v as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_spans_the_gradient_whatever_its_direction() {
        for direction in [0.0, 0.6, 2.0, 3.5, 5.5] {
            let appearance = Appearance { gradient_direction: direction, ..Appearance::default() };
            let light = Light::new(&appearance, 768, 576);
            let corners = [light.at(0, 0), light.at(768, 0), light.at(0, 576), light.at(768, 576)];
            let brightest = corners.iter().copied().fold(f32::MIN, f32::max);
            let darkest = corners.iter().copied().fold(f32::MAX, f32::min);
            assert!((brightest - 1.0).abs() < 1e-5 && (darkest - 0.7).abs() < 1e-5, "{corners:?}");
        }
    }
}
