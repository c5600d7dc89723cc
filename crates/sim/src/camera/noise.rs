//! Pixel noise at the speed of copying: a table of Gaussian bytes, each row of a frame from another place in it.

/// A generator that costs nothing to seed: S. Vigna's splitmix64.
#[derive(Debug, Clone, Copy)]
pub(super) struct SplitMix(pub(super) u64);

impl SplitMix {
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Uniform in [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }
}

/// Gaussian pixel noise of one standard deviation.
#[derive(Debug, Clone)]
pub struct Noise {
    table: Vec<i8>,
    row_bytes: usize,
}

/// Start positions in the table: far more than rows in a frame.
const STARTS: usize = 1 << 17;

impl Noise {
    /// Noise of standard deviation `sigma` (of 255) for images of `row_bytes` bytes a row.
    #[must_use]
    pub fn new(sigma: f64, row_bytes: usize, seed: u64) -> Self {
        let mut random = SplitMix(seed);
        let mut table = Vec::with_capacity(STARTS + row_bytes + 1);
        while sigma > 0.0 && table.len() < STARTS + row_bytes {
            // Box and Muller's transform gives two at a time.
            let radius = sigma * libm::sqrt(-2.0 * libm::log(1.0 - random.unit()));
            let angle = std::f64::consts::TAU * random.unit();
            for value in [radius * libm::cos(angle), radius * libm::sin(angle)] {
                table.push(libm::round(value).clamp(-128.0, 127.0) as i8);
            }
        }
        Self { table, row_bytes }
    }

    /// Adds noise to a frame, the same for the same `seed`, clamped to what a byte holds.
    pub fn add(&self, seed: u64, image: &mut [u8]) {
        if self.table.is_empty() {
            return;
        }
        let mut random = SplitMix(seed);
        for row in image.chunks_mut(self.row_bytes.max(1)) {
            let start = random.next() as usize % STARTS;
            let noise = self.table.get(start..start + row.len()).unwrap_or_default();
            for (value, noise) in row.iter_mut().zip(noise) {
                *value = (i16::from(*value) + i16::from(*noise)).clamp(0, 255) as u8;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_gaussian_and_differs_from_frame_to_frame() {
        let noise = Noise::new(4.0, 2304, 7);
        let mut frame = vec![128_u8; 2304 * 576];
        noise.add(1, &mut frame);
        let deviations: Vec<f64> = frame.iter().map(|value| f64::from(*value) - 128.0).collect();
        let count = deviations.len() as f64;
        let mean = deviations.iter().sum::<f64>() / count;
        let moment = |power: i32| deviations.iter().map(|d| (d - mean).powi(power)).sum::<f64>() / count;
        assert!(mean.abs() < 0.03, "mean {mean}");
        assert!((moment(2).sqrt() - 4.0).abs() < 0.05, "sigma {}", moment(2).sqrt());
        assert!((moment(4) / moment(2).powi(2) - 3.0).abs() < 0.1, "kurtosis {}", moment(4) / moment(2).powi(2));

        let mut second = vec![128_u8; 2304 * 576];
        noise.add(2, &mut second);
        let equal = frame.iter().zip(&second).filter(|(a, b)| a == b).count();
        assert!((equal as f64) < 0.1 * count, "{equal} of {count} bytes are equal in two frames");
    }

    #[test]
    fn none_leaves_the_frame_alone() {
        let mut frame = vec![9_u8; 30];
        Noise::new(0.0, 30, 7).add(1, &mut frame);
        assert_eq!(frame, vec![9_u8; 30]);
    }
}
