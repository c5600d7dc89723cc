//! Limits of the pads' colours, from samples of discs and of everything else.

use std::fmt::Write as _;

/// Pixels of both discs and of what is no disc: red, green, blue.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Samples {
    /// Of yellow discs.
    pub yellow: Vec<[u8; 3]>,
    /// Of blue discs.
    pub blue: Vec<[u8; 3]>,
    /// Of floor, bodies, things.
    pub rest: Vec<[u8; 3]>,
}

/// Limits as the localizer's parameters `colour.*` want them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colours {
    /// Least (R + G - 2 B) / (R + G + B) of yellow.
    pub yellow: f64,
    /// Least (2 B - R - G) / (R + G + B) of blue.
    pub blue: f64,
    /// Least absolute difference of either, of 510.
    pub minimum: f64,
}

/// Why samples give no limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ColourError {
    /// Too few pixels.
    #[error("too few pixels of {0}: click into the middle of a disc")]
    Few(&'static str),
    /// They are not of that colour, or the surroundings are.
    #[error(
        "{0} cannot be told from the rest: is it the right disc, is the light coloured, is the picture too bright?"
    )]
    Alike(&'static str),
}

/// Fewer pixels say nothing of a disc's spread.
const FEWEST: usize = 9;
/// Between the rest and the disc the limit lies so far from the rest: light changes the discs more than grey things.
const PLACE: f64 = 0.45;

impl Colours {
    /// A parameter file for the localizer of the camera called `camera`.
    #[must_use]
    pub fn to_yaml(&self, camera: &str) -> String {
        let Self { yellow, blue, minimum } = self;
        let mut text = format!("# Colours of the pads below the camera {camera:?}, by `trench calibrate colours`.\n");
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "/**/overhead_localizer:\n  ros__parameters:\n    colour: {{camera: {camera:?}, yellow: {yellow:.3}, blue: {blue:.3}, minimum: \
             {minimum:.1}}}\n"
        );
        text
    }
}

/// Limits between the discs' samples and the rest.
///
/// # Errors
/// When they cannot be told apart.
pub fn learn_colours(samples: &Samples) -> Result<Colours, ColourError> {
    let chroma = |[r, g, b]: &[u8; 3]| f64::from(*r) + f64::from(*g) - 2.0 * f64::from(*b);
    let ratio = |pixel: &[u8; 3]| chroma(pixel) / pixel.iter().map(|value| f64::from(*value)).sum::<f64>().max(1.0);
    let limit = |name: &'static str, disc: &[[u8; 3]], sign: f64| {
        if disc.len() < FEWEST {
            return Err(ColourError::Few(name));
        }
        let weakest = quantile(disc.iter().map(|pixel| sign * ratio(pixel)), 0.1);
        let rest = quantile(samples.rest.iter().map(|pixel| sign * ratio(pixel)), 0.95).max(0.0);
        if weakest < 0.15 || weakest < 1.5 * rest {
            return Err(ColourError::Alike(name));
        }
        Ok(rest + PLACE * (weakest - rest))
    };
    let (yellow, blue) = (limit("yellow", &samples.yellow, 1.0)?, limit("blue", &samples.blue, -1.0)?);
    let faintest = |disc: &[[u8; 3]], sign: f64| quantile(disc.iter().map(|pixel| sign * chroma(pixel)), 0.1);
    // A third of the light must do.
    let minimum = (faintest(&samples.yellow, 1.0).min(faintest(&samples.blue, -1.0)) / 3.0).clamp(20.0, 120.0);
    Ok(Colours { yellow, blue, minimum })
}

fn quantile(values: impl Iterator<Item = f64>, part: f64) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(((values.len() as f64 - 1.0).max(0.0) * part) as usize).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples() -> Samples {
        let around = |colour: [u8; 3]| (0..25_u8).map(|k| colour.map(|value| value + k % 5)).collect::<Vec<_>>();
        Samples { yellow: around([235, 205, 45]), blue: around([35, 80, 200]), rest: around([150, 150, 145]) }
    }

    #[test]
    fn limits_lie_between_discs_and_floor() {
        let Colours { yellow, blue, minimum } = learn_colours(&samples()).unwrap();
        assert!((0.2..0.6).contains(&yellow) && (0.2..0.6).contains(&blue), "{yellow} {blue}");
        assert!((60.0..110.0).contains(&minimum), "{minimum}");
    }

    #[test]
    fn wrong_discs_are_refused() {
        let all = samples();
        let exchanged = Samples { yellow: all.blue.clone(), ..all.clone() };
        assert_eq!(learn_colours(&exchanged), Err(ColourError::Alike("yellow")));
        assert_eq!(learn_colours(&Samples { blue: Vec::new(), ..all }), Err(ColourError::Few("blue")));
    }
}
