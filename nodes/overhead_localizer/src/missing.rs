//! More robots than pads: who is missing, said once it is no passing matter.

use crate::track::{Status, Track};
use trench_core::Steady;

/// Pads that are missing for so long, s, get a line in the log.
const PATIENCE: f64 = 1.0;

/// Watches for a lack of pads.
#[derive(Debug, Clone, Default)]
pub(crate) struct Missing {
    /// What is lacking, since when, and whether that was said.
    now: Option<(String, Steady, bool)>,
}

impl Missing {
    /// Looks at a frame with this number of pads; gives what is to be said.
    pub(crate) fn look(&mut self, at: Steady, tracks: &[Track], pads: usize) -> Option<String> {
        let Some(shortage) = shortage(tracks, pads) else {
            self.now = None;
            return None;
        };
        match &mut self.now {
            Some((text, since, said)) if *text == shortage => {
                let is_time = !*said && at.seconds_since(*since) >= PATIENCE;
                *said |= is_time;
                is_time.then_some(shortage)
            }
            _ => {
                self.now = Some((shortage, at, false));
                None
            }
        }
    }
}

/// Fewer pads than robots, and a robot that nobody has found: which; nothing while all are found or only just hidden.
pub(crate) fn shortage(tracks: &[Track], pads: usize) -> Option<String> {
    let lost = names(tracks, |track| track.status == Status::Lost);
    if pads >= tracks.len() || lost.is_empty() {
        return None;
    }
    let counts = format!("{} robots, {pads} pads found", tracks.len());
    Some(if tracks.iter().all(|track| track.filter.is_none()) {
        format!("{counts}: names are given when the pads of all of them are seen: {lost}")
    } else {
        format!("{counts}; missing: {lost}")
    })
}

/// The names of the robots that `which` is true of.
pub(crate) fn names(tracks: &[Track], which: impl Fn(&Track) -> bool) -> String {
    let names: Vec<&str> = tracks.iter().filter(|track| which(track)).map(|track| track.name.as_str()).collect();
    names.join(" ")
}
