//! Decompressing a chunk and checking its checksum.

use mcap::records::ChunkHeader;
use std::io::{self, Read};

/// Why a chunk gives nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BadChunk {
    /// It says that it would grow beyond what a reader is ready to hold.
    TooLarge,
    /// The compressed bytes are damaged, or grow to another size than they should.
    Compression,
    /// The checksum contradicts the bytes.
    Checksum,
}

impl BadChunk {
    pub(super) fn describe(self) -> &'static str {
        match self {
            Self::TooLarge => "claims to be larger than any chunk of a file of this size",
            Self::Compression => "does not decompress",
            Self::Checksum => "contradicts its checksum",
        }
    }
}

/// The records of a chunk.
pub(super) fn decompress(header: &ChunkHeader, compressed: &[u8], limit: u64) -> Result<Vec<u8>, BadChunk> {
    let size = header.uncompressed_size;
    if size > limit {
        return Err(BadChunk::TooLarge);
    }
    let records = match header.compression.as_str() {
        "zstd" => zstd::stream::Decoder::new(compressed).and_then(|decoder| read(decoder, size)),
        "lz4" => lz4::Decoder::new(compressed).and_then(|decoder| read(decoder, size)),
        _ => read(compressed, size),
    };
    let records = records.map_err(|_| BadChunk::Compression)?;
    if records.len() as u64 != size {
        return Err(BadChunk::Compression);
    }
    // Zero says that the writer did not compute it.
    if header.uncompressed_crc != 0 && crc32fast::hash(&records) != header.uncompressed_crc {
        return Err(BadChunk::Checksum);
    }
    Ok(records)
}

/// Grows with what is really there, not with what the header claims, and stops one byte behind it.
fn read(source: impl Read, size: u64) -> io::Result<Vec<u8>> {
    let mut records = Vec::new();
    source.take(size.saturating_add(1)).read_to_end(&mut records)?;
    Ok(records)
}
