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

SPEED = 0.5
TICK = 0.033
STEPS = 20
COUNTS = (250, 20000)
# Of a run of `trench sim`, for few and many robots alike, so that what a run does once weighs the same.
SIM_STEPS = 3200
SIM_ROUNDS = 5
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


def sims(program, folder):
    """Best and median seconds an agent step of `trench sim` on one thread, and the best on two, for few robots and for many.

    By turns: one run of many, then as many of few as make as many agent steps. A run of few by itself lasts a tenth of a second, and
    the best of some of those is of a moment in which nobody else was at the caches; that of many would need eight such seconds.
    """
    paths = {}
    for count in COUNTS:
        check_motion(program, folder, count)
        paths[count] = scenario(folder, count, SIM_STEPS)

    def cost(count, threads, runs):
        return sum(simulated(program, paths[count], threads) for _ in range(runs)) / (runs * SIM_STEPS * count)

    one = [{count: cost(count, 1, max(COUNTS) // count) for count in COUNTS} for _ in range(SIM_ROUNDS)]
    two = [{count: cost(count, 2, 1) for count in COUNTS} for _ in range(SIM_ROUNDS)]
    times = {count: sorted(turn[count] for turn in one) for count in COUNTS}
    return {count: (times[count][0], statistics.median(times[count]), min(turn[count] for turn in two)) for count in COUNTS}


def main():
    root = Path(__file__).resolve().parents[2]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bench = ["cargo", "bench", "--quiet", "-p", "trench_formation", "--bench", "crowd", "--", name]
        subprocess.run(bench, cwd=root, check=True, stdout=subprocess.DEVNULL)
        lines = (line.split("\t") for line in (folder / "times.tsv").read_text().splitlines())
        ours = {name: (float(best), float(median)) for name, best, median in lines}
        print("best (median) of 15, an agent step; equal motion on one thread and two")
        peers, costs = {}, {"library": []}
        for count in COUNTS:
            best, median, neighbours = peer(rows(folder, f"starts_{count}.txt"), rows(folder, f"ends_{count}.txt"))
            (mine, middle), (both, _) = (ours[f"crowd: {count} robots, {threads} threads"] for threads in (1, 2))
            near = crowding(rows(folder, f"moved_{count}.txt"), RANGE)
            print(
                f"{count:>6} robots: ours {1e6 * mine:.3f} ({1e6 * middle:.3f}) us, {1e-6 / mine:.2f} million a second; on two "
                f"threads {1e6 * both:.3f} us, {near:.1f} others within {RANGE} m at the end; pyrvo {1e6 * best:.3f} ({1e6 * median:.3f}) us with {neighbours:.1f} neighbours; "
                f"{best / mine:.2f} times"
            )
            peers[count] = best
            costs["library"].append(mine)
        if len(sys.argv) > 1:
            print(f"best (median) of {SIM_ROUNDS} rounds by turns, of as many agent steps each")
            simulated_costs = sims(sys.argv[1], folder)
            for count, (mine, middle, both) in simulated_costs.items():
                print(
                    f"{count:>6} robots, trench sim: {1e6 * mine:.3f} ({1e6 * middle:.3f}) us, {1e-6 / mine:.2f} million a second; on two "
                    f"threads {1e6 * both:.3f} us; pyrvo {1e6 * peers[count]:.3f} us; {peers[count] / mine:.2f} times"
                )
            costs["trench sim"] = [mine for mine, _, _ in simulated_costs.values()]
        for name, (few, many) in costs.items():
            print(f"a robot of 20000 costs {100 * (many / few - 1):.0f} % more than one of 250, {name}")


if __name__ == "__main__":
    main()
