//! What every message and service type can do.

use crate::cdr::CdrError;

/// A message type as the network and bags name it.
#[derive(Debug, PartialEq, Eq)]
pub struct TypeInfo {
    /// For example `trench_msgs/msg/TeamState`.
    pub name: &'static str,
    /// The RIHS01 hash of the type description (REP-2016), `RIHS01_` and 64 hexadecimal digits.
    pub hash: &'static str,
    /// The definition as bags carry it (`ros2msg`): the .msg text, then each dependency behind a line of 80 `=` and a
    /// line `MSG: package/Type`.
    pub definition: &'static str,
}

/// A message that can be written as CDR. Object safe: publishers take `&dyn Encode`.
pub trait Encode {
    /// The type on the wire.
    fn type_info(&self) -> &'static TypeInfo;

    /// The number of bytes that [`Encode::encode_into`] writes, the four bytes of the encapsulation header included.
    fn encoded_len(&self) -> usize;

    /// Writes header (`00 01 00 00`: CDR, little endian) and body into the front of `out` and gives the number of bytes
    /// written. `out` must hold at least [`Encode::encoded_len`] bytes; what does not fit is not written.
    fn encode_into(&self, out: &mut [u8]) -> usize;

    /// Header and body in a new vector.
    fn to_cdr(&self) -> Vec<u8> {
        let mut out = vec![0; self.encoded_len()];
        let written = self.encode_into(&mut out);
        out.truncate(written);
        out
    }
}

/// An owned message type.
pub trait Message: Encode + Clone + PartialEq + Default + std::fmt::Debug + Send + 'static {
    /// The type on the wire.
    const TYPE: &'static TypeInfo;

    /// Reads a message from CDR with its four-byte encapsulation header, either byte order.
    ///
    /// # Errors
    /// When the bytes end early, a length exceeds what is there, a string is not UTF-8, or the encapsulation is unknown.
    fn decode(cdr: &[u8]) -> Result<Self, CdrError>;
}

/// A service type: its request and response are messages.
pub trait Service {
    /// For example `std_srvs/srv/Trigger`.
    const NAME: &'static str;
    /// The RIHS01 hash of the service.
    const HASH: &'static str;
    /// What a client sends.
    type Request: Message;
    /// What the server answers.
    type Response: Message;
}

/// A service type as the network names it, without its Rust types.
#[derive(Debug, PartialEq, Eq, Clone, Copy)]
pub struct ServiceInfo {
    /// For example `std_srvs/srv/Trigger`.
    pub name: &'static str,
    /// The RIHS01 hash of the service.
    pub hash: &'static str,
}

/// The [`ServiceInfo`] of a service type.
#[must_use]
pub const fn service_info<S: Service>() -> ServiceInfo {
    ServiceInfo { name: S::NAME, hash: S::HASH }
}
