//! The key that base and robots share, and the tag it makes.

use siphasher::sip::SipHasher24;
use std::hash::Hasher;

/// Bytes of a tag.
pub(crate) const TAG_LENGTH: usize = 8;

/// A 128-bit key. Packets are authenticated by their 64-bit SipHash-2-4 under it.
#[derive(Clone, PartialEq, Eq)]
pub struct Key([u8; 16]);

/// Why a text is not a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a key is 32 hexadecimal digits")]
pub struct KeyError;

impl Key {
    /// A key from its bytes.
    #[must_use]
    pub fn new(bytes: [u8; 16]) -> Self {
        Self(bytes)
    }

    /// A key from 32 hexadecimal digits, white space around them ignored.
    ///
    /// # Errors
    /// When the text is anything else.
    pub fn from_hex(text: &str) -> Result<Self, KeyError> {
        let digits = text.trim().as_bytes();
        if digits.len() != 32 {
            return Err(KeyError);
        }
        let mut bytes = [0; 16];
        for (byte, pair) in bytes.iter_mut().zip(digits.chunks_exact(2)) {
            let digit = |index: usize| char::from(pair[index]).to_digit(16).ok_or(KeyError);
            *byte = (digit(0)? << 4 | digit(1)?) as u8;
        }
        Ok(Self(bytes))
    }

    /// The tag of a packet's bytes: `head` and `body` one after the other.
    pub(crate) fn tag(&self, head: &[u8], body: &[u8]) -> [u8; TAG_LENGTH] {
        let mut hasher = SipHasher24::new_with_key(&self.0);
        hasher.write(head);
        hasher.write(body);
        hasher.finish().to_le_bytes()
    }
}

/// A key is never printed.
impl std::fmt::Debug for Key {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Key(..)")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tag_of_the_siphash_paper() {
        // Aumasson and Bernstein, SipHash, appendix A: key 00..0f, message 00..0e.
        let key = Key::new(std::array::from_fn(|index| index as u8));
        let message: [u8; 15] = std::array::from_fn(|index| index as u8);
        assert_eq!(key.tag(&message[..4], &message[4..]), 0xa129_ca61_49be_45e5_u64.to_le_bytes());
    }

    #[test]
    fn keys_from_text() {
        let key = Key::new(std::array::from_fn(|index| index as u8));
        assert_eq!(Key::from_hex("000102030405060708090A0b0c0d0e0f\n"), Ok(key));
        for text in
            ["", "00", "000102030405060708090a0b0c0d0e0", "g00102030405060708090a0b0c0d0e0f", "äöäöäöäöäöäöäöäö"]
        {
            assert_eq!(Key::from_hex(text), Err(KeyError), "{text}");
        }
    }
}
