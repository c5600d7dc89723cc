//! Bags in rosbag2's MCAP profile: record, read and play.
//!
//! A bag is a folder with `metadata.yaml` and `.mcap` files, as `ros2 bag`, Foxglove, `rosbags` and `mcap-ros2-support`
//! read and write it. [`BagWriter`] and [`BagReader`] work on bytes and know no message type;
//! [`run`] reads an experiment out of a bag and [`run::summary`] judges it; [`analysis`] judges traffic, links and noise.
//!
//! Architecture invariant: nothing here panics on any bytes, and no byte that a checksum contradicts is given out.

pub mod analysis;
mod error;
mod metadata;
pub mod player;
mod qos;
mod reader;
pub mod recorder;
pub mod run;
mod selection;
mod topic_type;
mod writer;

pub use error::BagError;
pub use reader::{BagMessage, BagReader, Damage, Messages, Topic};
pub use topic_type::TopicType;
pub use writer::{BagWriter, Compression, Stamp, TopicId, WriteOptions};
