//! How long combining takes: `cargo bench -p trench_formation --bench hulls`. 10,000 polygons of 12 points, 1 m to 4 m across, on a
//! square kilometre, clearance 1 m. Prints the best and the median of 15 runs.
#![expect(clippy::print_stdout, reason = "the figures are the purpose")]
use std::time::Instant;
use trench_formation::Vector2;
use trench_formation::hull::{HullError, Obstacle, Shape, combine};

/// A fraction of 1 from a Weyl sequence with a mixer (splitmix64).
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut mixed = *state;
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

fn polygons() -> Result<Vec<Obstacle>, HullError> {
    let mut state = 1;
    let polygon = |id: u32| {
        let centre = 1000.0 * Vector2::new(random(&mut state), random(&mut state));
        let corner = |index: i32| {
            let (sine, cosine) = libm::sincos(core::f64::consts::TAU * f64::from(index) / 12.0);
            centre + (0.5 + 1.5 * random(&mut state)) * Vector2::new(cosine, sine)
        };
        Ok(Obstacle { id, shape: Shape::new(&(0..12).map(corner).collect::<Vec<_>>(), 0.0)? })
    };
    (0..10_000).map(polygon).collect()
}

fn main() -> Result<(), HullError> {
    let obstacles = polygons()?;
    let (mut times, mut count) = (Vec::new(), 0);
    for _ in 0..15 {
        let start = Instant::now();
        count = combine(&obstacles, 1.0)?.len();
        times.push(1e3 * start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    println!("{} hulls from {}: best {:.1} ms, median {:.1} ms", count, obstacles.len(), times[0], times[7]);
    Ok(())
}
