//! Figures for people, files for the peers.
use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::time::Instant;

pub(crate) struct Output {
    folder: Option<PathBuf>,
    times: String,
}

impl Output {
    pub(crate) fn new(folder: Option<String>) -> Result<Self, Box<dyn Error>> {
        let folder = folder.map(PathBuf::from);
        if let Some(folder) = &folder {
            fs::create_dir_all(folder)?;
        }
        Ok(Self { folder, times: String::new() })
    }

    /// Best and median of `runs` runs of what takes `times` operations each; both in seconds an operation.
    pub(crate) fn time<R>(&mut self, name: &str, runs: usize, operations: usize, mut run: impl FnMut() -> R) -> R {
        let mut result = run();
        let mut seconds: Vec<f64> = Vec::with_capacity(runs);
        for _ in 0..runs {
            let start = Instant::now();
            result = std::hint::black_box(run());
            seconds.push(start.elapsed().as_secs_f64() / operations as f64);
        }
        seconds.sort_by(f64::total_cmp);
        let (best, median) = (seconds[0], seconds[runs / 2]);
        println!("{name:<44} best {:>10.3} us, median {:>10.3} us of {runs}", 1e6 * best, 1e6 * median);
        self.times.push_str(&format!("{name}\t{best:e}\t{median:e}\n"));
        result
    }

    /// Rows of numbers that another program reads back bit for bit.
    pub(crate) fn rows(&self, name: &str, rows: impl Iterator<Item = Vec<f64>>) -> Result<(), Box<dyn Error>> {
        let Some(folder) = &self.folder else { return Ok(()) };
        let line = |row: Vec<f64>| row.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(" ");
        let text: Vec<String> = rows.map(line).collect();
        Ok(fs::write(folder.join(name), text.join("\n") + "\n")?)
    }

    pub(crate) fn finish(self) -> Result<(), Box<dyn Error>> {
        if let Some(folder) = &self.folder {
            fs::write(folder.join("times.tsv"), &self.times)?;
        }
        Ok(())
    }
}

/// A fraction of 1 from a Weyl sequence with a mixer (splitmix64).
pub(crate) fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut mixed = *state;
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}
