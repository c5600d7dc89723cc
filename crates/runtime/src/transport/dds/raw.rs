//! CDR bytes in and out of RustDDS untouched: the message was encoded once, before it got here.

use rustdds::RepresentationIdentifier;
use rustdds::bytes::Bytes;
use rustdds::no_key::{Decode, DefaultDecoder, DeserializerAdapter, SerializerAdapter};

/// Length of the encapsulation header in front of every message.
pub(crate) const HEADER: usize = 4;

/// The second byte of the encapsulation header says which end of a number comes first.
const BIG_ENDIAN: [u8; HEADER] = [0, 0, 0, 0];
pub(super) const LITTLE_ENDIAN: [u8; HEADER] = [0, 1, 0, 0];

const READABLE: [RepresentationIdentifier; 2] = [RepresentationIdentifier::CDR_LE, RepresentationIdentifier::CDR_BE];

/// A message with its encapsulation header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RawMessage(pub(crate) Bytes);

impl RawMessage {
    /// With zeros behind it, to whole words. RustDDS 0.15.1 cannot read encrypted payloads that are none: RTPS fills them up, and the filling
    /// is taken for a part of what was encrypted. Readers of CDR pass over what is behind a message.
    pub(super) fn in_whole_words(self) -> Self {
        let length = self.0.len().next_multiple_of(4);
        if length == self.0.len() {
            return self;
        }
        let mut message = Vec::with_capacity(length);
        message.extend_from_slice(&self.0);
        message.resize(length, 0);
        Self(message.into())
    }
}

/// Hands bytes through in both directions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RawAdapter;

/// Nothing can go wrong when bytes stay bytes.
#[derive(Debug, thiserror::Error)]
#[error("bytes cannot be copied")]
pub(crate) struct RawError;

impl SerializerAdapter<RawMessage> for RawAdapter {
    type Error = RawError;

    fn output_encoding() -> RepresentationIdentifier {
        RepresentationIdentifier::CDR_LE
    }

    fn to_bytes(message: &RawMessage) -> Result<Bytes, RawError> {
        // RustDDS writes the header itself.
        Ok(message.0.slice(HEADER.min(message.0.len())..))
    }
}

impl DeserializerAdapter<RawMessage> for RawAdapter {
    type Error = RawError;
    type Decoded = RawMessage;

    fn supported_encodings() -> &'static [RepresentationIdentifier] {
        &READABLE
    }

    fn transform_decoded(decoded: RawMessage) -> RawMessage {
        decoded
    }
}

impl DefaultDecoder<RawMessage> for RawAdapter {
    type Decoder = Self;
    const DECODER: Self = Self;
}

impl Decode<'_, RawMessage> for RawAdapter {
    type Error = RawError;

    fn decode_bytes(self, body: &[u8], encoding: RepresentationIdentifier) -> Result<RawMessage, RawError> {
        let header = if encoding == RepresentationIdentifier::CDR_BE { BIG_ENDIAN } else { LITTLE_ENDIAN };
        let mut message = Vec::with_capacity(HEADER + body.len());
        message.extend_from_slice(&header);
        message.extend_from_slice(body);
        Ok(RawMessage(Bytes::from(message)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_come_back_as_they_were_sent() {
        let message = RawMessage(Bytes::from_static(&[0, 1, 0, 0, 7, 8, 9]));
        let body = RawAdapter::to_bytes(&message).unwrap();
        assert_eq!(&body[..], [7, 8, 9]);
        assert_eq!(RawAdapter.decode_bytes(&body, RepresentationIdentifier::CDR_LE).unwrap(), message);
        let big = RawAdapter.decode_bytes(&body, RepresentationIdentifier::CDR_BE).unwrap();
        assert_eq!(&big.0[..], [0, 0, 0, 0, 7, 8, 9]);
    }

    #[test]
    fn words_are_filled_up() {
        for (said, expected) in [(&[1, 2, 3, 4][..], &[1, 2, 3, 4][..]), (&[1, 2, 3, 4, 5], &[1, 2, 3, 4, 5, 0, 0, 0])]
        {
            assert_eq!(RawMessage(Bytes::from(said.to_vec())).in_whole_words().0, expected);
        }
    }

    #[test]
    fn a_message_without_a_header_is_an_empty_body() {
        assert!(RawAdapter::to_bytes(&RawMessage(Bytes::from_static(&[1]))).unwrap().is_empty());
    }
}
