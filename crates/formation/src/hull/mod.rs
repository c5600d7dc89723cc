//! Convex hulls, clearance, combined hulls (7.4).
