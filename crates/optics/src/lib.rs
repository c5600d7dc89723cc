//! The overhead camera as geometry: pinhole, plumb-bob distortion, pads at a height, camera_info files.
