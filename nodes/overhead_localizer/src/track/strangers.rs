//! Pads that no robot was expected to carry: the first ones, and those of robots that were carried away.

use super::assignment::assign;
use super::pairing::Pair;
use super::settings::{Names, Settings};
use super::tracker::Track;
use nalgebra::Matrix3;
use trench_msgs::msg::TeamState;
use trench_optics::Pose2;

/// For so many frames the same number of strangers must be seen before they are given names.
const PATIENCE: u32 = 3;
/// Longer than any field, m.
const FAR: f64 = 1e3;

/// Pads without a robot, waiting to be believed.
#[derive(Debug, Clone, Default)]
pub(super) struct Strangers {
    count: usize,
    frames: u32,
}

impl Strangers {
    /// Gives strangers the names of missing robots (unseen for more than the hold time).
    ///
    /// If no robot has a place yet, the names go by order of the pads' x: in doubt, or, if the settings say so, for good as
    /// soon as all robots are there. The last missing robot is recognised as such. Otherwise names go to the nearest, and
    /// all of them are in doubt.
    pub(super) fn place(
        &mut self,
        tracks: &mut [Track],
        pairs: &[Pair],
        settings: &Settings,
        measurement: &Matrix3<f64>,
    ) {
        self.frames = if pairs.len() == self.count { self.frames.saturating_add(1) } else { 1 };
        self.count = pairs.len();
        if self.frames < PATIENCE || pairs.is_empty() {
            return;
        }
        if tracks.iter().all(|track| track.filter.is_none()) {
            let in_doubt = settings.names != Names::Order;
            // `pairs` come ordered by x.
            if in_doubt || pairs.len() == tracks.len() {
                for (track, pair) in tracks.iter_mut().zip(pairs) {
                    track.put(pair, measurement);
                    track.in_doubt = in_doubt;
                }
            }
            return;
        }
        let missing: Vec<usize> = (0..tracks.len()).filter(|index| tracks[*index].is_missing(settings.hold)).collect();
        let certain = missing.len() == 1 && pairs.len() == 1;
        let distance = |track: &Track, pair: &Pair| {
            let pose = track.filter.as_ref().map(|filter| filter.state().pose).unwrap_or_default();
            libm::hypot(pose.x - pair.pose.x, pose.y - pair.pose.y)
        };
        let matched = assign(missing.len(), pairs.len(), |row, column| {
            Some(FAR - distance(&tracks[missing[row]], &pairs[column]))
        });
        for (row, column) in matched.iter().enumerate() {
            if let Some(column) = *column {
                let track = &mut tracks[missing[row]];
                track.put(&pairs[column], measurement);
                track.in_doubt = !certain;
            }
        }
    }
}

/// Where pads of no robot are, m: those of `pads` that are not within `body`, m, of where one of `tracks` is seen, since no two
/// bodies are in one place.
pub(super) fn unnamed(tracks: &[Track], pads: &[Pair], body: f64) -> Vec<[f64; 2]> {
    let seen = tracks.iter().filter(|track| track.unseen == 0.0).filter_map(|track| track.filter.as_ref());
    let places: Vec<Pose2> = seen.map(|filter| filter.state().pose).collect();
    let apart = |pad: &Pose2| places.iter().all(|robot| libm::hypot(robot.x - pad.x, robot.y - pad.y) > body);
    let apart = pads.iter().map(|pair| pair.pose).filter(apart);
    apart.take(usize::from(TeamState::MOST_UNNAMED)).map(|pose| [pose.x, pose.y]).collect()
}
