//! Counts packets that are no DDS messages. RustDDS drops them and says so to the [`log`] facade alone; the logger is that of
//! [`super::pause`].

use super::pause::starts_with;
use log::{Level, Metadata, Record};
use std::sync::atomic::{AtomicU64, Ordering};

/// Where packets are taken apart.
const RECEIVER: &str = "rustdds::rtps::message_receiver";
/// What is said of one that cannot be.
const MALFORMED: [&str; 3] =
    ["Message is shorter than RTPS header", "Received message with unknown start", "RTPS deserialize error"];

static COUNT: AtomicU64 = AtomicU64::new(0);

/// How many came to this process.
pub(crate) fn malformed_packets() -> u64 {
    COUNT.load(Ordering::Relaxed)
}

/// Whether such a record may be of a packet.
pub(super) fn may_say(metadata: &Metadata<'_>) -> bool {
    metadata.level() == Level::Warn && metadata.target() == RECEIVER
}

/// Counts a record if it is of a packet.
pub(super) fn count(record: &Record<'_>) {
    if MALFORMED.iter().any(|words| starts_with(*record.args(), words)) {
        COUNT.fetch_add(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::malformed_packets;
    use rustdds::DomainParticipantBuilder;
    use std::net::UdpSocket;
    use std::time::Duration;

    /// Fails with a release of RustDDS that says it otherwise.
    #[test]
    fn noise_on_a_port_of_the_domain_is_counted() {
        const DOMAIN: u16 = 53;
        let pause = crate::transport::dds::pause::Pause::begin();
        let participant = DomainParticipantBuilder::new(DOMAIN).build().unwrap();
        drop(pause);
        let (sender, before) = (UdpSocket::bind("127.0.0.1:0").unwrap(), malformed_packets());
        let unicast = 7400 + 250 * DOMAIN + 10;
        for _ in 0..1000 {
            for port in (unicast..unicast + 20).step_by(2) {
                sender.send_to(b"this is no message of any kind", ("127.0.0.1", port)).unwrap();
                let mut cut_off = b"RTPS\x02\x04\x01\x12".to_vec();
                cut_off.extend([7; 13]);
                sender.send_to(&cut_off, ("127.0.0.1", port)).unwrap();
            }
            if malformed_packets() >= before + 2 {
                break;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        assert!(malformed_packets() >= before + 2, "nothing was counted");
        drop(participant);
    }
}
