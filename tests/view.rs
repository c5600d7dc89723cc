//! `trench view`: the page in a real browser (headless Chromium, `scripts/setup --tests`), playing a bag and showing a
//! launched experiment; and requests that it must refuse.

#![expect(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that cannot go on fails")]

#[path = "support/own_memory.rs"]
mod own_memory;
#[expect(dead_code, reason = "the page of colours asks whether it waits its turn")]
mod view_support;

use own_memory::OwnMemory;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::json;
use std::path::Path;
use std::process::{Command, Stdio};
use view_support::{Browser, Viewer, record};

/// How many pixels are of about this colour.
fn pixels_like(picture: &image::RgbImage, colour: [u8; 3]) -> usize {
    let is_near = |pixel: &&image::Rgb<u8>| pixel.0.iter().zip(colour).all(|(a, b)| a.abs_diff(b) < 12);
    picture.pixels().filter(is_near).count()
}

/// A script that drags the slider to this time, s.
fn seek(to: f64) -> String {
    format!(
        "{{ const s = document.getElementById('slider'); s.value = {to}; \
         s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change')); }}"
    )
}

#[test]
fn a_bag_is_shown_and_played() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("square");
    record("square.launch.yaml", &["duration:=20.0", "tolerance:=1.0"], &bag);
    let viewer = Viewer::start(&["--bag", bag.to_str().unwrap(), "--zones", "0.2,0.26"], &[]);
    let mut browser = Browser::open(&viewer.page(), (1600, 900));
    browser.until("document.body.dataset.robots === '4'");
    browser.until("document.body.dataset.run === 'running'");
    assert_eq!(browser.ask("document.body.dataset.mode"), "bag");

    // A jump brings the past with it.
    browser.ask(&seek(14.0));
    browser.until("Math.abs(document.body.dataset.time - 14) < 1");
    assert_eq!(browser.ask("document.querySelectorAll('#drawing .robot').length"), 4);
    assert_eq!(browser.ask("document.querySelectorAll('.card').length"), 4);
    assert_eq!(browser.ask("document.querySelectorAll('#under .segment').length"), 2);
    assert_eq!(browser.ask("document.querySelectorAll('#drawing .zone').length"), 8);
    assert_eq!(browser.ask("document.querySelectorAll('#drawing .leader').length"), 2);
    let first = "document.querySelector('.robot').getAttribute('transform')";
    browser.ask("document.getElementById('play').click()");
    browser.until("document.getElementById('play').textContent === '▶'");
    let held = browser.ask(first);
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert_eq!(browser.ask(first), held, "what is held moves");

    // In the dark the first robot's colour is lighter than in print.
    browser.ask("document.documentElement.dataset.theme === 'light' && document.getElementById('theme').click()");
    let picture = browser.picture("view-bag-dark");
    for colour in [[0x2f, 0x9b, 0xe0], [213, 94, 0], [0, 158, 115], [204, 121, 167]] {
        let count = pixels_like(&picture, colour);
        assert!(count > 500, "{count} pixels of {colour:?}");
    }
    browser.ask("document.getElementById('theme').click()");
    let picture = browser.picture("view-bag-light");
    assert!(pixels_like(&picture, [0, 114, 178]) > 500 && pixels_like(&picture, [255, 255, 255]) > 300_000);

    // Layers go and come; at the end it stops.
    browser.ask("document.querySelector('#layers input').click()");
    browser.until("document.querySelector('[data-layer=robots]').getAttribute('display') === 'none'");
    browser.ask("document.querySelector('#layers input').click()");
    browser.ask("document.getElementById('rate').value = '16'; document.getElementById('rate').dispatchEvent(new Event('change'))");
    browser.ask("document.getElementById('play').click()");
    browser
        .until("document.getElementById('play').textContent === '▶' && document.getElementById('slider').value > 20");
    assert_eq!(browser.complaints, Vec::<String>::new());
}

#[test]
fn a_formation_is_drawn_where_its_target_carries_it() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("column");
    record("column.launch.yaml", &["duration:=40.0", "tolerance:=9.0"], &bag);
    let viewer = Viewer::start(&["--bag", bag.to_str().unwrap()], &[]);
    let mut browser = Browser::open(&viewer.page(), (1440, 810));
    browser.until("document.body.dataset.robots === '4' && document.querySelectorAll('#under .band').length === 1");
    let place = |browser: &mut Browser, time: f64| -> f64 {
        browser.ask(&seek(time));
        browser.until(&format!("Math.abs(document.body.dataset.time - {time}) < 1"));
        let matrix = "document.querySelector('#under .segment').parentNode.transform.baseVal.consolidate().matrix.e";
        browser.until(&format!("{matrix} > 0"));
        browser.ask(matrix).as_f64().unwrap()
    };
    // The target goes from x = 1.6 m to 3.4 m, beyond what the small bed's camera sees: the floor grows.
    let (early, late) = (place(&mut browser, 6.0), place(&mut browser, 35.0));
    assert!(late > early + 0.8, "{early} m, then {late} m");
    assert!(browser.ask("document.querySelector('.floor').width.baseVal.value").as_f64().unwrap() > 2.9);
    browser.ask("document.getElementById('play').click()");
    browser.until("document.getElementById('play').textContent === '▶'");
    let dark = "document.documentElement.dataset.theme === 'light' && document.getElementById('theme').click()";
    browser.ask(dark);
    assert!(pixels_like(&browser.picture("view-column"), [213, 94, 0]) > 500);
    assert_eq!(browser.complaints, Vec::<String>::new());
}

#[test]
fn live_square_in_two_browsers() {
    let folder = tempfile::tempdir().unwrap();
    let domain = (70 + std::process::id() % 30).to_string();
    let memory = OwnMemory(format!("view{}_", std::process::id()));
    let state = folder.path().join("state");
    let variables =
        [("ROS_DOMAIN_ID", &*domain), ("TRENCH_SHM_PREFIX", &*memory.0), ("TRENCH_STATE_DIR", state.to_str().unwrap())];
    let viewer = Viewer::start(&[], &variables);
    let mut early = Browser::open(&viewer.page(), (1280, 800));
    early.until("document.body.dataset.mode === 'live' && document.body.dataset.robots === '0'");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut launch = Command::new(env!("CARGO_BIN_EXE_trench"))
        .arg("launch")
        .arg(root.join("launch/square.launch.yaml"))
        .arg(format!("port:={}", folder.path().join("port").display()))
        .args(["render:=false", "duration:=30.0", "tolerance:=1.0", "--run-dir"])
        .arg(folder.path().join("run"))
        .envs(variables)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    early.until("document.body.dataset.robots === '4' && document.body.dataset.run === 'running'");
    let mut late = Browser::open(&viewer.page(), (1280, 800));
    late.until("document.body.dataset.robots === '4' && document.body.dataset.run === 'running'");
    late.until("document.querySelectorAll('#under .segment').length === 2");
    // The laws' values come from topics of robots that nobody named.
    let valued =
        "[...document.querySelectorAll('.card dd:nth-child(2)')].filter(one => /[0-9]/.test(one.textContent)).length";
    early.until(&format!("{valued} >= 12"));
    late.until(&format!("{valued} >= 12"));
    early.until("Number(document.getElementById('clock').textContent.replace(/[^0-9.]/g, '')) > 8");
    let picture = early.picture("view-live");
    assert!(pixels_like(&picture, [0x2f, 0x9b, 0xe0]) + pixels_like(&picture, [0, 114, 178]) > 500);

    // Held, the picture stands still; then it goes on with what was missed.
    early.ask("document.getElementById('pause').click()");
    // What was about to be drawn when the button was pressed still is.
    std::thread::sleep(std::time::Duration::from_millis(200));
    let frames = "Number(document.body.dataset.frames)";
    let held = early.ask(frames);
    std::thread::sleep(std::time::Duration::from_millis(500));
    assert_eq!(early.ask(frames), held, "what is held is drawn");
    early.ask("document.getElementById('pause').click()");
    early.until(&format!("{frames} > {held} + 5"));
    assert_eq!(early.complaints, Vec::<String>::new());
    assert_eq!(late.complaints, Vec::<String>::new());
    let _has_ended = kill_process(Pid::from_child(&launch), Signal::INT);
    launch.wait().unwrap();
}

#[test]
fn requests_that_are_refused() {
    let memory = OwnMemory(format!("viewbad{}_", std::process::id()));
    let viewer = Viewer::start(&[], &[("ROS_DOMAIN_ID", "101"), ("TRENCH_SHM_PREFIX", &*memory.0)]);
    let host = viewer.host.clone();
    let check = |request: &str, expected: &str| {
        let (first, answer) = viewer.send(request);
        assert!(first.contains(expected), "{request:?} gave {answer}");
        answer
    };
    let get = |path: &str, host: &str| format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
    let page = check(&get("/", &host), "200");
    assert!(page.contains("content-security-policy: default-src 'none'"), "{page}");
    check(&get("/main.js", &host), "200");
    for path in ["/nothing", "/../Cargo.toml", "/vendor/", "/vendor/VERSIONS", "//", "/%2e%2e/Cargo.toml"] {
        check(&get(path, &host), "404");
    }
    for foreign in ["evil.example", "evil.example:80", "127.0.0.1", ""] {
        check(&get("/", foreign), "421");
    }
    check(&format!("GET / HTTP/1.1\r\nHost: {host}\r\nHost: evil.example\r\nConnection: close\r\n\r\n"), "421");
    check("GET / HTTP/1.1\r\nConnection: close\r\n\r\n", "421");
    for method in ["POST", "PUT", "DELETE", "OPTIONS"] {
        check(&format!("{method} / HTTP/1.1\r\nHost: {host}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"), "405");
    }
    check("nonsense\r\n\r\n", "400");
    let upgrade = |origin: &str| {
        format!(
            "GET /stream HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
             Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n{origin}\r\n"
        )
    };
    check(&upgrade(&format!("Origin: http://{host}\r\n")), "101");
    check(&upgrade("Origin: http://evil.example\r\n"), "403");
    check(&upgrade("Origin: null\r\n"), "403");
    check(&upgrade(""), "403");
    check(&get("/stream", &host), "400");
}

#[test]
fn wrong_arguments_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let nothing = folder.path().join("nothing");
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let check = |arguments: &[&str], expected: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_trench")).arg("view").args(arguments).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.contains(expected), "{arguments:?}: {said}");
    };
    check(&["--bag", nothing.to_str().unwrap(), "--port", "0"], "nothing: No such file");
    check(&["--port", &port], "is another page of trench served there? Name another port with --port");
    check(&["--field", "0", "0", "0", "1"], "--field wants numbers");
    check(&["--zones", "0.2,-1", "--port", "0"], "--zones wants numbers");
    check(&["--port", "70000"], "70000");
}

#[test]
fn a_stream_that_says_nonsense_is_closed() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("square");
    record("square.launch.yaml", &["duration:=2.0", "tolerance:=9.0"], &bag);
    let viewer = Viewer::start(&["--bag", bag.to_str().unwrap()], &[]);
    let open = || {
        let request = tungstenite::http::Request::builder()
            .uri(format!("ws://{}/stream", viewer.host))
            .header("Host", &viewer.host)
            .header("Origin", format!("http://{}", viewer.host))
            .header("Upgrade", "websocket")
            .header("Connection", "Upgrade")
            .header("Sec-WebSocket-Version", "13")
            .header("Sec-WebSocket-Key", tungstenite::handshake::client::generate_key());
        tungstenite::connect(request.body(()).unwrap()).unwrap().0
    };
    for nonsense in ["{", "{\"play\":1}", "{\"fly\":true}", "[]", &"x".repeat(1000)] {
        let mut stream = open();
        stream.send(tungstenite::Message::text(nonsense)).unwrap();
        let ended = stream.read();
        assert!(ended.is_err() || ended.unwrap().is_close(), "{nonsense:?}");
    }
    // Nothing comes that was not asked for, and numbers out of range do no harm.
    let mut stream = open();
    stream.send(tungstenite::Message::text(r#"{"seek":1e300}"#)).unwrap();
    stream.send(tungstenite::Message::text(r#"{"rate":-7}"#)).unwrap();
    stream.send(tungstenite::Message::text("")).unwrap();
    let first: serde_json::Value = serde_json::from_str(stream.read().unwrap().to_text().unwrap()).unwrap();
    assert_eq!(first["player"]["time"], first["player"]["duration"]);
    assert_eq!(first["player"]["rate"], json!(0.05));
    assert_eq!(first["team"]["robots"].as_array().unwrap().len(), 4);
}
