"""Whether robots move only on what is new enough, and when they stand: from ground truth."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from bag import STANDS, TURNS, Run, Series

# s, the oldest information that may drive a robot.
AGE = 0.25
# s, from one sample of ground truth to the next.
FRAME = 0.034
# m/s and m/s^2: below the first the steppers stop at once, from above they come down to it with the second (crates/sim/src/stepper.rs).
PULL_IN, RAMP = 0.08, 0.5
# m, from the middle of a robot to a wheel.
HALF_AXLE = 0.06


def moves(state: tuple) -> bool:
    """Whether a robot drives or turns."""
    return state[2] > STANDS or abs(state[3]) > TURNS


def braking(truth: Series, start: float, end: float) -> float:
    """How long the faster wheel of a robot takes to stop from its highest speed between the two times, s."""
    fastest = max((state[2] + HALF_AXLE * abs(state[3]) for _, state in truth.between(start, end)), default=0.0)
    return max(0.0, fastest - PULL_IN) / RAMP


def allowed(truth: Series, began: float, age: float = AGE) -> float:
    """How long after a stage fell silent a robot may still move: while it has information that is not too old, and then to brake."""
    return age + FRAME + braking(truth, began - FRAME, began + age)


def standstill(bag: Run, robots: list[str], began: float, ended: float) -> float | None:
    """How long after the beginning the last of the robots stood for the rest of the time; none if it never did, or nobody saw."""
    latest = 0.0
    for robot in robots:
        seen = bag.truth[robot].between(began, ended)
        if not seen or ended - seen[-1][0] > 3.0 * FRAME:
            return None
        moving = [at for at, state in seen if moves(state)]
        if moving and moving[-1] > ended - 0.04:
            return None
        latest = max(latest, moving[-1] - began if moving else 0.0)
    return latest


@dataclass
class Span:
    """For how long a robot moved, or stood, without a break: first and last sample, and the first one after them."""

    moving: bool
    first: float
    last: float
    following: float | None = None


def spans(bag: Run, began: float, until: float, without: Sequence[str] = ()) -> list[Span]:
    """Those of every robot but some between two times."""
    found: list[Span] = []
    for series in (series for robot, series in bag.truth.items() if robot not in without):
        span = None
        for at, state in series.between(began, until):
            moving = moves(state)
            if span and span.moving == moving:
                span.last = at
                continue
            if span:
                span.following = at
            span = Span(moving, at, at)
            found.append(span)
    return found


def stretch(bag: Run, began: float, until: float) -> float:
    """How long a robot moved at most without standing still."""
    return max((span.last - span.first for span in spans(bag, began, until) if span.moving), default=0.0)


def rest(bag: Run, began: float, until: float) -> float:
    """How long a robot stood at most that then moved on: at the end of its way it stands for good."""
    return max((span.following - span.first for span in spans(bag, began, until) if not span.moving and span.following), default=0.0)


def idle(bag: Run, began: float, until: float, without: Sequence[str]) -> float:
    """How long a robot, but for some, stood at most, whether it moved on or not."""
    return max(((span.following or until) - span.first for span in spans(bag, began, until, without) if not span.moving), default=0.0)


def resting_share(bag: Run, began: float, until: float) -> float:
    """For which share of the time the robot that stood least did stand; nothing of whom nobody saw."""
    seen = [[moves(state) for _, state in series.between(began, until)] for series in bag.truth.values()]
    return min((moving.count(False) / len(moving) if moving else 0.0 for moving in seen), default=0.0)


def stale(bag: Run, basis: dict[str, Series]) -> list[str]:
    """Robots that move although the newest information that their wheels were told to turn on is too old, and braking would be over."""
    problems = []
    for robot, series in bag.truth.items():
        known = basis.get(robot, Series())
        for at, state in series.between(bag.t0 or math.inf, bag.stopped or math.inf):
            newest = known.at(at + FRAME) or 0.0
            if not moves(state) or at - newest <= AGE + FRAME:
                continue
            latest = newest + AGE + FRAME
            if at > latest + braking(series, latest - FRAME, latest + FRAME):
                problems.append(f"{robot} moves at {at - bag.t0:.2f} s on information of {at - newest:.2f} s ago")
                break
    return problems


def burst(bag: Run, since: float) -> list[str]:
    """Old commands that controllers send in the second after a process goes on."""
    problems = []
    for robot, stamps in bag.stamps.items():
        for (at, stamp), (_, command) in zip(stamps.between(since, since + 1.0), bag.commands[robot].between(since, since + 1.0)):
            if command != (0.0, 0.0) and at - stamp > AGE + FRAME:
                problems.append(f"{robot} was commanded to move on information of {at - stamp:.2f} s ago, {at - since:.2f} s after SIGCONT")
                break
    return problems
