//! ROS 2 launch files in YAML: parse, resolve, start and supervise.
