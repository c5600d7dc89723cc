"""Whether robots were beside obstacles when something happened: by ground truth."""

import math
from pathlib import Path

import yaml

from bag import Run

ROOT = Path(__file__).resolve().parents[2]
# m: a robot's body, and the room beside it within which an obstacle keeps it off its way.
BODY, NEAR = 0.08, 0.05
# s, after the end of a fault in which it still counts: robots drive on.
AFTER = 1.0


def discs(run: dict) -> list[tuple[float, float, float]]:
    """Middle and radius of each obstacle of a run, m; all of them are discs."""
    file = run["arguments"].get("obstacles")
    told = yaml.safe_load((ROOT / file).read_text(encoding="utf-8"))["obstacles"] if file else []
    return [(*obstacle["polygon"][0], obstacle["radius"]) for obstacle in told]


def room(bag: Run, run: dict, began: float, ended: float) -> float:
    """The least room between a robot and an obstacle meanwhile, m."""
    states = [state for series in bag.truth.values() for _, state in series.between(began, ended + AFTER)]
    return min((math.dist(state[:2], disc[:2]) - disc[2] - BODY for state in states for disc in discs(run)), default=math.inf)
