//! Services: calls before the server lives, and without one.

use crate::{Network, on_every_network};

on_every_network! {
    a_call_made_before_the_server_lives_is_answered
    a_call_without_a_server_fails_in_time
    a_second_server_answers_after_the_first_died
}

fn a_call_made_before_the_server_lives_is_answered(network: Network) {
    let island = network.island(37);
    let caller = island.start("caller", "");
    let _talker = island.start("talker", "");
    assert_eq!(caller.line(), "counting from 1");
    assert_eq!(caller.end().0, 0);
}

fn a_call_without_a_server_fails_in_time(network: Network) {
    let (code, lines, _) = network.island(38).start("caller", "").end();
    assert_eq!((code, lines), (10, vec![]));
}

fn a_second_server_answers_after_the_first_died(network: Network) {
    let island = network.island(39);
    for _life in 0..2 {
        let talker = island.start("talker", "");
        let caller = island.start("caller", "");
        assert_eq!(caller.line(), "counting from 1");
        assert_eq!(caller.end().0, 0);
        talker.signal("KILL");
        talker.end();
    }
}
