"""Steps of many robots: Trench's full law (7.13) against pyrvo (ORCA), from the same starts in one run, on one thread.

    python3 -m venv VENV && VENV/bin/pip install -r benches/peers/requirements.txt
    VENV/bin/python benches/peers/crowd.py

(`scripts/bench crowd` does both.) Builds and runs `cargo bench -p trench_formation --bench crowd`, which leaves starts and times in a
temporary folder; then pyrvo steps as many agents from there towards the nearest points of the segment. Preferred velocities are set
once, before the clock runs; Trench seeks its nearest points anew at every step.
"""

import os
import subprocess
import tempfile
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"

import pyrvo

SPEED = 0.5
TICK = 0.033
STEPS = 20


def rows(folder, name):
    return [[float(number) for number in line.split()] for line in (folder / name).read_text().splitlines()]


def peer(starts, ends):
    """Best seconds an agent step of fifteen times twenty steps, after twenty that do not count."""
    simulation = pyrvo.RVOSimulator()
    simulation.set_time_step(TICK)
    # Neighbours as far as two robots can meet within the horizon of 2 s.
    simulation.set_agent_defaults(2.0 * SPEED * 2.0 + 0.22, 10, 2.0, 2.0, 0.11, SPEED, (0.0, 0.0))
    for index, ((x, y), (to_x, to_y)) in enumerate(zip(starts, ends)):
        simulation.add_agent((x, y))
        way = (to_x - x, to_y - y)
        length = max((way[0] ** 2 + way[1] ** 2) ** 0.5, SPEED)
        wanted = (SPEED * way[0] / length, SPEED * way[1] / length)
        simulation.set_agent_pref_velocity(index, wanted)
    best = float("inf")
    for run in range(16):
        begin = time.perf_counter()
        for _ in range(STEPS):
            simulation.do_step()
        if run > 0:
            best = min(best, (time.perf_counter() - begin) / (STEPS * len(starts)))
    return best


def main():
    root = Path(__file__).resolve().parents[2]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bench = ["cargo", "bench", "--quiet", "-p", "trench_formation", "--bench", "crowd", "--", name]
        subprocess.run(bench, cwd=root, check=True, stdout=subprocess.DEVNULL)
        lines = (line.split("\t") for line in (folder / "times.tsv").read_text().splitlines())
        ours = {name: float(best) for name, best, _ in lines}
        print("best of 15, an agent step; equal motion on one thread and two")
        for count in (250, 20000):
            theirs = peer(rows(folder, f"starts_{count}.txt"), rows(folder, f"ends_{count}.txt"))
            mine, both = (ours[f"crowd: {count} robots, {threads} threads"] for threads in (1, 2))
            print(
                f"{count:>6} robots: ours {1e6 * mine:.3f} us ({1e-6 / mine:.2f} million a second; on two threads "
                f"{1e6 * both:.3f} us), pyrvo {1e6 * theirs:.3f} us: {theirs / mine:.2f} times"
            )


if __name__ == "__main__":
    main()
