//! All UDP packets of this host, as anybody with a cable would see them.

use socket2::{Domain, Protocol, Socket, Type};
use std::io::Read;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;

/// A raw socket that listens; it needs root, as the tests with several hosts do.
pub(crate) struct Wire {
    packets: Arc<Mutex<Vec<Vec<u8>>>>,
    ends: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Wire {
    /// From now on.
    pub(crate) fn tap() -> Self {
        let mut wire = Socket::new(Domain::IPV4, Type::RAW, Some(Protocol::UDP)).unwrap();
        wire.set_read_timeout(Some(std::time::Duration::from_millis(100))).unwrap();
        let (packets, ends) = (Arc::new(Mutex::new(Vec::new())), Arc::new(AtomicBool::new(false)));
        let (heard, over) = (Arc::clone(&packets), Arc::clone(&ends));
        let thread = std::thread::spawn(move || {
            let mut buffer = vec![0; 70_000];
            while !over.load(Ordering::Relaxed) {
                if let Ok(length) = wire.read(&mut buffer) {
                    heard.lock().unwrap().push(buffer[..length].to_vec());
                }
            }
        });
        Self { packets, ends, thread: Some(thread) }
    }

    /// How many packets came.
    pub(crate) fn heard(&self) -> usize {
        self.packets.lock().unwrap().len()
    }

    /// Whether a packet has these bytes.
    pub(crate) fn has(&self, bytes: &[u8]) -> bool {
        self.packets.lock().unwrap().iter().any(|packet| packet.windows(bytes.len()).any(|part| part == bytes))
    }
}

impl Drop for Wire {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        let _ended = self.thread.take().map(JoinHandle::join);
    }
}
