//! Bags in rosbag2's MCAP profile: record and read.
