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
    let size = usize::try_from(size).map_err(|_| BadChunk::TooLarge)?;
    let records = match header.compression.as_str() {
        // At once: a stream would keep a window of its own, as large as the data like to claim.
        "zstd" => zstd::bulk::decompress(compressed, size),
        "lz4" => lz4::Decoder::new(compressed).and_then(|decoder| read(decoder, size)),
        _ => Ok(compressed.to_vec()),
    };
    let records = records.map_err(|_| BadChunk::Compression)?;
    if records.len() != size {
        return Err(BadChunk::Compression);
    }
    // Zero says that the writer did not compute it.
    if header.uncompressed_crc != 0 && crc32fast::hash(&records) != header.uncompressed_crc {
        return Err(BadChunk::Checksum);
    }
    Ok(records)
}

/// Reads up to one byte behind `size`, into memory that is made once.
fn read(source: impl Read, size: usize) -> io::Result<Vec<u8>> {
    let mut records = Vec::with_capacity(size + 1);
    source.take(size as u64 + 1).read_to_end(&mut records)?;
    Ok(records)
}
