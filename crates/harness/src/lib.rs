//! Drives all node cores in lock-step, from launch files or from journals.
