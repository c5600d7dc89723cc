//! Curves of segments: arc length, tangent, curvature, nearest points.
