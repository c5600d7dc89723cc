//! Asks the system to keep its processors awake for a while (PM QoS, `/dev/cpu_dma_latency`).

use std::fs::{File, OpenOptions};
use std::io::Write;
use trench_core::Steady;

const DEVICE: &str = "/dev/cpu_dma_latency";

/// The longest time to wake that is allowed, us: none.
const AT_ONCE: i32 = 0;
/// What the kernel takes for no wish at all.
const ANY: i32 = 2_000_000_000;

/// A wish that holds for all processors of the host until it is taken back, or this process ends.
#[derive(Debug)]
pub(crate) struct LatencyRequest {
    device: File,
    held: Option<(Steady, Steady)>,
}

impl LatencyRequest {
    /// Nothing is wished yet. `None` where the system does not allow it: it does to root and to whom the device was given.
    pub(crate) fn open() -> Option<Self> {
        Self::of(DEVICE)
    }

    fn of(path: &str) -> Option<Self> {
        let device = OpenOptions::new().write(true).open(path).ok()?;
        let mut request = Self { device, held: None };
        request.write(ANY);
        Some(request)
    }

    /// No processor goes to sleep from `now` until [`LatencyRequest::release`], which is to be called at `until` at the latest.
    pub(crate) fn hold(&mut self, now: Steady, until: Steady) {
        if self.held.replace((now, until)).is_none() {
            self.write(AT_ONCE);
        }
    }

    /// Since when something is held, and when to release it.
    pub(crate) fn held(&self) -> Option<(Steady, Steady)> {
        self.held
    }

    /// They may sleep again.
    pub(crate) fn release(&mut self) {
        if self.held.take().is_some() {
            self.write(ANY);
        }
    }

    fn write(&mut self, microseconds: i32) {
        // Without it they wake more slowly, no more.
        let _best_effort = self.device.write_all(&microseconds.to_ne_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn each_wish_is_said_once_and_taken_back_once() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let mut request = LatencyRequest::of(file.path().to_str().unwrap()).unwrap();
        request.release();
        request.hold(Steady(1), Steady(5));
        request.hold(Steady(2), Steady(6));
        assert_eq!(request.held(), Some((Steady(2), Steady(6))));
        request.release();
        request.release();
        assert_eq!(request.held(), None);
        let written: Vec<i32> = fs::read(file.path())
            .unwrap()
            .chunks_exact(4)
            .map(|bytes| i32::from_ne_bytes(bytes.try_into().unwrap()))
            .collect();
        assert_eq!(written, [ANY, AT_ONCE, ANY]);
    }

    #[test]
    fn where_there_is_no_device_there_is_no_wish() {
        assert!(LatencyRequest::of("/nowhere/cpu_dma_latency").is_none());
    }
}
