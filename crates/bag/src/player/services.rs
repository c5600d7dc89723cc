//! The services of rosbag2's player.

use trench_core::Serve;
use trench_msgs::rosbag2_interfaces::{
    Burst, GetRate, IsPaused, Pause, PlayNext, Resume, Seek, SetRate, Stop, TogglePaused,
};

pub(super) const PAUSE: usize = 0;
pub(super) const RESUME: usize = 1;
pub(super) const TOGGLE_PAUSED: usize = 2;
pub(super) const IS_PAUSED: usize = 3;
pub(super) const PLAY_NEXT: usize = 4;
pub(super) const BURST: usize = 5;
pub(super) const SET_RATE: usize = 6;
pub(super) const GET_RATE: usize = 7;
pub(super) const SEEK: usize = 8;
pub(super) const STOP: usize = 9;

/// In the order of their numbers.
pub(super) fn services() -> Vec<Serve> {
    vec![
        Serve::of::<Pause>("~/pause"),
        Serve::of::<Resume>("~/resume"),
        Serve::of::<TogglePaused>("~/toggle_paused"),
        Serve::of::<IsPaused>("~/is_paused"),
        Serve::of::<PlayNext>("~/play_next"),
        Serve::of::<Burst>("~/burst"),
        Serve::of::<SetRate>("~/set_rate"),
        Serve::of::<GetRate>("~/get_rate"),
        Serve::of::<Seek>("~/seek"),
        Serve::of::<Stop>("~/stop"),
    ]
}
