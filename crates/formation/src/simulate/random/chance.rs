//! Numbers from a seed.
use crate::Vector2;

/// Chance from a Weyl sequence with a mixer (splitmix64).
pub(super) struct Chance(pub(super) u64);

impl Chance {
    pub(super) fn fraction(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.fraction()
    }

    pub(super) fn below(&mut self, count: u32) -> u32 {
        (self.fraction() * f64::from(count)) as u32
    }

    pub(super) fn point(&mut self, half: f64) -> Vector2<f64> {
        Vector2::new(self.between(-half, half), self.between(-half, half))
    }

    pub(super) fn direction(&mut self) -> Vector2<f64> {
        let (sine, cosine) = libm::sincos(self.between(0.0, core::f64::consts::TAU));
        Vector2::new(cosine, sine)
    }
}
