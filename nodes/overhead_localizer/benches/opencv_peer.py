"""Localizer against OpenCV on the same frames, in one run, each on one thread.

    python3 -m venv VENV && VENV/bin/pip install opencv-python-headless numpy
    VENV/bin/python nodes/overhead_localizer/benches/opencv_peer.py [SCALE [ROBOTS]]

SCALE 2.5 stands for 1920 x 1080 pixels. Builds and runs `examples/detect_frames` (release), which renders the frames,
finds the discs and leaves frames and truth in a temporary folder; then finds the same discs by inRange + findContours +
moments, the fastest way OpenCV has.
"""

import csv
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np

PASSES = 20
# Tuned for equal recall on these frames: light from 70 % to 100 %, noise 4/255. Channels are R, G, B.
RANGES = {"Yellow": ((120, 105, 0), (255, 255, 80)), "Blue": ((0, 25, 110), (70, 110, 255))}
SCALE = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
ROBOTS = sys.argv[2] if len(sys.argv) > 2 else "6"
WIDTH, HEIGHT = (1920, 1080) if SCALE > 1.5 else (768, 576)
SMALLEST, LARGEST = 200.0 * SCALE**2, 480.0 * SCALE**2  # pixel^2, of a disc's contour

# Used again and again: masks that are made anew cost page faults, now and then half of OpenCV's time.
MASKS = {colour: np.empty((HEIGHT, WIDTH), dtype=np.uint8) for colour in RANGES}


def detect(frame):
    """The centres of all discs by colour."""
    found = []
    for colour, (low, high) in RANGES.items():
        mask = cv2.inRange(frame, low, high, MASKS[colour])
        contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        for contour in contours:
            moments = cv2.moments(contour)
            if SMALLEST < moments["m00"] < LARGEST:
                found.append((colour, moments["m10"] / moments["m00"], moments["m01"] / moments["m00"]))
    return found


def main():
    cv2.setNumThreads(1)
    root = Path(__file__).resolve().parents[3]
    build = ["cargo", "run", "--quiet", "--release", "-p", "overhead_localizer", "--no-default-features"]
    build += ["--example", "detect_frames", "--"]
    with tempfile.TemporaryDirectory() as folder:
        ours = json.loads(subprocess.check_output([*build, folder, str(SCALE), ROBOTS], cwd=root))
        frames = np.fromfile(Path(folder) / "frames.rgb", dtype=np.uint8).reshape(-1, HEIGHT, WIDTH, 3)
        truth = [[] for _ in frames]
        with open(Path(folder) / "truth.csv", newline="") as file:
            for row in csv.DictReader(file):
                truth[int(row["frame"])].append((row["colour"], float(row["u"]), float(row["v"])))

    matched, surplus, squares = 0, 0, []
    for frame, expected in zip(frames, truth):
        found = detect(frame)
        surplus += max(0, len(found) - len(expected))
        for colour, u, v in expected:
            errors = [np.hypot(fu - u, fv - v) for fc, fu, fv in found if fc == colour]
            if errors and min(errors) < 2.0:
                matched += 1
                squares.append(min(errors) ** 2)
    microseconds = []
    for _ in range(PASSES):
        for frame in frames:
            start = time.perf_counter()
            detect(frame)
            microseconds.append((time.perf_counter() - start) * 1e6)
    microseconds.sort()
    peer = {
        "frames": len(frames), "found": matched, "expected": sum(map(len, truth)), "surplus": surplus,
        "rms_px": round(float(np.sqrt(statistics.fmean(squares))), 4),
        "median_us": round(statistics.median(microseconds), 1),
        "p99_us": round(microseconds[int(0.99 * (len(microseconds) - 1))], 1),
    }  # fmt: skip
    print("localizer", json.dumps(ours))
    print(f"OpenCV {cv2.__version__}", json.dumps(peer))
    print(f"localizer is {peer['median_us'] / ours['median_us']:.1f} times faster (medians)")


if __name__ == "__main__":
    main()
