//! A file whose data agree with their checksum is opened without decompressing it; that must not show.

use crate::common::{Written, finished, mcap_file, read_all};
use std::fs;
use std::path::{Path, PathBuf};
use trench_bag::{BagError, BagReader};

/// Where the record that ends the data begins, with the checksum behind its nine bytes.
fn data_end(bytes: &[u8]) -> usize {
    let summary = bytes.len() - 8 - 20;
    u64::from_le_bytes(bytes[summary..summary + 8].try_into().unwrap()) as usize - 13
}

/// Writes a bag's only file again with another checksum: zero says that nobody computed one.
fn with_checksum(bytes: &[u8], checksum: u32, path: &Path) -> BagReader {
    let at = data_end(bytes) + 9;
    let bytes = [&bytes[..at], &checksum.to_le_bytes(), &bytes[at + 4..]].concat();
    fs::write(path, bytes).unwrap();
    BagReader::open(path).unwrap()
}

fn bag(folder: &Path) -> (PathBuf, Vec<Written>) {
    let written = finished(&folder.join("bag"), 300).unwrap();
    (mcap_file(&folder.join("bag")), written)
}

#[test]
fn a_file_without_a_checksum_is_read_as_one_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let (path, written) = bag(folder.path());
    let bytes = fs::read(&path).unwrap();
    let end = data_end(&bytes);
    let checksum = u32::from_le_bytes(bytes[end + 9..end + 13].try_into().unwrap());
    assert_eq!(checksum, crc32fast::hash(&bytes[..end]), "the writer computes it");
    let vouched = BagReader::open(&path).unwrap();
    let doubted = with_checksum(&bytes, 0, &folder.path().join("doubted.mcap"));
    assert_eq!(vouched.topics(), doubted.topics());
    assert_eq!(vouched.span(), doubted.span());
    assert_eq!((vouched.damage(), doubted.damage()), (&[][..], &[][..]));
    assert_eq!(vouched.longest().unwrap(), doubted.longest().unwrap());
    assert_eq!(vouched.longest().unwrap().into_iter().max(), written.iter().map(|message| message.cdr.len()).max());
    assert_eq!(read_all(&vouched).unwrap(), written);
    assert_eq!(read_all(&doubted).unwrap(), written);
}

#[test]
fn a_false_word_for_a_damaged_chunk_shows_when_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let (path, written) = bag(folder.path());
    let mut bytes = fs::read(&path).unwrap();
    let end = data_end(&bytes);
    bytes[end / 2] ^= 1;
    let reader = with_checksum(&bytes, crc32fast::hash(&bytes[..end]), &path);
    let mut intact = 0;
    for message in reader.messages() {
        match message {
            Ok(message) => {
                assert_eq!(*message, written[intact].cdr);
                intact += 1;
            }
            Err(error) => {
                assert!(matches!(error, BagError::Changed { .. }), "{error}");
                assert!(error.to_string().contains("is not what the file says of it"), "{error}");
            }
        }
    }
    assert!((1..written.len()).contains(&intact), "{intact}");
    // Whoever wants what is left looks into every chunk.
    let examined = BagReader::examine(&path).unwrap();
    assert!(examined.damage().iter().any(|damage| damage.what.contains("its messages are lost")));
    let left = read_all(&examined).unwrap();
    assert!(left.len() > intact && left.iter().all(|message| written.contains(message)), "{}", left.len());
}
