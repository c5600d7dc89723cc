//! The effort of a law, Table 4.1.
use super::rk4;
use crate::kinematics::Polar;
use crate::laws::PointLaw;
use nalgebra::Vector3;

/// J = integral of v^2 + omega^2 over `duration` (s) from `start` towards a resting goal point, by RK4 with `steps` steps.
pub fn velocity_energy(law: &impl PointLaw, start: Polar, duration: f64, steps: u32) -> f64 {
    let step = duration / f64::from(steps);
    let mut state = Vector3::new(start.distance, start.misalignment, 0.0);
    for index in 0..steps {
        state = rk4(f64::from(index) * step, state, step, |_, state| {
            let polar = Polar { distance: state.x, misalignment: state.y };
            let twist = law.twist(polar);
            let rates = polar.rates(twist);
            Vector3::new(rates.distance, rates.misalignment, twist.v * twist.v + twist.omega * twist.omega)
        });
    }
    state.z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Robust;

    /// The exact values; the thesis prints 331.8, 129.8, 69.78, 63.87.
    #[test]
    fn table_4_1() {
        for (k3, expected) in [(19.2, 331.866_340), (20.0, 129.886_055), (21.8, 69.808_918), (22.3, 63.899_791)] {
            let start = Polar { distance: 1.0, misalignment: 1.0 };
            let got = velocity_energy(&Robust { k1: 20.0, k2: 1.0, k3 }, start, 30.0, 60_000);
            assert!((got - expected).abs() < 1e-5, "K3 = {k3}: {got}");
        }
    }
}
