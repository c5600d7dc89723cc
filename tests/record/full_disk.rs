//! A disk that fills up, as a small file system of its own in memory.

use super::{Island, Running, write_texts};
use std::process::{Command, Output};
use trench_bag::{BagReader, Damage};

/// Records /text on a file system of `size` in a namespace of its own until the recorder gives up, after `meanwhile`;
/// gives what was said and copies the bag to where it outlives the file system.
fn record_on(island: &Island, size: &str, meanwhile: &str) -> (String, std::path::PathBuf) {
    let (mount, copy) = (island.path("disk"), island.path("copy"));
    std::fs::create_dir(&mount).unwrap();
    let script = format!(
        r#"set -e
        mount -t tmpfs -o size={size} tmpfs "$1"
        "$2" bag record "$1/bag" --topics /text:std_msgs/msg/String &
        {meanwhile}
        code=0; wait $! || code=$?
        echo "exit code $code"
        cp -r "$1/bag" "$3""#
    );
    let trench = env!("CARGO_BIN_EXE_trench");
    // With a user's namespace where we are not root anyway.
    let flags = if rustix::process::getuid().is_root() { "-m" } else { "-rm" };
    let mut command = Command::new("unshare");
    command.args([flags, "sh", "-c", &script, "sh"]).arg(&mount).arg(trench).arg(&copy);
    for (name, value) in island.command("trench").get_envs() {
        command.env(name, value.unwrap());
    }
    let Output { status, stdout, stderr } = command.output().unwrap();
    let said = String::from_utf8_lossy(&stdout).into_owned() + &String::from_utf8_lossy(&stderr);
    assert!(status.success(), "{said}");
    (said, copy)
}

fn player(island: &Island) -> Running {
    let played = island.path("played");
    write_texts(&played, 30_000);
    Running::start(&mut island.bag(&["play", played.to_str().unwrap(), "--loop"]))
}

#[test]
fn live_a_full_disk_ends_the_recording_with_a_whole_bag() {
    let island = Island::new(1);
    let _player = player(&island);
    let (said, bag) = record_on(&island, "12m", "");
    assert!(said.contains("exit code 1"), "{said}");
    assert!(said.contains("the disk is full (") && said.contains("what was recorded before is readable"), "{said}");
    let reader = BagReader::open(&bag).unwrap();
    assert_eq!(reader.damage(), [] as [Damage; 0]);
    assert!(bag.join("metadata.yaml").exists());
    // 12 MiB less the reserve of 4 MiB, of texts that shrink by a sixth.
    let bytes: usize = reader.messages().map(|message| message.unwrap().len()).sum();
    assert!(bytes > 6 << 20, "{bytes} bytes in {} messages", reader.message_count());
    println!("{} messages, {bytes} bytes, on a disk of 12 MiB", reader.message_count());
}

#[test]
fn live_a_disk_that_others_fill_leaves_a_readable_bag() {
    let island = Island::new(2);
    let _player = player(&island);
    // As soon as something is recorded, somebody takes all the rest at once.
    let filler = r#"
        until [ "$(du -sk "$1/bag" 2>/dev/null | cut -f 1)" -gt 500 ] 2>/dev/null; do sleep 0.1; done
        head -c 100m /dev/zero > "$1/filler" 2>/dev/null || true"#;
    let (said, bag) = record_on(&island, "24m", filler);
    assert!(said.contains("exit code 1"), "{said}");
    assert!(said.contains("the disk is full (") && said.contains("what was recorded before is readable"), "{said}");
    let reader = BagReader::open(&bag).unwrap();
    let count = reader.messages().map(Result::unwrap).count();
    assert!(count > 15, "{count} messages");
    println!("{count} messages; {:?}", reader.damage());
}
