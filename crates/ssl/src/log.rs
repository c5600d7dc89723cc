//! Game logs: a head of twelve letters and a version, then records of time, kind, length and bytes; numbers are big-endian.

use std::io::{self, Read};

/// The kind of records that hold packets of SSL-Vision, by its protocol of 2014 and since.
pub const VISION: i32 = 4;
const NAME: &[u8; 12] = b"SSL_LOG_FILE";
/// No record of any kind is longer: a packet of UDP.
const LONGEST: usize = 1 << 16;

/// A record.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Record {
    /// When it was heard, ns since 1970.
    pub heard: i64,
    /// What it holds; see [`VISION`].
    pub kind: i32,
    /// The packet.
    pub bytes: Vec<u8>,
}

/// Why a log cannot be read on.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// It is something else.
    #[error("it is no log of the Small Size League: it does not begin with SSL_LOG_FILE")]
    Name,
    /// A later format.
    #[error("it is a log of version {0}, known is 1")]
    Version(i32),
    /// A record of impossible length.
    #[error("record {record} says that it has {length} bytes: the log is damaged there")]
    Length {
        /// Counts from 1.
        record: u64,
        /// What it says.
        length: i32,
    },
    /// The log ends within a record.
    #[error("record {0} is cut off")]
    CutOff(u64),
    /// Reading failed.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// Reads a log record by record.
#[derive(Debug)]
pub struct LogReader<R> {
    source: R,
    records: u64,
    ended: bool,
}

impl<R: Read> LogReader<R> {
    /// Reads the head.
    ///
    /// # Errors
    /// When it is no log.
    pub fn new(mut source: R) -> Result<Self, LogError> {
        let mut head = [0; 16];
        source.read_exact(&mut head).map_err(|_| LogError::Name)?;
        let (name, version) = head.split_at(NAME.len());
        if name != NAME {
            return Err(LogError::Name);
        }
        let version = i32::from_be_bytes([version[0], version[1], version[2], version[3]]);
        if version != 1 {
            return Err(LogError::Version(version));
        }
        Ok(Self { source, records: 0, ended: false })
    }

    fn record(&mut self) -> Result<Option<Record>, LogError> {
        let mut head = [0; 16];
        let length = read_some(&mut self.source, &mut head)?;
        if length == 0 {
            return Ok(None);
        }
        self.records += 1;
        if length < head.len() {
            return Err(LogError::CutOff(self.records));
        }
        let [a, b, c, d, e, f, g, h, k0, k1, k2, k3, l0, l1, l2, l3] = head;
        let said = i32::from_be_bytes([l0, l1, l2, l3]);
        let length = usize::try_from(said).ok().filter(|length| *length <= LONGEST);
        let length = length.ok_or(LogError::Length { record: self.records, length: said })?;
        let mut bytes = vec![0; length];
        if read_some(&mut self.source, &mut bytes)? < length {
            return Err(LogError::CutOff(self.records));
        }
        let (heard, kind) = (i64::from_be_bytes([a, b, c, d, e, f, g, h]), i32::from_be_bytes([k0, k1, k2, k3]));
        Ok(Some(Record { heard, kind, bytes }))
    }
}

impl<R: Read> Iterator for LogReader<R> {
    type Item = Result<Record, LogError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        let record = self.record().transpose();
        self.ended = !matches!(record, Some(Ok(_)));
        record
    }
}

/// Reads until the buffer is full or the source ends; gives how much there was.
fn read_some(source: &mut impl Read, buffer: &mut [u8]) -> io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match source.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(count) => filled += count,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log(records: &[(i64, i32, &[u8])]) -> Vec<u8> {
        let mut bytes = [&NAME[..], &1_i32.to_be_bytes()].concat();
        for (heard, kind, content) in records {
            bytes.extend(heard.to_be_bytes());
            bytes.extend(kind.to_be_bytes());
            bytes.extend((content.len() as i32).to_be_bytes());
            bytes.extend(*content);
        }
        bytes
    }

    #[test]
    fn records_come_in_order_and_damage_is_told() {
        let good = log(&[(5, VISION, b"abc"), (9, 3, b"")]);
        let records: Vec<Record> = LogReader::new(&good[..]).unwrap().map(Result::unwrap).collect();
        assert_eq!(records[0], Record { heard: 5, kind: VISION, bytes: b"abc".to_vec() });
        assert_eq!((records.len(), records[1].kind), (2, 3));
        for cut in 17..good.len() - 16 {
            let last = LogReader::new(&good[..cut]).unwrap().last().unwrap();
            assert_eq!(last.is_err(), cut != 35, "{cut}");
        }
        assert!(matches!(LogReader::new(&b"SSL_LOG"[..]), Err(LogError::Name)));
        assert!(matches!(LogReader::new(&[&NAME[..], &[0, 0, 0, 2]].concat()[..]), Err(LogError::Version(2))));
        let mut long = log(&[(5, VISION, b"abc")]);
        long[28] = 0x7f;
        assert!(matches!(LogReader::new(&long[..]).unwrap().next(), Some(Err(LogError::Length { record: 1, .. }))));
    }
}
