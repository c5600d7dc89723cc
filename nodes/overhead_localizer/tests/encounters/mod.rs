//! Two robots that drive past each other, anywhere and anyhow.

use nalgebra::Vector2;
use trench_optics::{Pad, Pose2};

/// Uniform random numbers, seeded.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as f64) / 2_147_483_648.0
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// Two robots that drive past each other with `gap` (m) between their bodies at the nearest point, at time zero.
pub(crate) fn encounter(random: &mut Random, gap: f64) -> impl Fn(f64) -> [Pose2; 2] + use<> {
    let headings = loop {
        let headings = [random.within(-3.0, 3.0), random.within(-3.0, 3.0)];
        if (headings[0].sin() - headings[1].sin()).hypot(headings[0].cos() - headings[1].cos()) > 0.4 {
            break headings;
        }
    };
    let speeds = [random.within(0.1, 0.3), random.within(0.1, 0.3)];
    let velocity = |robot: usize| speeds[robot] * Vector2::new(headings[robot].cos(), headings[robot].sin());
    let (first, second) = (velocity(0), velocity(1));
    let relative = (second - first).normalize();
    let aside = (Pad::NOMINAL.body_diameter + gap) * Vector2::new(-relative.y, relative.x);
    move |time| {
        let at = |place: Vector2<f64>, theta| Pose2 { x: 1.2 + place.x, y: 0.9 + place.y, theta };
        [at(first * time, headings[0]), at(aside + second * time, headings[1])]
    }
}
