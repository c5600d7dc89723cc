"""Hulls, nearest points and assignments: Trench against shapely (GEOS) and scipy, on the same input in one run, on one thread.

    python3 -m venv VENV && VENV/bin/pip install -r benches/peers/requirements.txt
    VENV/bin/python benches/peers/geometry.py

(`scripts/bench geometry` does both.) Builds and runs `cargo bench -p trench_formation --bench peers`, which leaves input, results
and times in a temporary folder; then has the peers do the same, compares the results, and prints the ratios. Exit code 1 if
results differ.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np
import shapely
from scipy.optimize import linear_sum_assignment
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

CLEARANCE = 1.0
failures = []


def timed(run, runs, operations=1):
    """The result, and best and median seconds an operation."""
    result, seconds = run(), []
    for _ in range(runs):
        start = time.perf_counter()
        result = run()
        seconds.append((time.perf_counter() - start) / operations)
    return result, min(seconds), statistics.median(seconds)


def rows(folder, name):
    return [np.array(line.split(), dtype=float) for line in (folder / name).read_text().splitlines()]


def expect(what, holds):
    print(f"  {what}: {'yes' if holds else 'NO'}")
    if not holds:
        failures.append(what)


def combined(hulls):
    """Hulls joined until none are nearer to each other than the clearance, and the members of each."""
    members = np.arange(len(hulls))
    rounds = 0
    while True:
        tree = shapely.STRtree(hulls)
        first, second = tree.query(hulls, predicate="dwithin", distance=CLEARANCE)
        near = first < second
        first, second = first[near], second[near]
        near = shapely.distance(hulls[first], hulls[second]) < CLEARANCE
        first, second = first[near], second[near]
        if len(first) == 0:
            return hulls, members, rounds
        rounds += 1
        count = len(hulls)
        graph = coo_array((np.ones(len(first)), (first, second)), shape=(count, count))
        groups, labels = connected_components(graph, directed=False)
        order = np.argsort(labels, kind="stable")
        coordinates, owners = shapely.get_coordinates(hulls[order], return_index=True)
        owners = labels[order][owners]
        joined = shapely.multipoints(shapely.points(coordinates), indices=owners)
        sizes = np.bincount(labels, minlength=groups)
        alone = sizes[labels[order]] == 1
        result = np.empty(groups, dtype=object)
        result[labels[order][alone]] = hulls[order][alone]
        several = np.flatnonzero(sizes > 1)
        result[several] = shapely.convex_hull(joined[several])
        hulls, members = result, labels[members]


def hulls(folder, ours):
    polygons = shapely.polygons(np.array(rows(folder, "polygons.txt")).reshape(-1, 12, 2))
    (single, best, median) = timed(lambda: shapely.convex_hull(polygons), 5)
    report("hulls: polygons to shapes", ours, best, median)
    (result, best, median) = timed(lambda: combined(single), 5)
    report("hulls: combined to the fixpoint", ours, best, median)
    peers, labels, rounds = result
    print(f"  GEOS: {len(peers)} hulls after {rounds} rounds")
    mine = [shapely.polygons(row.reshape(-1, 2)) for row in rows(folder, "hulls.txt")]
    groups = {tuple(row.astype(int)) for row in rows(folder, "members.txt")}
    by_label = {}
    for index, label in enumerate(labels):
        by_label.setdefault(label, []).append(index)
    expect("the same members in every hull", groups == {tuple(group) for group in by_label.values()})
    key = lambda hull: hull.bounds
    pairs = zip(sorted(mine, key=key), sorted(peers, key=key))
    equal = all(shapely.equals_exact(shapely.normalize(a), shapely.normalize(b), 1e-12) for a, b in pairs)
    expect("every hull equal to GEOS's, corner by corner", equal)


def nearest(folder, ours):
    points = shapely.points(np.array(rows(folder, "queries.txt")))
    for pieces in (100, 2000):
        corners = np.array(rows(folder, f"corners_{pieces}.txt"))
        chords = shapely.linestrings(np.stack([corners[:-1], corners[1:]], axis=1))
        tree = shapely.STRtree(chords)
        ask = lambda: tree.query_nearest(points, return_distance=True, all_matches=False)
        ((_, distances), best, median) = timed(ask, 5, len(points))
        report(f"nearest: polyline of {pieces}, anywhere", ours, best, median)
        report(f"nearest: polyline of {pieces}, along a way", ours, best, median)
        report(f"nearest: polyline of {pieces}, warm", ours, best, median)
        report(f"nearest: spline of {pieces}, anywhere", ours, best, median)
        report(f"nearest: spline of {pieces}, along a way", ours, best, median)
        mine = np.array(rows(folder, f"polyline_{pieces}.txt"))[:, 2]
        expect("distances equal to GEOS's", np.abs(mine - distances).max() < 1e-9)


def assignments(folder, ours):
    for count, runs in ((100, 200), (1000, 9)):
        robots, places = (np.array(rows(folder, f"{name}_{count}.txt")) for name in ("robots", "places"))
        costs = ((robots[:, None, :] - places[None, :, :]) ** 2).sum(axis=2)
        ((_, columns), best, median) = timed(lambda: linear_sum_assignment(costs), runs)
        report(f"assignment: {count}", ours, best, median)
        report(f"assignment: {count} again, robots moved 1 %", ours, best, median)
        mine = np.array(rows(folder, f"assignment_{count}.txt"))[:, 0].astype(int)
        total = lambda chosen: costs[np.arange(count), chosen].sum()
        expect("total cost equal to scipy's", abs(total(mine) - total(columns)) < 1e-12 * count)


def report(name, ours, best, median):
    if name in ours:
        mine = ours[name]
        print(
            f"{name:<46} ours {1e6 * mine[0]:>9.3f} us ({1e6 * mine[1]:.3f}), "
            f"peer {1e6 * best:>9.3f} us ({1e6 * median:.3f}): {best / mine[0]:.1f} times"
        )


def main():
    root = Path(__file__).resolve().parents[2]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bench = ["cargo", "bench", "--quiet", "-p", "trench_formation", "--bench", "peers", "--", name]
        subprocess.run(bench, cwd=root, check=True, stdout=subprocess.DEVNULL)
        lines = (line.split("\t") for line in (folder / "times.tsv").read_text().splitlines())
        ours = {name: (float(best), float(median)) for name, best, median in lines}
        print("best (median) seconds an operation; ratios of the best")
        for judge in (hulls, nearest, assignments):
            judge(folder, ours)
    if failures:
        sys.exit(f"results differ: {', '.join(failures)}")


if __name__ == "__main__":
    main()
