//! The noise of a robot that stands still (4.5.3): mean, standard deviation, spectrum.

use crate::run::{Pose, Track};
use realfft::RealFftPlanner;
use serde::Serialize;
use std::f64::consts::{PI, TAU};

/// Fewer poses tell nothing of noise.
const FEWEST: usize = 16;

/// How the measured pose of a robot at rest varies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Noise {
    /// How many poses were measured.
    pub samples: usize,
    /// How many were missing between them and are filled in for the spectrum.
    pub missing: usize,
    /// Hz.
    pub rate: f64,
    /// Along x, m.
    pub x: NoiseSeries,
    /// Along y, m.
    pub y: NoiseSeries,
    /// Of the heading, rad.
    pub theta: NoiseSeries,
}

/// One coordinate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NoiseSeries {
    /// The mean.
    pub mean: f64,
    /// The standard deviation.
    pub deviation: f64,
    /// The kurtosis less that of Gaussian noise, 0.
    pub excess_kurtosis: f64,
    /// Time (s) and what the measure was above the mean.
    #[serde(skip)]
    pub errors: Vec<(f64, f64)>,
    /// Frequency (Hz) and amplitude: a sine of amplitude A gives A at its frequency.
    #[serde(skip)]
    pub spectrum: Vec<(f64, f64)>,
}

/// The noise of a track from `first` to `last` (s), in which the robot stands; nothing with too few poses.
#[must_use]
pub fn noise(track: &Track, first: f64, last: f64) -> Option<Noise> {
    let poses: Vec<Pose> = track.poses.iter().filter(|pose| pose.time >= first && pose.time <= last).copied().collect();
    if poses.len() < FEWEST {
        return None;
    }
    let mut steps: Vec<f64> = poses.iter().zip(poses.iter().skip(1)).map(|(a, b)| b.time - a.time).collect();
    steps.sort_by(f64::total_cmp);
    // Of a camera that misses frames, the middle step is still one frame.
    let period = steps.get(steps.len() / 2).copied().filter(|step| *step > 0.0)?;
    let (begin, end) = (poses.first()?.time, poses.last()?.time);
    let count = ((end - begin) / period).round() as usize + 1;
    // The Fourier transform wants evenly spaced samples: missing ones lie on the line between their neighbours.
    let even = Track { poses: poses.clone(), ..Track::default() };
    let even: Vec<Pose> = (0..count).filter_map(|index| even.pose_at(begin + index as f64 * period)).collect();
    let reference = poses.first()?.theta;
    // Headings around the half turn must not jump.
    let heading = |pose: &Pose| reference + (pose.theta - reference + PI).rem_euclid(TAU) - PI;
    Some(Noise {
        samples: poses.len(),
        missing: count.saturating_sub(poses.len()),
        rate: 1.0 / period,
        x: series(&poses, &even, period, |pose| pose.x)?,
        y: series(&poses, &even, period, |pose| pose.y)?,
        theta: series(&poses, &even, period, heading)?,
    })
}

fn series(poses: &[Pose], even: &[Pose], period: f64, value: impl Fn(&Pose) -> f64) -> Option<NoiseSeries> {
    let count = poses.len() as f64;
    let mean = poses.iter().map(&value).sum::<f64>() / count;
    let errors: Vec<_> = poses.iter().map(|pose| (pose.time, value(pose) - mean)).collect();
    let moment = |power: i32| errors.iter().map(|(_, error)| error.powi(power)).sum::<f64>() / count;
    let variance = moment(2);
    let excess_kurtosis = if variance > 0.0 { moment(4) / (variance * variance) - 3.0 } else { 0.0 };
    let spectrum = spectrum(even.iter().map(|pose| value(pose) - mean).collect(), period)?;
    // Of a sample, hence one less.
    let deviation = (variance * count / (count - 1.0)).sqrt();
    Some(NoiseSeries { mean, deviation, excess_kurtosis, errors, spectrum })
}

/// Amplitudes over frequencies (Hz), up to half the rate of sampling.
fn spectrum(mut values: Vec<f64>, period: f64) -> Option<Vec<(f64, f64)>> {
    let count = values.len();
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(count);
    let mut bins = transform.make_output_vec();
    transform.process(&mut values, &mut bins).ok()?;
    let amplitude = |(index, bin): (usize, &realfft::num_complex::Complex<f64>)| {
        // Each frequency but the first and the last stands for a pair of them.
        let sides = if index == 0 || 2 * index == count { 1.0 } else { 2.0 };
        (index as f64 / (count as f64 * period), sides * bin.norm() / count as f64)
    };
    Some(bins.iter().enumerate().map(amplitude).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten seconds at 50 Hz of a sine of 3 mm at 5 Hz along x, headings around the half turn, every seventh missing.
    fn track() -> Track {
        let poses = (0..500).filter(|index| index % 7 != 3).map(|index| {
            let time = f64::from(index) * 0.02;
            let theta = if index % 2 == 0 { PI - 0.01 } else { -PI + 0.01 };
            Pose { time, x: 1.0 + 0.003 * (TAU * 5.0 * time).sin(), y: 2.0, theta, ..Pose::default() }
        });
        Track { poses: poses.collect(), ..Track::default() }
    }

    #[test]
    fn a_sine_shows_at_its_frequency() {
        let noise = noise(&track(), 0.0, 10.0).unwrap();
        assert_eq!((noise.samples, noise.missing), (429, 71));
        assert!((noise.rate - 50.0).abs() < 1e-6);
        assert!((noise.x.mean - 1.0).abs() < 1e-4 && (noise.x.deviation - 0.003 / 2.0_f64.sqrt()).abs() < 1e-4);
        let (frequency, amplitude) = noise.x.spectrum.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        assert!((frequency - 5.0).abs() < 1e-6, "{frequency} Hz");
        assert!((amplitude - 0.003).abs() < 2e-4, "{amplitude} m");
        assert_eq!(noise.y.deviation, 0.0);
        assert!((noise.theta.deviation - 0.01).abs() < 1e-3, "{} rad", noise.theta.deviation);
        assert!((noise.x.spectrum.last().unwrap().0 - 25.0).abs() < 0.1, "half the rate");
    }

    #[test]
    fn a_few_poses_tell_nothing() {
        assert_eq!(noise(&track(), 0.0, 0.2), None);
        assert_eq!(noise(&Track::default(), 0.0, 10.0), None);
    }
}
