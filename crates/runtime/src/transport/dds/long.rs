//! Responses that are longer than a datagram of an Ethernet.
//!
//! RustDDS 0.15.1 cuts such messages into fragments and garbles those that carry inline quality of service, which is where
//! a response says whom it answers. So such a response goes out whole as one RTPS message of our own, under its writer's name
//! and next number; the kernel cuts it up and puts it together (IP fragments). The writer then says something short
//! under the same number, which a reader that has got the response drops as a copy, and which answers nobody for one that
//! has not: its client asks again, as after any response that was lost.

use super::rtps::{
    DATA, HAS_DATA, HAS_INLINE_QOS, INFO_DST, PREFIX, RELATED_SAMPLE_IDENTITY, RELATED_SAMPLE_IDENTITY_CUSTOM,
    SENTINEL, header, sequence_number, submessage,
};
use rustdds::GUID;
use rustdds::SampleIdentity;
use std::net::{SocketAddr, UdpSocket};

/// What a UDP datagram takes with all headers, bytes, rounded down.
pub(super) const LONGEST: usize = 65_000;

/// What the writer says itself: an empty structure, after the four bytes that name the encoding.
pub(super) const PLACEHOLDER: &[u8] = &[0, 1, 0, 0, 0, 0, 0, 0];

/// A sample that a writer is to send.
pub(super) struct Sample<'a> {
    pub(super) writer: GUID,
    /// The writer's count.
    pub(super) number: u64,
    /// The request that it answers.
    pub(super) related: SampleIdentity,
    /// With the four bytes that name the encoding.
    pub(super) cdr: &'a [u8],
}

/// Sends a sample to a reader at all its addresses. Each gets it twice: nobody repeats it.
pub(super) fn send(
    sample: &Sample<'_>,
    reader: GUID,
    addresses: impl Iterator<Item = SocketAddr>,
) -> std::io::Result<()> {
    let message = message(sample, reader);
    for address in addresses {
        let any = if address.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" };
        let socket = UdpSocket::bind(any)?;
        for _ in 0..2 {
            socket.send_to(&message, address)?;
        }
    }
    Ok(())
}

/// An RTPS message (RTPS 2.5, 8.3.7 and 9.4): header, destination, sample with inline quality of service. Little-endian.
fn message(sample: &Sample<'_>, reader: GUID) -> Vec<u8> {
    let (writer, reader) = (sample.writer.to_bytes(), reader.to_bytes());
    let (writer_prefix, writer_id) = writer.split_at(PREFIX);
    let (reader_prefix, reader_id) = reader.split_at(PREFIX);
    let mut message = Vec::with_capacity(128 + sample.cdr.len());
    header(&mut message, writer_prefix);
    submessage(&mut message, INFO_DST, 0, reader_prefix);
    let mut data = Vec::with_capacity(64 + sample.cdr.len());
    data.extend([0; 2]); // extra flags
    data.extend(16_u16.to_le_bytes()); // bytes from here to the inline quality of service
    data.extend(reader_id);
    data.extend(writer_id);
    data.extend(sequence_number(i64::try_from(sample.number).unwrap_or(i64::MAX)));
    for parameter in [RELATED_SAMPLE_IDENTITY, RELATED_SAMPLE_IDENTITY_CUSTOM] {
        data.extend(parameter.to_le_bytes());
        data.extend(24_u16.to_le_bytes());
        data.extend(sample.related.writer_guid.to_bytes());
        data.extend(sequence_number(sample.related.sequence_number.into()));
    }
    data.extend(SENTINEL.to_le_bytes());
    data.extend([0; 2]);
    data.extend(sample.cdr);
    data.resize(data.len().next_multiple_of(4), 0);
    submessage(&mut message, DATA, HAS_INLINE_QOS | HAS_DATA, &data);
    message
}

#[cfg(test)]
mod tests {
    use super::{Sample, message};
    use rustdds::{GUID, SampleIdentity, SequenceNumber};

    #[test]
    fn the_message_is_as_the_standard_writes_it() {
        let guid = |first: u8| GUID::from_bytes(std::array::from_fn(|index| first + index as u8));
        let related =
            SampleIdentity { writer_guid: guid(0x60), sequence_number: SequenceNumber::from(0x1_0000_0002_i64) };
        let sample = Sample { writer: guid(0x20), number: 7, related, cdr: &[0, 1, 0, 0, 9] };
        let bytes = message(&sample, guid(0x40));
        let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        let expected = concat!(
            "52545053",
            "0204",
            "0112",
            "202122232425262728292a2b",
            "0e010c00",
            "404142434445464748494a4b",
            "15075800",
            "0000",
            "1000",
            "4c4d4e4f",
            "2c2d2e2f",
            "0000000007000000",
            "83001800",
            "606162636465666768696a6b6c6d6e6f",
            "0100000002000000",
            "0f801800",
            "606162636465666768696a6b6c6d6e6f",
            "0100000002000000",
            "01000000",
            "0001000009000000",
        );
        assert_eq!(hex, expected);
    }
}
