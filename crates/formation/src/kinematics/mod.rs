//! Differential-drive kinematics (3.5)-(3.8), (3.14)-(3.16), wheel limits and the dynamics of 3.1.
