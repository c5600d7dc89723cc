//! A camera's exposure, gain and white balance.
//!
//! Automatic ones hunt: the picture breathes, and with it the discs' sizes; exposure sets the blur. A test bed wants them
//! fixed.

use linuxvideo::Device;
use linuxvideo::controls::Cid;

/// What the camera is told; None leaves it as it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Controls {
    /// s; 0: automatic.
    pub exposure: Option<f64>,
    /// In the driver's own units.
    pub gain: Option<i32>,
    /// Colour temperature of the light, K; 0: automatic.
    pub white_balance: Option<i32>,
}

/// V4L2 counts exposure in these, s.
const EXPOSURE_UNIT: f64 = 1e-4;
/// Values of EXPOSURE_AUTO: set by hand, and by the light at the lens's aperture.
const BY_HAND: i32 = 1;
const BY_LIGHT: i32 = 3;

/// One control: which, its value, what people call it.
type Write = (Cid, i32, &'static str);

impl Controls {
    /// What is written, in this order: a value counts only once its automatic is off.
    fn writes(&self) -> Vec<Write> {
        let mut writes = Vec::new();
        match self.exposure {
            Some(seconds) if seconds > 0.0 => {
                let units = ((seconds / EXPOSURE_UNIT).round() as i32).max(1);
                writes.extend([
                    (Cid::EXPOSURE_AUTO, BY_HAND, "controls.exposure"),
                    (Cid::EXPOSURE_ABSOLUTE, units, "controls.exposure"),
                ]);
            }
            Some(_) => writes.push((Cid::EXPOSURE_AUTO, BY_LIGHT, "controls.exposure")),
            None => {}
        }
        writes.extend(self.gain.map(|gain| (Cid::GAIN, gain, "controls.gain")));
        match self.white_balance {
            Some(kelvin) if kelvin > 0 => writes.extend([
                (Cid::AUTO_WHITE_BALANCE, 0, "controls.white_balance"),
                (Cid::WHITE_BALANCE_TEMPERATURE, kelvin, "controls.white_balance"),
            ]),
            Some(_) => writes.push((Cid::AUTO_WHITE_BALANCE, 1, "controls.white_balance")),
            None => {}
        }
        writes
    }

    /// Tells the camera at `path`, which may be streaming meanwhile.
    ///
    /// # Errors
    /// With the control that it refuses and its reason.
    pub(super) fn apply(&self, path: &str) -> Result<(), String> {
        let writes = self.writes();
        if writes.is_empty() {
            return Ok(());
        }
        let mut device = Device::open(path).map_err(|error| format!("cannot open {path}: {error}"))?;
        for (control, value, name) in writes {
            let written = device.write_control_raw(control, value);
            written.map_err(|error| format!("{path} refuses {value} for {name}: {error}"))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_written_after_their_automatics_are_off() {
        let check = |controls: Controls, expected: &[(Cid, i32)]| {
            let writes: Vec<(Cid, i32)> = controls.writes().into_iter().map(|(cid, value, _)| (cid, value)).collect();
            assert_eq!(writes, expected, "{controls:?}");
        };
        check(Controls::default(), &[]);
        check(
            Controls { exposure: Some(0.01), gain: Some(16), white_balance: Some(4500) },
            &[
                (Cid::EXPOSURE_AUTO, 1),
                (Cid::EXPOSURE_ABSOLUTE, 100),
                (Cid::GAIN, 16),
                (Cid::AUTO_WHITE_BALANCE, 0),
                (Cid::WHITE_BALANCE_TEMPERATURE, 4500),
            ],
        );
        check(
            Controls { exposure: Some(0.0), gain: None, white_balance: Some(0) },
            &[(Cid::EXPOSURE_AUTO, 3), (Cid::AUTO_WHITE_BALANCE, 1)],
        );
        check(
            Controls { exposure: Some(1e-6), ..Controls::default() },
            &[(Cid::EXPOSURE_AUTO, 1), (Cid::EXPOSURE_ABSOLUTE, 1)],
        );
    }

    #[test]
    fn a_camera_that_is_none_refuses() {
        let controls = Controls { gain: Some(3), ..Controls::default() };
        assert!(controls.apply("/dev/no-such-camera").unwrap_err().starts_with("cannot open /dev/no-such-camera: "));
        assert_eq!(Controls::default().apply("/dev/no-such-camera"), Ok(()));
    }
}
