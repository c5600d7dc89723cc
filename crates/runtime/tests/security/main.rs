//! DDS Security between processes, in a build with `--features dds-security`: enclaves of one keystore hear each other, nobody else hears
//! them or is heard, and what is on the wire cannot be read.
#![cfg(feature = "dds-security")]

#[cfg(test)]
#[path = "../common/mod.rs"]
mod common;
#[cfg(test)]
mod keystore;
#[cfg(test)]
mod wire;

use common::{Island, Running};
use keystore::Keystore;
use std::time::Duration;

/// Starts an example as an enclave.
fn start(island: &Island, keystore: &Keystore, enclave: &str, example: &str, arguments: &str) -> Running {
    let mut command = island.command(example, &format!("--ros-args --enclave {enclave} {arguments}"));
    command.env("ROS_SECURITY_ENABLE", "true").env("ROS_SECURITY_KEYSTORE", keystore.path());
    Island::run(command)
}

/// What the talker says is followed by so many spaces.
const SPACES: &[u8] = &[b' '; 100];
const SAYS: &str = "-p rate:=100.0 -p padding:=120 -p local:=network";

#[test]
fn enclaves_hear_each_other_and_nobody_can_read_it() {
    let enclaves = ["/talker", "/listener"];
    let keystores = [Keystore::new(&enclaves), Keystore::new(&enclaves).with_encrypted_payloads(&enclaves)];
    for (number, keystore) in keystores.iter().enumerate() {
        let island = Island::new(30 + number as u16);
        let wire = wire::Wire::tap();
        let listener = start(&island, keystore, "/listener", "listener", "");
        let _talker = start(&island, keystore, "/talker", "talker", SAYS);
        let first: u64 = listener.line().split_once(' ').unwrap().1.trim().parse().unwrap();
        for next in first + 1..first + 200 {
            assert!(listener.line().ends_with(&format!(" {next}")), "each once and in order");
        }
        assert!(wire.heard() > 200, "the tap works");
        assert!(!wire.has(SPACES), "messages are on the wire in the open");
    }
}

/// The same without security: the tap finds what it looks for.
#[test]
fn without_security_everybody_can_read_it() {
    let island = Island::new(36);
    let wire = wire::Wire::tap();
    let listener = island.start("listener", "");
    let _talker = island.start("talker", &format!("--ros-args {SAYS}"));
    for _ in 0..100 {
        listener.line();
    }
    assert!(wire.has(SPACES));
}

#[test]
fn strangers_hear_nothing_and_are_not_heard() {
    let (island, keystore) = (Island::new(32), Keystore::new(&["/talker", "/listener"]));
    let foreign = Keystore::new(&["/listener"]);
    let plain = island.start("listener", "");
    let stranger = start(&island, &foreign, "/listener", "listener", "");
    let known = start(&island, &keystore, "/listener", "listener", "");
    let _talker = start(&island, &keystore, "/talker", "talker", "-p rate:=50.0 -p local:=network");
    for _ in 0..200 {
        known.line();
    }
    for (who, deaf) in [("one without security", plain), ("an enclave of another keystore", stranger)] {
        deaf.signal("INT");
        let (code, heard, _) = deaf.end();
        assert_eq!((code, heard), (0, Vec::new()), "{who}");
    }
    let mute = island.start("talker", "--ros-args -r __node:=mute -r chatter:=other -p rate:=100.0 -p local:=network");
    let deaf = start(&island, &keystore, "/listener", "listener", "-r __node:=deaf -r chatter:=other");
    std::thread::sleep(Duration::from_secs(4));
    drop(mute);
    deaf.signal("INT");
    assert_eq!(deaf.end().1, Vec::<String>::new(), "one without security is not heard");
}

#[test]
fn permissions_are_kept_to() {
    let island = Island::new(33);
    let keystore = Keystore::new(&["/talker", "/listener"]).denying("/talker", "rt/secret");
    let refused = start(&island, &keystore, "/talker", "talker", "-r chatter:=secret -p local:=network");
    let (code, _, errors) = refused.end();
    assert!(code == 4 && errors.concat().contains("secret"), "{code} {errors:?}");
}

#[test]
fn services_answer_and_large_messages_pass() {
    let (island, keystore) = (Island::new(34), Keystore::new(&["/talker", "/listener"]));
    let caller = start(&island, &keystore, "/listener", "caller", "");
    let talker = start(&island, &keystore, "/talker", "talker", "--log-level debug");
    talker.wait_for_log("said 1");
    assert_eq!(caller.line(), "counting from 1");
    assert_eq!(caller.end().0, 0);
    drop(talker);
    let listener = start(&island, &keystore, "/listener", "listener", "");
    let _talker = start(&island, &keystore, "/talker", "talker", "-p rate:=5.0 -p padding:=200000 -p local:=network");
    for _ in 0..10 {
        listener.line();
    }
}

#[test]
fn what_is_missing_is_named() {
    let (island, keystore) = (Island::new(35), Keystore::new(&["/talker"]));
    let (code, _, errors) = start(&island, &keystore, "/nobody", "talker", "").end();
    let told = errors.concat();
    assert!(
        code == 2 && told.contains("enclaves/nobody/identity_ca.cert.pem") && told.contains("create_enclave"),
        "{told}"
    );
    std::fs::write(keystore.path().join("enclaves/talker/governance.p7s"), "no governance").unwrap();
    let (code, _, errors) = start(&island, &keystore, "/talker", "talker", "").end();
    let told = errors.concat();
    assert!(code == 4 && told.contains("cannot join DDS domain") && told.contains("enclaves/talker"), "{code} {told}");
}
