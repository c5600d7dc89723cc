//! What stands beside each message: the count, the time and the writer, in the serialisation of Zenoh.

use crate::transport::network::Gid;
use rustix::time::{ClockId, clock_gettime};
use zenoh::bytes::ZBytes;

/// Two integers of 64 bits, little endian, and 16 bytes behind their number.
const LENGTH: usize = 8 + 8 + 1 + 16;

/// Where the number of bytes stands.
const PREFIX: usize = 16;

/// Whose message it is, and which. A response repeats those of its request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Attachment {
    pub(super) count: i64,
    pub(super) gid: Gid,
}

impl Attachment {
    /// For a message that is sent now.
    pub(super) fn to_bytes(self) -> ZBytes {
        let now = clock_gettime(ClockId::Realtime);
        self.at(now.tv_sec.saturating_mul(1_000_000_000).saturating_add(now.tv_nsec)).to_vec().into()
    }

    fn at(self, nanoseconds: i64) -> [u8; LENGTH] {
        let mut bytes = [0; LENGTH];
        bytes[..8].copy_from_slice(&self.count.to_le_bytes());
        bytes[8..PREFIX].copy_from_slice(&nanoseconds.to_le_bytes());
        bytes[PREFIX] = self.gid.len() as u8;
        bytes[PREFIX + 1..].copy_from_slice(&self.gid);
        bytes
    }

    /// What a message from the network says; nothing if it is none of ROS.
    pub(super) fn of(attachment: Option<&ZBytes>) -> Option<Self> {
        let bytes = attachment?.to_bytes();
        let bytes: &[u8; LENGTH] = bytes.as_ref().try_into().ok()?;
        let (count, rest) = bytes.split_first_chunk()?;
        let gid = rest.last_chunk()?;
        (usize::from(bytes[PREFIX]) == gid.len()).then_some(Self { count: i64::from_le_bytes(*count), gid: *gid })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_layout_is_that_of_rmw_zenoh() {
        let attachment = Attachment { count: 258, gid: std::array::from_fn(|index| index as u8) };
        let bytes = attachment.at(3);
        let expected = [2, 1, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 16];
        assert_eq!(&bytes[..17], expected);
        assert_eq!(&bytes[17..], attachment.gid);
        assert_eq!(bytes.to_vec(), zenoh_ext::z_serialize(&(258_i64, 3_i64, attachment.gid)).to_bytes().to_vec());
        assert_eq!(Attachment::of(Some(&attachment.to_bytes())), Some(attachment));
    }

    #[test]
    fn what_is_no_attachment_of_ros_is_refused() {
        let mut wrong_length = Attachment { count: 1, gid: [7; 16] }.at(0).to_vec();
        wrong_length[PREFIX] = 15;
        for bytes in [vec![], vec![1, 2, 3], vec![0; LENGTH + 1], wrong_length] {
            assert_eq!(Attachment::of(Some(&bytes.into())), None);
        }
        assert_eq!(Attachment::of(None), None);
    }
}
