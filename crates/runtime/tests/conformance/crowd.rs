//! Many processes that start at once, some of which read what they find: none locks up while it opens what others look for, and
//! all find each other.

use crate::common::Running;
use crate::{Network, on_every_network};

on_every_network! {
    processes_that_start_at_once_find_each_other_and_end_when_asked
}

/// As many processes as a launched pursuit has, each with ten topics that all of them write and read.
const PROCESSES: usize = 14;
/// So many of them open subscriptions when they learn who writes, while others still start.
const RECORDERS: usize = 4;

fn processes_that_start_at_once_find_each_other_and_end_when_asked(network: Network) {
    for round in 0..3 {
        let island = network.island(40 + round);
        let crowd: Vec<Running> = (0..PROCESSES)
            .map(|number| {
                let discovers = number < RECORDERS;
                let given = format!("--ros-args -r __node:=c{number} -p peers:={PROCESSES} -p discovers:={discovers}");
                island.start("crowd", &given)
            })
            .collect();
        for process in &crowd {
            assert_eq!(process.line(), "all");
        }
        for process in crowd {
            process.signal("INT");
            let (code, _, errors) = process.end();
            assert_eq!(code, 0, "round {round}: {errors:?}");
        }
    }
}
