//! Figures for people, files for the peers.
use super::files::Files;
use std::error::Error;
use std::time::Instant;

pub(crate) struct Output {
    files: Files,
    times: String,
}

impl Output {
    pub(crate) fn new(folder: Option<String>) -> Result<Self, Box<dyn Error>> {
        Ok(Self { files: Files::new(folder)?, times: String::new() })
    }

    /// Best and median of `runs` runs of what takes `times` operations each; both in seconds an operation.
    pub(crate) fn time<R>(&mut self, name: &str, runs: usize, operations: usize, mut run: impl FnMut() -> R) -> R {
        let mut result = run();
        let mut seconds: Vec<f64> = Vec::with_capacity(runs);
        for _ in 0..runs {
            let start = Instant::now();
            let made = std::hint::black_box(run());
            seconds.push(start.elapsed().as_secs_f64() / operations as f64);
            // To drop the one before is not of the operation.
            result = made;
        }
        seconds.sort_by(f64::total_cmp);
        let (best, median) = (seconds[0], seconds[runs / 2]);
        println!("{name:<44} best {:>10.3} us, median {:>10.3} us of {runs}", 1e6 * best, 1e6 * median);
        self.times.push_str(&format!("{name}\t{best:e}\t{median:e}\n"));
        result
    }

    /// Rows of numbers that another program reads back bit for bit.
    pub(crate) fn rows(&self, name: &str, rows: impl Iterator<Item = Vec<f64>>) -> Result<(), Box<dyn Error>> {
        self.files.rows(name, rows)
    }

    pub(crate) fn finish(self) -> Result<(), Box<dyn Error>> {
        self.files.text("times.tsv", &self.times)
    }
}
