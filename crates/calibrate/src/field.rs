//! Where the camera hangs, from points whose places on the field are known.
//!
//! One bad point ruins a calibration without anybody noticing: the fit spreads its error over all. So each point is left out
//! once; the one without which the others agree far better is named.

use crate::least_squares::{Model, solve};
use nalgebra::Point3;
use trench_config::ConfigError;
use trench_config::yaml;
use trench_optics::{Camera, Lens, Mount, Pixel};

/// A point whose place is known.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownPoint {
    /// What people call it.
    pub name: String,
    /// Where it is seen.
    pub pixel: Pixel,
    /// Where it is, m, map.
    pub x: f64,
    /// m, map
    pub y: f64,
    /// Above the floor, m; None: on a pad whose height is to be found, the same for all such points.
    pub height: Option<f64>,
}

/// How a point agrees with the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Misfit {
    /// The point's name.
    pub name: String,
    /// From where the others say that it is to where it is said to be, m.
    pub left_out: f64,
    /// From where the fit of all says that it is, m.
    pub fitted: f64,
    /// Root mean square of the others' own misfits without this point, m.
    pub others: f64,
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// The camera's place.
    pub mount: Mount,
    /// Standard deviations of x, y, height (m), roll, pitch, yaw (rad), pad height (m; 0 where that was known).
    pub deviations: [f64; 7],
    /// The pads' height, if points were on pads.
    pub pad_height: Option<f64>,
    /// Root mean square of all misfits, m.
    pub rms: f64,
    /// Each point, in the order given.
    pub points: Vec<Misfit>,
    /// The point that does not agree with the others, if there is one.
    pub bad: Option<String>,
}

/// Why the points tell nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FieldError {
    /// Too few points.
    #[error("{given} points are given, {needed} are needed: 4, and 5 to find out which of them is wrong")]
    Few {
        /// Points given.
        given: usize,
        /// The least.
        needed: usize,
    },
    /// All points lie on a line.
    #[error("the points lie on a line: take some beside it, best near the corners of the picture")]
    Collinear,
    /// A point is outside the picture, or not a number.
    #[error("{0} is not a point of the picture")]
    Outside(String),
    /// The fit did not end at a camera that looks down.
    #[error("no place of the camera explains the points: are x and y exchanged, or is the lens another camera's?")]
    NoFit,
}

/// Fewer points leave the place open.
const FEWEST: usize = 4;
/// Points whose spread across is less than this part of that along lie on a line.
const NARROW: f64 = 0.05;
/// A point is bad if the others agree so many times better without it, and it is off by at least so much, m.
const CONTRAST: f64 = 3.0;
const WORTH_NAMING: f64 = 0.004;

/// Where the camera with this lens hangs, near `guess`.
///
/// # Errors
/// When the points do not tell it.
pub fn fit_field(lens: &Lens, points: &[KnownPoint], guess: &Mount) -> Result<Field, FieldError> {
    let unknown_height = points.iter().any(|point| point.height.is_none());
    let needed = FEWEST + usize::from(unknown_height);
    if points.len() < needed {
        return Err(FieldError::Few { given: points.len(), needed });
    }
    let whole = |point: &&KnownPoint| {
        let Pixel { u, v } = point.pixel;
        let finite = (u + v + point.x + point.y + point.height.unwrap_or(0.0)).is_finite();
        !(finite && lens.contains(point.pixel, 0.0))
    };
    if let Some(point) = points.iter().find(whole) {
        return Err(FieldError::Outside(point.name.clone()));
    }
    if is_narrow(points) {
        return Err(FieldError::Collinear);
    }
    let all: Vec<&KnownPoint> = points.iter().collect();
    let fit = fit(lens, &all, guess).ok_or(FieldError::NoFit)?;
    let misfits = points.iter().enumerate().map(|(index, point)| {
        let rest: Vec<&KnownPoint> =
            all.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, p)| *p).collect();
        // With the least number of points nothing can be left out.
        let without = if points.len() > needed { self::fit(lens, &rest, &fit.mount) } else { None };
        let fitted = off(&fit.camera(lens), point, fit.pad_height);
        match without {
            Some(without) => Misfit {
                name: point.name.clone(),
                left_out: off(&without.camera(lens), point, without.pad_height),
                fitted,
                others: without.rms(lens, &rest),
            },
            None => Misfit { name: point.name.clone(), left_out: fitted, fitted, others: f64::NAN },
        }
    });
    let misfits: Vec<Misfit> = misfits.collect();
    let rms = fit.rms(lens, &all);
    let best = misfits.iter().filter(|misfit| misfit.others.is_finite()).min_by(|a, b| a.others.total_cmp(&b.others));
    let is_bad = |misfit: &&Misfit| rms > CONTRAST * misfit.others && misfit.left_out > WORTH_NAMING;
    let bad = best.filter(is_bad).map(|misfit| misfit.name.clone());
    let Fit { mount, pad_height, deviations } = fit;
    Ok(Field { mount, deviations, pad_height, rms, points: misfits, bad })
}

struct Fit {
    mount: Mount,
    pad_height: Option<f64>,
    deviations: [f64; 7],
}

impl Fit {
    fn camera(&self, lens: &Lens) -> Option<Camera> {
        Camera::new(*lens, self.mount).ok()
    }

    fn rms(&self, lens: &Lens, points: &[&KnownPoint]) -> f64 {
        let camera = self.camera(lens);
        let total: f64 = points.iter().map(|point| off(&camera, point, self.pad_height)).map(|off| off * off).sum();
        libm::sqrt(total / points.len() as f64)
    }
}

/// From where a camera sees a point to where it is said to be, m.
fn off(camera: &Option<Camera>, point: &KnownPoint, pad_height: Option<f64>) -> f64 {
    let height = point.height.or(pad_height).unwrap_or(0.0);
    let seen = camera.as_ref().and_then(|camera| camera.unproject(point.pixel, height));
    seen.map_or(f64::INFINITY, |seen| libm::hypot(seen.x - point.x, seen.y - point.y))
}

fn fit(lens: &Lens, points: &[&KnownPoint], guess: &Mount) -> Option<Fit> {
    let unknown_height = points.iter().any(|point| point.height.is_none());
    let mut start = vec![guess.x, guess.y, guess.height, guess.roll, guess.pitch, guess.yaw];
    start.extend(unknown_height.then_some(0.0));
    let model = Points { lens, points, parameters: start.len() };
    let solution = solve(&model, start)?;
    let mount = mount_of(&solution.parameters);
    let mut deviations = [0.0; 7];
    deviations[..solution.deviations.len()].copy_from_slice(&solution.deviations);
    // The residuals were pixels; what they make of the parameters has the parameters' units.
    mount.validate().ok()?;
    Some(Fit { mount, pad_height: solution.parameters.get(6).copied(), deviations })
}

fn mount_of(parameters: &[f64]) -> Mount {
    let [x, y, height, roll, pitch, yaw] = [0, 1, 2, 3, 4, 5].map(|index| parameters[index]);
    Mount { x, y, height, roll, pitch, yaw }
}

/// Whether the points leave the camera free to turn about a line.
fn is_narrow(points: &[KnownPoint]) -> bool {
    let count = points.len() as f64;
    let mean = |place: fn(&KnownPoint) -> f64| points.iter().map(place).sum::<f64>() / count;
    let (x, y) = (mean(|point| point.x), mean(|point| point.y));
    let sum = |term: &dyn Fn(f64, f64) -> f64| points.iter().map(|point| term(point.x - x, point.y - y)).sum::<f64>();
    let (xx, xy, yy) = (sum(&|x, _| x * x), sum(&|x, y| x * y), sum(&|_, y| y * y));
    let (half, apart) = (0.5 * (xx + yy), libm::hypot(0.5 * (xx - yy), xy));
    // Eigenvalues of the spread.
    half - apart < NARROW * NARROW * (half + apart)
}

struct Points<'a> {
    lens: &'a Lens,
    points: &'a [&'a KnownPoint],
    parameters: usize,
}

impl Model for Points<'_> {
    fn parts(&self) -> usize {
        1
    }

    fn shared(&self) -> usize {
        self.parameters
    }

    fn own(&self) -> usize {
        0
    }

    fn residuals_of(&self, _: usize) -> usize {
        2 * self.points.len()
    }

    fn residuals(&self, _: usize, shared: &[f64], _: &[f64], into: &mut [f64]) -> bool {
        let Ok(camera) = Camera::new(*self.lens, mount_of(shared)) else { return false };
        let pad_height = shared.get(6).copied().unwrap_or(0.0);
        for (point, residual) in self.points.iter().zip(into.chunks_exact_mut(2)) {
            let place = Point3::new(point.x, point.y, point.height.unwrap_or(pad_height));
            let Some(seen) = camera.project(place) else { return false };
            (residual[0], residual[1]) = (seen.u - point.pixel.u, seen.v - point.pixel.v);
        }
        into.iter().all(|residual| residual.is_finite())
    }
}

/// Reads a file of known points:
///
/// ```yaml
/// points:
/// - {name: corner, pixel: [31.5, 540.2], map: [0.1, 0.1]}              # on the floor
/// - {name: table, pixel: [400.0, 300.0], map: [1.2, 0.9], height: 0.1} # m above it
/// - {name: robot, pixel: [200.0, 300.0], map: [0.6, 0.9], pad: true}   # on a pad whose height is to be found
/// ```
///
/// # Errors
/// With line and key.
pub fn read_points(file: &str, text: &str) -> Result<Vec<KnownPoint>, ConfigError> {
    let root = yaml::parse(file, text)?;
    let top = root.map()?;
    let mut points: Vec<KnownPoint> = Vec::new();
    for node in top.list("points")? {
        let map = node.map()?;
        let name = map.opt_str("name")?.map_or_else(|| format!("point {}", points.len() + 1), str::to_owned);
        let ([u, v], [x, y]): ([f64; 2], [f64; 2]) = (map.get("pixel")?, map.get("map")?);
        let (height, pad) = (map.get_or("height", 0.0)?, map.get_or("pad", false)?);
        map.finish()?;
        points.push(KnownPoint { name, pixel: Pixel { u, v }, x, y, height: (!pad).then_some(height) });
    }
    top.finish()?;
    Ok(points)
}
