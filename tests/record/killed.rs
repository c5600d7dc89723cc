//! `kill -9` of a recorder loses a second at most.

use super::{Island, Running, recorded, wait_until, write_texts};
use std::time::Duration;
use trench_bag::BagReader;
use trench_sim::Random;

/// How often a recorder is killed: `TRENCH_KILLS`, twice by default.
fn kills() -> u32 {
    std::env::var("TRENCH_KILLS").map_or(2, |text| text.parse().unwrap())
}

/// ROS time of this machine, ns.
fn now() -> u64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::Realtime);
    now.tv_sec as u64 * 1_000_000_000 + now.tv_nsec as u64
}

#[test]
fn live_a_killed_recorder_loses_a_second_at_most() {
    let island = Island::new(0);
    let played = island.path("played");
    write_texts(&played, 100);
    let _player = Running::start(&mut island.bag(&["play", played.to_str().unwrap(), "--loop"]));
    let mut random = Random::new(std::process::id().into(), 50);
    let mut worst = 0.0;
    for kill in 0..kills() {
        let bag = island.path(&format!("killed_{kill}"));
        let arguments = ["record", bag.to_str().unwrap(), "--topics", "/text:std_msgs/msg/String"];
        let mut recorder = Running::start(&mut island.bag(&arguments));
        // The first file holds a few hundred bytes before the first message.
        wait_until("the recorder hears the player", || recorded(&bag) > 2000);
        std::thread::sleep(Duration::from_secs_f64(random.between(0.0, 1.5)));
        recorder.0.kill().unwrap();
        let killed = now();
        recorder.0.wait().unwrap();

        let reader = BagReader::open(&bag).unwrap();
        let messages: Vec<_> = reader.messages().map(Result::unwrap).collect();
        let lost = killed.saturating_sub(messages.last().unwrap().log_time) as f64 * 1e-9;
        assert!(lost <= 1.0, "kill {kill}: {lost:.3} s lost");
        worst = f64::max(worst, lost);
        assert_eq!(reader.damage().len(), 1, "{:?}", reader.damage());
        assert!(reader.damage()[0].what.contains("ends without a summary"), "{:?}", reader.damage());
        for pair in messages.windows(2) {
            assert!(pair[1].sequence > pair[0].sequence, "kill {kill}: in order, each once");
        }
        std::fs::remove_dir_all(&bag).unwrap();
    }
    println!("worst {worst:.3} s lost by {} kills", kills());
}
