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

/// The colour temperature in which the camera shows grey as grey, K.
pub const BALANCED_FOR: f64 = 5000.0;

/// Where the camera's red, green and blue are most sensitive, m.
const CHANNELS: [f64; 3] = [600e-9, 540e-9, 460e-9];

/// Planck's law at the three channels, relative to the light that the camera is balanced for; green is 1.
fn tint(temperature: f64) -> [f32; 3] {
    // h c / k, m K
    const SECOND_RADIATION_CONSTANT: f64 = 0.014_387_77;
    let radiance =
        |wavelength: f64, kelvin: f64| 1.0 / (libm::exp(SECOND_RADIATION_CONSTANT / (wavelength * kelvin)) - 1.0);
    let relative = CHANNELS.map(|wavelength| radiance(wavelength, temperature) / radiance(wavelength, BALANCED_FOR));
    relative.map(|channel| (channel / relative[1]) as f32)
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
    /// The light where it is brightest, of nominal: colours times this, cut off at 255.
    pub brightness: f64,
    /// Colour temperature of the light, K; the camera is balanced for [`BALANCED_FOR`].
    pub temperature: f64,
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
            brightness: 1.0,
            temperature: BALANCED_FOR,
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
    tint: [f32; 3],
}

impl Light {
    pub(super) fn new(appearance: &Appearance, width: usize, height: usize) -> Self {
        let direction = appearance.gradient_direction;
        let (along_u, along_v) = (libm::cos(direction) as f32, libm::sin(direction) as f32);
        // The position along the gradient runs from `lowest` to `lowest + span` over the image.
        let (across, down) = (along_u * width as f32, along_v * height as f32);
        let lowest = across.min(0.0) + down.min(0.0);
        let darkening = appearance.gradient as f32 / (across.abs() + down.abs()).max(1.0);
        let brightness = appearance.brightness as f32;
        Self {
            at_origin: brightness * (1.0 + darkening * lowest),
            per_column: brightness * -darkening * along_u,
            per_row: brightness * -darkening * along_v,
            tint: tint(appearance.temperature),
        }
    }

    fn at(&self, u: usize, v: usize) -> f32 {
        self.at_origin + self.per_column * u as f32 + self.per_row * v as f32
    }

    /// What a colour looks like at a pixel.
    pub(super) fn on(&self, colour: [f32; 3], u: usize, v: usize) -> [f32; 3] {
        let light = self.at(u, v);
        [colour[0] * light * self.tint[0], colour[1] * light * self.tint[1], colour[2] * light * self.tint[2]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warm_light_is_red_and_the_balanced_one_white() {
        assert_eq!(tint(BALANCED_FOR), [1.0; 3]);
        let ([red, _, blue], [cold_red, _, cold_blue]) = (tint(2700.0), tint(6500.0));
        assert!((red - 1.57).abs() < 0.02 && (blue - 0.45).abs() < 0.02, "{red} {blue}");
        assert!((cold_red - 0.885).abs() < 0.02 && (cold_blue - 1.24).abs() < 0.02, "{cold_red} {cold_blue}");
    }

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
