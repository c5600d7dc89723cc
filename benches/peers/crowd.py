"""Steps of many robots: Trench's full law (7.13) against pyrvo (ORCA), from the same starts in one run, on one thread.

    python3 -m venv VENV && VENV/bin/pip install -r benches/peers/requirements.txt
    VENV/bin/python benches/peers/crowd.py [target/release/trench]

(`scripts/bench crowd` does both.) Builds and runs `cargo bench -p trench_formation --bench crowd`, which leaves starts and times in a
temporary folder; then pyrvo steps as many agents from there towards the points of the segment that were nearest then. Trench seeks its
nearest points anew at every step. With the program, `trench sim` runs the same as a scenario file: besides the steps it measures every
robot after each, and says at the end how it went. Its robots must be where the library's are, bit for bit.
"""

import csv
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"

import pyrvo
from scipy.spatial import cKDTree

ROOT = Path(__file__).resolve().parents[2]
SPEED = 0.5
TICK = 0.033
# Between which pyrvo's robots are told anew where to go, and how many times that is timed.
STEPS = 20
RUNS = 15
COUNTS = (250, 20000)
# Of a run of `trench sim`, for few and many robots alike, so that what it does once weighs the same.
SIM_STEPS = 3200
# Library, pyrvo and `trench sim` take turns, with as many agent steps of few robots as of many, and the best of these rounds counts: a run of
# few lasts less than a moment in which somebody else of the host has the caches, one of many does not.
ROUNDS = 5
# As far as two robots can meet within pyrvo's horizon of 2 s, m.
RANGE = 2.0 * SPEED * 2.0 + 0.22


def rows(folder, name):
    return [[float(number) for number in line.split()] for line in (folder / name).read_text().splitlines()]


def wanted(position, end):
    """Straight to the end at full speed, slower within a metre of it: there nobody of Trench's robots goes on either."""
    way = (end[0] - position.x, end[1] - position.y)
    length = max((way[0] ** 2 + way[1] ** 2) ** 0.5, 1.0)
    return (SPEED * way[0] / length, SPEED * way[1] / length)


def peer(starts, ends, repeats):
    """Mean seconds an agent step of `repeats` times fifteen times twenty steps, after twenty that do not count, and the mean number of
    neighbours.

    Preferred velocities are set anew between the runs, while the clock stands.
    """
    count = len(starts)
    seconds, neighbours = 0.0, 0
    for _ in range(repeats):
        simulation = pyrvo.RVOSimulator()
        simulation.set_time_step(TICK)
        simulation.set_agent_defaults(RANGE, 10, 2.0, 2.0, 0.11, SPEED, (0.0, 0.0))
        for start in starts:
            simulation.add_agent(tuple(start))
        for run in range(RUNS + 1):
            for index, end in enumerate(ends):
                position = simulation.get_agent_position(index)
                simulation.set_agent_pref_velocity(index, wanted(position, end))
            begin = time.perf_counter()
            for _ in range(STEPS):
                simulation.do_step()
            if run > 0:
                seconds += time.perf_counter() - begin
            neighbours += sum(simulation.get_agent_num_agent_neighbors(index) for index in range(count)) / count
    return seconds / (repeats * RUNS * STEPS * count), neighbours / (repeats * (RUNS + 1))


def crowding(positions, range):
    """How many others are within `range` (m) of a robot, on average."""
    return 2.0 * len(cKDTree(positions).query_pairs(range)) / len(positions)


def scenario(folder, count, steps):
    """The scenario of the bench as a file of so many steps, of which the first and the last are recorded."""
    [goal], duration = rows(folder, f"goal_{count}.txt"), steps * TICK
    discs = "".join(f"- {{disc: {disc}, radius: 0.5}}\n" for disc in rows(folder, f"discs_{count}.txt"))
    robots = "".join(f"- {{position: {start}}}\n" for start in rows(folder, f"starts_{count}.txt"))
    length = 1.2 * (count + 3)
    path = folder / f"crowd_{count}_{steps}.yaml"
    path.write_text(
        f"""name: crowd
kind: nearest_points
method: semi_implicit_euler
step: {TICK}
duration: {duration:.3f}
record_every: {duration:.3f}
segment: {{kind: sinusoid, origin: [0.0, 0.0], direction: 0.0, length: {length!r}, amplitude: 4.0, wavelength: 40.0}}
team_goal: {goal}
trench: {{kind: hyperbolic, alpha: 0.5, a: 0.5}}
damping: 2.0
zoning: {{rho_underbar: 0.4, rho_hat: 1.0, rho: 3.0, rho_check: 6.0, rho_bar: 10.0, alpha: 0.2, beta: 0.05, m: 1, edge: continuous, full_acceleration: 1.0}}
obstacle_potential: {{pole: 0.2, cut: 0.5, strength: 0.1, m: 1, edge: continuous, full_acceleration: 0.5}}
clearance: 1.0
encroaching: obstacles
sidesteps: true
limits: {{speed: {SPEED}, acceleration: 2.0}}
safety: {{body_radius: 0.11}}
seeking: {{room: 0.05, transit_margin: 0.05, settled_distance: 0.1, settled_speed: 0.05}}
obstacles:
{discs}robots:
{robots}"""
    )
    return path


def simulated(program, path, threads, *more):
    """Seconds that `trench sim` says it took."""
    command = [program, "sim", path, "--threads", str(threads), *more]
    said = subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True).stderr
    return float(re.search(r"simulated in ([0-9.]+) s", said).group(1))


def check_motion(program, folder, count):
    """After as many steps as the bench makes, the robots of `trench sim` are where its are."""
    steps, table = 16 * STEPS, folder / "moved.csv"
    simulated(program, scenario(folder, count, steps), 1, "--csv", table)
    with table.open() as lines:
        last = {row["robot"]: [float(row["x"]), float(row["y"])] for row in csv.DictReader(lines)}
    if [last[f"r{rank}"] for rank in range(1, count + 1)] != rows(folder, f"moved_{count}.txt"):
        sys.exit(f"{count} robots of trench sim are not where the library's are")


def library(folder):
    """Seconds an agent step of the library, on one thread and on two; leaves starts, ends and motion in the folder."""
    bench = ["cargo", "bench", "--quiet", "-p", "trench_formation", "--bench", "crowd", "--", folder]
    subprocess.run(bench, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    return {count: rows(folder, f"times_{count}.txt")[0] for count in COUNTS}


def round_of(program, folder, paths):
    """Seconds an agent step of each, for few robots and for many: the mean of as many agent steps of few as of many."""
    ours, turn = library(folder), {}
    for count in COUNTS:
        runs = max(COUNTS) // count
        starts, ends = (rows(folder, f"{name}_{count}.txt") for name in ("starts", "ends"))
        theirs, neighbours = peer(starts, ends, runs)
        turn[count] = {"library": ours[count][0], "two": ours[count][1], "pyrvo": theirs, "neighbours": neighbours}
        if program:
            steps = runs * SIM_STEPS * count
            turn[count]["trench sim"] = sum(simulated(program, paths[count], 1) for _ in range(runs)) / steps
    return turn


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else None
    with tempfile.TemporaryDirectory() as name:
        folder, paths = Path(name), {}
        library(folder)
        for count in COUNTS if program else ():
            check_motion(program, folder, count)
            paths[count] = scenario(folder, count, SIM_STEPS)
        turns = [round_of(program, folder, paths) for _ in range(ROUNDS)]
        print(f"an agent step, best (median) of {ROUNDS} rounds by turns; equal motion in all of ours")
        programs = ["library"] + (["trench sim"] if program else [])
        for count in COUNTS:
            mean = {what: sorted(turn[count][what] for turn in turns) for what in turns[0][count]}
            near = crowding(rows(folder, f"moved_{count}.txt"), RANGE)
            print(
                f"{count:>6} robots: {near:.1f} others within {RANGE} m at the end; pyrvo {1e6 * mean['pyrvo'][0]:.3f} "
                f"({1e6 * statistics.median(mean['pyrvo']):.3f}) us with {mean['neighbours'][0]:.1f} neighbours; library on two threads {1e6 * mean['two'][0]:.3f} us"
            )
            for what in programs:
                best, middle = mean[what][0], statistics.median(mean[what])
                print(
                    f"{count:>6} robots, {what}: {1e6 * best:.3f} ({1e6 * middle:.3f}) us, {1e-6 / best:.2f} million a second; "
                    f"{mean['pyrvo'][0] / best:.2f} times"
                )
        for what in programs:
            few, many = (min(turn[count][what] for turn in turns) for count in COUNTS)
            print(f"a robot of {max(COUNTS)} costs {100 * (many / few - 1):.0f} % more than one of {min(COUNTS)}, {what}")


if __name__ == "__main__":
    main()
