"""Steps of many robots: Trench's full law (7.13) against pyrvo (ORCA), from the same starts in one run, on one thread.

    python3 -m venv VENV && VENV/bin/pip install -r benches/peers/requirements.txt
    VENV/bin/python benches/peers/crowd.py

(`scripts/bench crowd` does both.) Builds and runs `cargo bench -p trench_formation --bench crowd`, which leaves starts and times in a
temporary folder; then pyrvo steps as many agents from there towards the points of the segment that were nearest then. Trench seeks its
nearest points anew at every step.
"""

import os
import subprocess
import tempfile
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"

import pyrvo
from scipy.spatial import cKDTree

SPEED = 0.5
TICK = 0.033
STEPS = 20
# As far as two robots can meet within pyrvo's horizon of 2 s, m.
RANGE = 2.0 * SPEED * 2.0 + 0.22


def rows(folder, name):
    return [[float(number) for number in line.split()] for line in (folder / name).read_text().splitlines()]


def wanted(position, end):
    """Straight to the end at full speed, slower within a metre of it: there nobody of Trench's robots goes on either."""
    way = (end[0] - position.x, end[1] - position.y)
    length = max((way[0] ** 2 + way[1] ** 2) ** 0.5, 1.0)
    return (SPEED * way[0] / length, SPEED * way[1] / length)


def peer(starts, ends):
    """Best and median seconds an agent step of fifteen times twenty steps, after twenty that do not count, and the mean number of neighbours.

    Preferred velocities are set anew between the runs, while the clock stands.
    """
    count = len(starts)
    simulation = pyrvo.RVOSimulator()
    simulation.set_time_step(TICK)
    simulation.set_agent_defaults(RANGE, 10, 2.0, 2.0, 0.11, SPEED, (0.0, 0.0))
    for start in starts:
        simulation.add_agent(tuple(start))
    seconds, neighbours = [], 0
    for run in range(16):
        for index, end in enumerate(ends):
            position = simulation.get_agent_position(index)
            simulation.set_agent_pref_velocity(index, wanted(position, end))
        begin = time.perf_counter()
        for _ in range(STEPS):
            simulation.do_step()
        seconds.append((time.perf_counter() - begin) / (STEPS * count))
        neighbours += sum(simulation.get_agent_num_agent_neighbors(index) for index in range(count)) / (16 * count)
    seconds = sorted(seconds[1:])
    return seconds[0], seconds[7], neighbours


def crowding(positions, range):
    """How many others are within `range` (m) of a robot, on average."""
    return 2.0 * len(cKDTree(positions).query_pairs(range)) / len(positions)


def main():
    root = Path(__file__).resolve().parents[2]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bench = ["cargo", "bench", "--quiet", "-p", "trench_formation", "--bench", "crowd", "--", name]
        subprocess.run(bench, cwd=root, check=True, stdout=subprocess.DEVNULL)
        lines = (line.split("\t") for line in (folder / "times.tsv").read_text().splitlines())
        ours = {name: (float(best), float(median)) for name, best, median in lines}
        print("best (median) of 15, an agent step; equal motion on one thread and two")
        for count in (250, 20000):
            best, median, neighbours = peer(rows(folder, f"starts_{count}.txt"), rows(folder, f"ends_{count}.txt"))
            (mine, middle), (both, _) = (ours[f"crowd: {count} robots, {threads} threads"] for threads in (1, 2))
            near = crowding(rows(folder, f"moved_{count}.txt"), RANGE)
            print(
                f"{count:>6} robots: ours {1e6 * mine:.3f} ({1e6 * middle:.3f}) us, {1e-6 / mine:.2f} million a second; on two "
                f"threads {1e6 * both:.3f} us, {near:.1f} others within {RANGE} m at the end; pyrvo {1e6 * best:.3f} ({1e6 * median:.3f}) us with {neighbours:.1f} neighbours; "
                f"{best / mine:.2f} times"
            )


if __name__ == "__main__":
    main()
