//! Damping functions k(x) of Lienard's equation (11), x'' + k(x) x' + phi(x) = 0.
use super::{Interval, Slopes, TableDamping, WrittenDamping};

/// k and its integral from 0.
pub trait Damping {
    /// k(x), 1/s, not negative.
    fn coefficient(&self, x: f64) -> f64;

    /// K(x), the integral of k from 0 to x, m/s; odd for even k.
    fn integral(&self, x: f64) -> f64;

    /// k(x-) and k(x+), which differ where k jumps, 1/s.
    fn coefficients(&self, x: f64) -> Slopes {
        Slopes::smooth(self.coefficient(x))
    }

    /// Where k may jump or has a corner, in rising order, m.
    fn kinks(&self) -> Vec<f64> {
        Vec::new()
    }

    /// An interval with all k between `low` and `high`, if the damping can tell.
    fn bounds(&self, _low: f64, _high: f64) -> Option<Interval> {
        None
    }

    /// Whether k never falls with |x|. Then K k / 4 does not either, and the trench of Corollary A.9.1 is convex.
    fn never_falls(&self) -> bool {
        false
    }
}

impl<D: Damping + ?Sized> Damping for &D {
    fn coefficient(&self, x: f64) -> f64 {
        (**self).coefficient(x)
    }

    fn integral(&self, x: f64) -> f64 {
        (**self).integral(x)
    }

    fn coefficients(&self, x: f64) -> Slopes {
        (**self).coefficients(x)
    }

    fn kinks(&self) -> Vec<f64> {
        (**self).kinks()
    }

    fn bounds(&self, low: f64, high: f64) -> Option<Interval> {
        (**self).bounds(low, high)
    }

    fn never_falls(&self) -> bool {
        (**self).never_falls()
    }
}

/// k = C, Example A.9.1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstantDamping {
    /// C, 1/s.
    pub coefficient: f64,
}

impl Damping for ConstantDamping {
    fn coefficient(&self, _: f64) -> f64 {
        self.coefficient
    }

    fn integral(&self, x: f64) -> f64 {
        self.coefficient * x
    }

    fn never_falls(&self) -> bool {
        self.coefficient >= 0.0
    }
}

/// k = alpha |x| / sqrt(x^2 + a^2), Example A.9.2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HyperbolicDamping {
    /// 1/s.
    pub alpha: f64,
    /// Metres, positive.
    pub a: f64,
}

impl Damping for HyperbolicDamping {
    fn coefficient(&self, x: f64) -> f64 {
        self.alpha * x.abs() / libm::hypot(x, self.a)
    }

    fn integral(&self, x: f64) -> f64 {
        self.alpha * x * x.abs() / (libm::hypot(x, self.a) + self.a)
    }

    fn never_falls(&self) -> bool {
        self.alpha >= 0.0
    }
}

/// [`HyperbolicDamping`] that stays at its value at |x| = 1 beyond, Example A.9.3; odd, unlike the printed K.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SaturatedDamping(pub HyperbolicDamping);

impl Damping for SaturatedDamping {
    fn coefficient(&self, x: f64) -> f64 {
        self.0.coefficient(x.clamp(-1.0, 1.0))
    }

    fn integral(&self, x: f64) -> f64 {
        let inner = x.clamp(-1.0, 1.0);
        self.0.integral(inner) + self.0.coefficient(1.0) * (x - inner)
    }

    fn never_falls(&self) -> bool {
        self.0.never_falls()
    }
}

/// A damping that is chosen while the program runs: by a parameter or a scenario file.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyDamping {
    /// Example A.9.1.
    Constant(ConstantDamping),
    /// Example A.9.2.
    Hyperbolic(HyperbolicDamping),
    /// Example A.9.3.
    Saturated(SaturatedDamping),
    /// A formula.
    Written(WrittenDamping),
    /// A table.
    Table(TableDamping),
}

impl AnyDamping {
    fn chosen(&self) -> &dyn Damping {
        match self {
            Self::Constant(damping) => damping,
            Self::Hyperbolic(damping) => damping,
            Self::Saturated(damping) => damping,
            Self::Written(damping) => damping,
            Self::Table(damping) => damping,
        }
    }
}

impl Damping for AnyDamping {
    fn coefficient(&self, x: f64) -> f64 {
        self.chosen().coefficient(x)
    }

    fn integral(&self, x: f64) -> f64 {
        self.chosen().integral(x)
    }

    fn coefficients(&self, x: f64) -> Slopes {
        self.chosen().coefficients(x)
    }

    fn kinks(&self) -> Vec<f64> {
        self.chosen().kinks()
    }

    fn bounds(&self, low: f64, high: f64) -> Option<Interval> {
        self.chosen().bounds(low, high)
    }

    fn never_falls(&self) -> bool {
        self.chosen().never_falls()
    }
}
