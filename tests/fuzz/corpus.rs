//! What is right: the repository's own files, and the vectors of the radio protocol.

use std::path::{Path, PathBuf};
use trench_bag::BagReader;

pub(crate) fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The contents of all files below `folder` whose names end so, in order of name; none where there is no such folder.
pub(crate) fn files(folder: &Path, ending: &str) -> Vec<Vec<u8>> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let read = |path: PathBuf| match path.is_dir() {
        true => files(&path, ending),
        false if path.to_string_lossy().ends_with(ending) => vec![std::fs::read(path).unwrap()],
        false => Vec::new(),
    };
    paths.into_iter().flat_map(read).collect()
}

/// Those of a folder of the repository.
pub(crate) fn texts(folder: &str, ending: &str) -> Vec<Vec<u8>> {
    files(&root().join(folder), ending)
}

/// The golden journals.
pub(crate) fn bags() -> Vec<Vec<u8>> {
    files(&root().join("tests/bags"), ".mcap")
}

/// The first messages of each of them, not compressed: what is changed in there is still a chunk.
pub(crate) fn open_bags() -> Vec<Vec<u8>> {
    let opened = |bag: Vec<u8>| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        let options = mcap::WriteOptions::new().compression(None).profile("ros2");
        let mut writer = options.create(&mut bytes).unwrap();
        for message in mcap::MessageStream::new(&bag).unwrap().take(200) {
            writer.write(&message.unwrap()).unwrap();
        }
        writer.finish().unwrap();
        drop(writer);
        bytes.into_inner()
    };
    bags().into_iter().map(opened).collect()
}

/// Test vectors of docs/protocols/radio.md.
pub(crate) fn radio() -> Vec<Vec<u8>> {
    let page = std::fs::read_to_string(root().join("docs/protocols/radio.md")).unwrap();
    let bytes = |cell: &str| -> Option<Vec<u8>> {
        cell.trim().trim_matches('`').split(' ').map(|byte| u8::from_str_radix(byte, 16).ok()).collect()
    };
    page.lines().filter_map(|line| bytes(line.split('|').nth(2)?)).filter(|vector| vector.len() > 10).collect()
}

/// Messages of the golden journals, one of each topic and every fiftieth.
pub(crate) fn messages() -> Vec<Vec<u8>> {
    let mut messages = Vec::new();
    for run in ["square", "triangle"] {
        for entry in std::fs::read_dir(root().join("tests/bags").join(run)).unwrap() {
            let bag = BagReader::open(&entry.unwrap().path()).unwrap();
            let mut seen = vec![0; bag.topics().len()];
            for message in bag.messages().flatten() {
                if seen[message.topic] % 50 == 0 {
                    messages.push(message.to_vec());
                }
                seen[message.topic] += 1;
            }
        }
    }
    messages.sort();
    messages
}
