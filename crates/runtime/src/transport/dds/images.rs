//! A writer's images, and who is to get them.

use super::image::{self, Image, Place};
use super::rtps::prefix;
use super::writer::gid;
use crate::transport::network::{Gid, ImageWay};
use rustdds::bytes::Bytes;
use rustdds::{DomainParticipant, GUID};
use std::collections::{BTreeMap, BTreeSet};
use std::net::SocketAddr;
use std::sync::Arc;
use trench_core::Qos;

/// The images' way of one writer.
pub(super) struct Images {
    writer: GUID,
    participant: DomainParticipant,
    to: Arc<[Place]>,
    way: ImageWay<Image>,
}

impl Images {
    /// Of a writer that has not written yet.
    pub(super) fn of(writer: GUID, qos: Qos, participant: DomainParticipant) -> Self {
        Self { writer, participant, to: Arc::new([]), way: ImageWay::new(qos) }
    }

    /// They may take so many bit/s.
    pub(super) fn limit(&mut self, rate: f64) {
        self.way.limit(rate);
    }

    /// Takes a message if it goes this way. False: RustDDS sends it.
    pub(super) fn take(&mut self, number: u64, message: &Bytes) -> bool {
        let writer = self.writer;
        let Some(lane) = self.way.of(message.len(), |rate| image::open(writer, rate)) else { return false };
        if !self.to.is_empty() {
            lane.put(Image { number, cdr: message.clone(), to: Arc::clone(&self.to) });
        }
        true
    }

    /// These are to get images from now on.
    pub(super) fn readers_changed(&mut self, readers: &BTreeSet<Gid>) {
        let mut places = BTreeMap::new();
        for found in self.participant.discovered_readers() {
            let reader = found.reader_proxy.remote_reader_guid;
            if readers.contains(&gid(reader)) {
                let addresses = found.reader_proxy.unicast_locator_list.into_iter().filter(|place| place.is_udp());
                if let Some(address) = image::nearest(addresses.map(SocketAddr::from)) {
                    // One copy for all readers of a process.
                    places.entry(prefix(reader)).or_insert(address);
                }
            }
        }
        self.to = places.into_iter().map(|(prefix, address)| Place { prefix, address }).collect();
    }
}
