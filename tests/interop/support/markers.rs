//! What RViz2 has against markers before it draws them: the rules by which it turns a display yellow or red.

use super::number;
use serde_json::Value;
use std::collections::BTreeSet;

// visualization_msgs/Marker.
const ARROW: u64 = 0;
const LINE_STRIP: u64 = 4;
const LINE_LIST: u64 = 5;
const POINTS: u64 = 8;
const TEXT: u64 = 9;
const TRIANGLES: u64 = 11;
const ADD: u64 = 0;
const DELETE_ALL: u64 = 3;

/// What is wrong with a MarkerArray as rclpy gives it.
pub(crate) fn problems(array: &Value) -> Vec<String> {
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    for marker in array["markers"].as_array().unwrap() {
        let name = format!("{}/{}", marker["ns"].as_str().unwrap(), marker["id"]);
        if marker["action"] == DELETE_ALL {
            continue;
        }
        if !seen.insert(name.clone()) {
            found.push(format!("{name}: twice in one array"));
        }
        if marker["action"] == ADD {
            found.extend(problems_of(marker).into_iter().map(|problem| format!("{name}: {problem}")));
        }
    }
    found
}

fn problems_of(marker: &Value) -> Vec<&'static str> {
    let kind = marker["type"].as_u64().unwrap();
    let points = marker["points"].as_array().unwrap();
    let [sx, sy, sz] = ["x", "y", "z"].map(|axis| number(marker, &format!("/scale/{axis}")));
    let norm: f64 =
        ["x", "y", "z", "w"].map(|part| number(marker, &format!("/pose/orientation/{part}")).powi(2)).iter().sum();
    let coordinates =
        points.iter().chain([&marker["pose"]["position"]]).flat_map(|point| ["x", "y", "z"].map(|axis| &point[axis]));
    let mut checks = vec![
        (marker["header"]["frame_id"] == "", "no frame"),
        (!coordinates.into_iter().all(|value| value.as_f64().is_some_and(f64::is_finite)), "a coordinate is no number"),
        ((norm - 1.0).abs() > 1e-3, "the quaternion has not length one"),
        (number(marker, "/color/a") <= 0.0, "fully transparent"),
        (kind != TEXT && marker["text"] != "", "a text that is not drawn"),
        (marker["mesh_resource"] != "", "a mesh that is not drawn"),
    ];
    let colours = marker["colors"].as_array().unwrap().len();
    checks.push((colours != 0 && colours != points.len(), "not a colour a point"));
    checks.extend(match kind {
        LINE_STRIP | LINE_LIST => {
            let odd = kind == LINE_LIST && !points.len().is_multiple_of(2);
            vec![
                (sx <= 0.0, "a line without width"),
                (sy != 0.0 || sz != 0.0, "sizes that a line has not"),
                (points.len() < 2 || odd, "not the number of points of lines"),
            ]
        }
        POINTS => vec![
            (sx <= 0.0 || sy <= 0.0, "points without size"),
            (sz != 0.0, "a depth that points have not"),
            (points.is_empty(), "no points"),
        ],
        TEXT => vec![
            (sz <= 0.0, "letters without height"),
            (sx != 0.0 || sy != 0.0, "sizes that a text has not"),
            (marker["text"].as_str().unwrap().trim().is_empty(), "no text"),
        ],
        ARROW => vec![
            (sx <= 0.0 || sy <= 0.0, "an arrow without size"),
            (!matches!(points.len(), 0 | 2), "neither no nor two points of an arrow"),
        ],
        1..=3 => vec![
            (sx <= 0.0 || sy <= 0.0 || sz <= 0.0, "a body without size"),
            (!points.is_empty(), "points that a body has not"),
        ],
        6 | 7 | TRIANGLES => vec![
            (sx <= 0.0 || sy <= 0.0 || sz <= 0.0, "bodies without size"),
            (
                points.is_empty() || (kind == TRIANGLES && !points.len().is_multiple_of(3)),
                "not the number of points of bodies",
            ),
        ],
        _ => vec![(true, "no kind that is known")],
    });
    checks.into_iter().filter_map(|(is_wrong, problem)| is_wrong.then_some(problem)).collect()
}
