//! Services between real processes.

#[cfg(test)]
mod common;

use common::Island;

#[test]
fn a_call_made_before_the_server_lives_is_answered() {
    let island = Island::new(37);
    let caller = island.start("caller", "");
    let _talker = island.start("talker", "");
    assert_eq!(caller.line(), "counting from 1");
    assert_eq!(caller.end().0, 0);
}

#[test]
fn a_call_without_a_server_fails_in_time() {
    let (code, lines, _) = Island::new(38).start("caller", "").end();
    assert_eq!((code, lines), (10, vec![]));
}
