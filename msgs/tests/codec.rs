//! The codec of every type, against an independent writer of CDR.

#[cfg(test)]
mod support;

use support::{Random, Writer, library};
use trench_msgs::dynamic::Schema;
use trench_msgs::{Message, for_every_message};

const SEEDS: std::ops::Range<u64> = 0..12;

#[test]
fn both_byte_orders_are_read_and_written_little_endian() {
    fn check<M: Message>() {
        let library = library::<M>();
        for seed in SEEDS {
            let (little, _) = Writer::message(&library, M::TYPE.name, seed, false);
            let (big, _) = Writer::message(&library, M::TYPE.name, seed, true);
            let message = M::decode(&little).unwrap_or_else(|error| panic!("{}: {error}", M::TYPE.name));
            assert_eq!(M::decode(&big).as_ref(), Ok(&message));
            assert_eq!(message.encoded_len(), little.len(), "{}", M::TYPE.name);
            assert_eq!(message.to_cdr(), little, "{}", M::TYPE.name);
        }
    }
    for_every_message!(check);
}

#[test]
fn run_time_decoding_finds_every_value() {
    fn check<M: Message>() {
        let library = library::<M>();
        let schema = Schema::parse(M::TYPE.name, M::TYPE.definition).expect("our own definitions are understood");
        for (seed, big_endian) in SEEDS.flat_map(|seed| [(seed, false), (seed, true)]) {
            let (cdr, value) = Writer::message(&library, M::TYPE.name, seed, big_endian);
            assert_eq!(schema.decode(&cdr).as_ref(), Ok(&value), "{}", M::TYPE.name);
        }
    }
    for_every_message!(check);
}

#[test]
fn defaults_survive_the_wire() {
    fn check<M: Message>() {
        assert_eq!(M::decode(&M::default().to_cdr()), Ok(M::default()));
    }
    for_every_message!(check);
}

#[test]
fn every_truncation_is_an_error() {
    fn check<M: Message>() {
        let library = library::<M>();
        let schema = Schema::parse(M::TYPE.name, M::TYPE.definition).expect("our own definitions are understood");
        let (cdr, _) = Writer::message(&library, M::TYPE.name, 3, false);
        for length in 0..cdr.len() {
            assert!(M::decode(&cdr[..length]).is_err(), "{} of {length} bytes", M::TYPE.name);
            assert!(schema.decode(&cdr[..length]).is_err(), "{} of {length} bytes", M::TYPE.name);
        }
    }
    for_every_message!(check);
}

#[test]
fn what_does_not_fit_is_not_written() {
    fn check<M: Message>() {
        let (cdr, _) = Writer::message(&library::<M>(), M::TYPE.name, 5, false);
        let message = M::decode(&cdr).expect("valid");
        for length in 0..=cdr.len() {
            let mut out = vec![0xaa; cdr.len() + 3];
            let written = message.encode_into(&mut out[..length]);
            assert!(written <= length);
            assert_eq!(out[..written], cdr[..written]);
            assert!(out[written..].iter().all(|byte| *byte == 0xaa));
            assert_eq!(written == cdr.len(), length == cdr.len());
        }
    }
    for_every_message!(check);
}

/// Any four bytes may be a length: all become huge, just too great, and absurdly many empty elements in turn. A decoder
/// that believed them would ask for gigabytes and this test would be killed or take minutes.
#[test]
fn damaged_messages_neither_panic_nor_ask_for_memory() {
    fn check<M: Message>() {
        let library = library::<M>();
        let schema = Schema::parse(M::TYPE.name, M::TYPE.definition).expect("our own definitions are understood");
        let mut random = Random(11);
        let (cdr, _) = Writer::message(&library, M::TYPE.name, 7, false);
        for at in (0..cdr.len().saturating_sub(3)).step_by(4) {
            for patch in [u32::MAX, 0x7fff_ffff, 0x1000_0000, cdr.len() as u32, random.next() as u32] {
                let mut damaged = cdr.clone();
                damaged[at..at + 4].copy_from_slice(&patch.to_le_bytes());
                damaged[random.next() as usize % cdr.len()] ^= 1 << (random.next() % 8);
                // What can still be read must come out again; NaNs are compared as bytes.
                let typed = M::decode(&damaged);
                if let Ok(message) = &typed {
                    let again = M::decode(&message.to_cdr()).expect("our own bytes are valid");
                    assert_eq!(again.to_cdr(), message.to_cdr());
                }
                assert_eq!(typed.is_ok(), schema.decode(&damaged).is_ok(), "{}", M::TYPE.name);
            }
        }
    }
    for_every_message!(check);
}
