//! Every layer of `trench view` in headless Chromium: a pursuit among obstacles in which one robot's radio falls silent and another's
//! wheels miss their steps.

#![expect(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "the other tests of pages use the rest")]
mod view_support;

use serde_json::json;
use view_support::{Browser, Viewer, record};

/// s from the start of the bed, while the robots drive to their places.
const FAULTS: &str = "faults:\n- {from: 2.0, to: 99.0, kind: silent, robots: [robot1]}\n\
                      - {from: 2.0, to: 99.0, kind: missed, robots: [robot3], share: 0.7}\n";

/// What the one says whose wheels miss their steps.
const ASTRAY: &str = "robot3: (3.8): the robot has not followed its commands for a while";

/// What the page warns of.
fn alarms(browser: &mut Browser) -> String {
    let all = "[...document.querySelectorAll('#alarms .alarm')].map(alarm => alarm.textContent).join('\\n')";
    browser.ask(all).as_str().unwrap().to_owned()
}

/// How many elements of the page a selector means.
fn count(browser: &mut Browser, selector: &str) -> u64 {
    browser.ask(&format!("document.querySelectorAll({selector:?}).length")).as_u64().unwrap()
}

#[test]
fn every_layer_shows_what_there_is_and_goes_by_its_switch() {
    let folder = tempfile::tempdir().unwrap();
    let (bag, faults) = (folder.path().join("pursuit"), folder.path().join("faults.yaml"));
    std::fs::write(&faults, FAULTS).unwrap();
    let faults = format!("faults:={}", faults.display());
    record("pursuit.launch.yaml", &["duration:=12.0", "tolerance:=9.0", "render:=false", &faults], &bag);
    let viewer = Viewer::start(&["--bag", bag.to_str().unwrap(), "--zones", "0.2,1.2"], &[]);
    let mut browser = Browser::open(&viewer.page(), (1600, 900));
    browser.until("document.body.dataset.robots === '8'");
    browser.ask("document.getElementById('play').click()");
    browser.until("document.getElementById('play').textContent === '▶'");

    // While robots set out, their laws push; soon after, robot1 is not heard, and robot3 does not do what it is told.
    let tags = |browser: &mut Browser, robot: &str| {
        let tags = format!(
            "[...document.querySelectorAll('[data-robot={robot}] .tag.bad')].map(tag => tag.textContent).join()"
        );
        browser.ask(&tags).as_str().unwrap().to_owned()
    };
    let mut told = Vec::new();
    let seen = (6..40).map(|tick| 0.25 * f64::from(tick)).any(|time| {
        browser.ask(&format!(
            "{{ const s = document.getElementById('slider'); s.value = {time}; \
             s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change')); }}"
        ));
        browser.until(&format!("Math.abs(document.body.dataset.time - {time}) < 0.1"));
        told.push([tags(&mut browser, "robot1"), tags(&mut browser, "robot3")]);
        let [silent, astray] = &told[told.len() - 1];
        silent.contains("no link")
            && astray.contains("violates (3.8)")
            && astray.contains("deviates")
            // Told of once a second.
            && alarms(&mut browser).contains(ASTRAY)
            && count(&mut browser, "[data-layer=forces] .force[d^=M]") >= 3
            && count(&mut browser, "[data-layer=\"marker:controller/forces\"] path[d^=M]") >= 6
            && count(&mut browser, "[data-layer=\"marker:controller/sectors\"] path") > 0
    });
    assert!(seen, "{told:?}");

    // Each layer with what it is of; the disturbed robots are those that show it.
    for (selector, expected) in [
        ("[data-layer=obstacles] .obstacle path[d^=M]", 7),
        ("[data-layer=links] .link", 8),
        ("[data-layer=links] .link[data-link=down]", 1),
        ("[data-layer=zones] .zone", 16),
        // Two chains, of seven robots: robot1, which is not heard for 2 s, has quit.
        ("[data-layer=leaders] .leader", 5),
        ("[data-layer=formation] .band", 2),
        ("[data-layer=target] .target", 1),
        ("[data-layer=truth] .truth", 8),
    ] {
        browser.until(&format!("document.querySelectorAll({selector:?}).length === {expected}"));
    }
    // Who passes between neither of the two discs' gap is led round their one hull.
    let (hulls, combined) = (count(&mut browser, "[data-layer=hulls] .hull"), count(&mut browser, ".hull.combined"));
    assert!((2..7).contains(&hulls) && combined >= 1, "{hulls} hulls, {combined} combined");
    let said = alarms(&mut browser);
    assert!(said.contains(ASTRAY) && said.contains("robot1"), "{said}");

    // Every switch of the list hides its layer and brings it back.
    let switched = browser.ask(
        "[...document.querySelectorAll('#layers label')].map(label => { \
           const input = label.querySelector('input'), name = label.__data__.name; \
           const groups = () => [...document.querySelectorAll('[data-layer]')].filter(one => one.dataset.layer === name); \
           const is = shown => groups().length > 0 && groups().every(one => (one.getAttribute('display') !== 'none') === shown); \
           const before = input.checked; \
           const good = is(before) && (input.click(), is(!before)) && (input.click(), is(before)); \
           return [name, good]; })",
    );
    let switched = switched.as_array().unwrap();
    for layer in [
        "robots",
        "names",
        "trails",
        "obstacles",
        "hulls",
        "forces",
        "links",
        "zones",
        "target",
        "truth",
        "marker:controller/forces",
        "marker:controller/sectors",
    ] {
        // Trails are drawn on a canvas, by a switch of their own.
        let is_good = layer == "trails" || switched.contains(&json!([layer, true]));
        assert!(is_good, "{layer}: {switched:?}");
    }

    // By key and by wheel; what is a metre on the floor grows on the screen.
    let scale = "document.querySelector('#under .world').transform.baseVal.consolidate().matrix.a";
    let fitted = browser.ask(scale).as_f64().unwrap();
    let press = |key: &str| format!("document.dispatchEvent(new KeyboardEvent('keydown', {{ key: '{key}' }}))");
    let near = |factor: f64| format!("Math.abs({scale} / {fitted} / {factor} - 1) < 0.01");
    browser.ask(&press("+"));
    browser.until(&near(1.4));
    browser.ask(&press("f"));
    browser.until(&near(1.0));
    browser.ask("document.getElementById('drawing').dispatchEvent(new WheelEvent('wheel', { deltaY: -250, clientX: 800, clientY: 450, bubbles: true, cancelable: true }))");
    browser.until(&near(2.0_f64.powf(0.5)));
    browser.ask(&press("f"));
    browser.until(&near(1.0));
    browser.picture("view-layers");
    assert_eq!(browser.complaints, Vec::<String>::new());
}
