"""Judges a fault run from its bag: ground truth and diagnostics."""

import bisect
import math
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

from bag import NEAR, STANDS, TURNS, Run, Series
from verdict import Verdict

# s, from a fault's beginning to the diagnostic that names it.
DIAGNOSTIC = 0.5
# s, from a fault's beginning to standstill where control cannot be safe: 0.25 s of old information, braking from 0.1 m/s.
STANDSTILL = 0.6
# s, from a fault's end until every robot is driven again, and until the formation stands again.
RECOVERY, FORMATION = 2.0, 10.0
# rad/s and m/s, beyond which no command goes.
LIMITS = (0.31, 5.0)
# What is published where a fault does this are commands of somebody else, too.
FOREIGN = ("foreign_command", "not_numbers", "past_and_future", "wrong_sizes")
# bytes, by which a process may grow in a run.
GROWTH = 10_000_000
# s, the longest gap in the bag.
GAP = 1.0
# s, within which nodes end when their launcher was killed.
ORPHANED = 1.0
OK = b"\x00"
# Who names a fault elsewhere than on /diagnostics (act.py looks there): the launcher, and a process that refuses to start.
REPORTERS = ("launcher", "itself")
# With which a second process of a node ends.
TAKEN = 5


@dataclass
class Evidence:
    """What a run left."""

    bag: Path
    log: str
    exit_code: int
    memory: list[dict[str, int]]
    alive_after: float | None
    own_bag: Path
    binaries: Path
    seen: Path


def judge(run: dict, windows: list, evidence: Evidence) -> list[Verdict]:
    """A verdict on each fault of the run."""
    bag = Run(evidence.bag, run.get("clocks", False))
    counts: dict[str, int] = {}
    for fault in run["faults"]:
        if "bed" not in fault:
            continue
        kind = fault["bed"]["kind"]
        window = bag.bed_window(kind, counts.get(kind, 0))
        counts[kind] = counts.get(kind, 0) + 1
        windows.append((fault, *(window or (0.0, 0.0))))
    # A fault is judged until the next one begins.
    begins = sorted(began for _, began, _ in windows) + [math.inf]
    verdicts = [
        one(bag, run, fault, (began, ended, begins[bisect.bisect_right(begins, began)]), evidence)
        for fault, began, ended in windows
    ]
    general = whole(bag, run, evidence)
    for verdict in verdicts:
        verdict.problems += general
    return verdicts


def one(bag: Run, run: dict, fault: dict, window: tuple[float, float, float], evidence: Evidence) -> Verdict:
    """A verdict on one fault: when it began, was over, and when the next begins."""
    began, ended, following = window
    verdict = Verdict(fault["name"], run["name"])
    if began == 0.0:
        verdict.problems.append("it never began")
        return verdict
    # What is carried to touch somebody does so at once.
    since = began + (0.2 if fault.get("touches") else 0.0)
    contacts = [text for at, text in bag.contacts if since <= at <= ended + FORMATION]
    if contacts:
        verdict.problems.append(f"contact: {contacts[0]}")
    diagnose(bag, fault, began + fault.get("later", 0.0), evidence, verdict)
    if fault.get("ends"):
        if evidence.alive_after is None or evidence.alive_after > ORPHANED:
            verdict.problems.append(f"nodes lived on for {evidence.alive_after} s")
        verdict.stood = standstill(bag, sorted(bag.truth), began, began + ORPHANED)
        return verdict
    if "double" in fault and fault["code"] != TAKEN:
        verdict.problems.append(f"the second {fault['double']} ended with {fault['code']}, not {TAKEN}")
    if "bag" in fault and (lost := lost_at(evidence, began)) > GAP:
        verdict.problems.append(f"the bag ends {lost:.1f} s before the fault")
    if "images" in fault:
        came = [at for at, _ in Run(evidence.seen).images.between(began, ended)]
        waits = [later - earlier for earlier, later in zip([began, *came], [*came, ended])]
        if max(waits) > fault["images"]:
            verdict.problems.append(f"no image came for {max(waits):.1f} s")
    stopped = sorted(bag.truth) if fault.get("stops") else fault.get("halts", [])
    if stopped:
        verdict.stood = standstill(bag, stopped, began, ended)
        if verdict.stood is None or verdict.stood > STANDSTILL:
            verdict.problems.append(f"{', '.join(stopped)} did not stand within {STANDSTILL} s")
    if "kill" in fault:
        verdict.rested = rest(bag, began, min(began + FORMATION, following))
    recover(bag, ended, min(ended + FORMATION, following), verdict, settles=not fault.get("unsettled"))
    return verdict


def lost_at(evidence: Evidence, began: float) -> float:
    """How much of what came before the fault the bag of the launch does not have, s; infinite if it cannot be read."""
    whole_bag = evidence.own_bag.with_name("own-bag-recovered")
    trench = str(evidence.binaries / "trench")
    done = subprocess.run([trench, "bag", "recover", str(evidence.own_bag), str(whole_bag)], check=False)
    times = Run(whole_bag).log_times if done.returncode == 0 else []
    return began - max((at for at in times if at <= began), default=-math.inf)


def diagnose(bag: Run, fault: dict, began: float, evidence: Evidence, verdict: Verdict) -> None:
    """When the fault was named, if anybody can know of it (a reason why not is told by `unnamed`)."""
    pattern = fault.get("says")
    if "warns" in fault:
        pattern = fault["warns"]
        lines = re.findall(r"\[(?:WARN|ERROR)\] \[(\d+\.\d+)\] \[[\w.]+\]: (.*)", evidence.log)
        times = [float(at) - began for at, text in lines if float(at) >= began and re.search(pattern, text)]
    elif pattern in REPORTERS:
        times = [fault["reported"]] if "reported" in fault else []
    elif pattern is not None:
        times = [at - began for at, text, level in bag.diagnostics if at >= began and level != OK and re.search(pattern, text)]
    else:
        if "unnamed" not in fault:
            verdict.problems.append("the matrix does not say what names it, or why nobody can")
        return
    verdict.diagnosed = min(times, default=None)
    if verdict.diagnosed is None or verdict.diagnosed > DIAGNOSTIC:
        verdict.problems.append(f"nothing like {pattern!r} named it within {DIAGNOSTIC} s")


def standstill(bag: Run, robots: list[str], began: float, ended: float) -> float | None:
    """How long after the beginning the last of the robots stood for the rest of the fault; none if it never did."""
    latest = 0.0
    for robot in robots:
        moving = [at for at, state in bag.truth[robot].between(began, ended) if state[2] > STANDS or abs(state[3]) > TURNS]
        if moving and moving[-1] > ended - 0.04:
            return None
        latest = max(latest, moving[-1] - began if moving else 0.0)
    return latest


def rest(bag: Run, began: float, until: float) -> float:
    """How long a robot stood at most that then moved on: at the end of its way it stands for good."""
    longest = 0.0
    for series in bag.truth.values():
        since = None
        for at, state in series.between(began, until):
            if state[2] <= STANDS and abs(state[3]) <= TURNS:
                since = at if since is None else since
            elif since is not None:
                longest, since = max(longest, at - since), None
    return longest


def since_when(holds, ended: float, until: float) -> float | None:
    """How long after the end something begins to hold until the next fault; none if it does not."""
    steps = [ended + 0.05 * step for step in range(int((until - ended) / 0.05))]
    failed = [at for at in steps if not holds(at)]
    if not steps or (failed and failed[-1] == steps[-1]):
        return None
    return failed[-1] + 0.05 - ended if failed else 0.0


def recover(bag: Run, ended: float, until: float, verdict: Verdict, settles: bool) -> None:
    """When all robots were driven again, and, where there is time to, when the formation stood, for the rest of it."""
    robots = sorted(bag.truth)
    until = min(until, max(series.times[-1] for series in bag.truth.values()), bag.stopped or math.inf)
    verdict.recovered = since_when(lambda at: all(bag.is_driven(robot, at) for robot in robots), ended, until)
    if verdict.recovered is None or verdict.recovered > RECOVERY:
        verdict.problems.append(f"not all robots were driven within {RECOVERY} s of its end")
    if not settles:
        return

    def stands(at: float) -> bool:
        distances = [bag.distance(robot, at) for robot in robots]
        return all(distance is not None and distance < NEAR for distance in distances)

    verdict.formed = since_when(stands, ended, until)
    if verdict.formed is None:
        far = {robot: bag.distance(robot, until - 0.1) for robot in robots}
        verdict.problems.append(f"the formation did not stand within {until - ended:.1f} s: {far}")


def stale(bag: Run, heard: dict[str, Series]) -> list[str]:
    """Robots that move although all that their commands rest on, as they were heard, is too old: 0.25 s, and the time to brake."""
    problems = []
    for robot, series in bag.truth.items():
        basis = heard.get(robot, Series())
        for at, state in series.between(bag.t0 or math.inf, bag.stopped or math.inf):
            newest = basis.at(at)
            if state[2] > STANDS and (newest is None or at - newest > STANDSTILL):
                problems.append(f"{robot} moves at {at - bag.t0:.2f} s on information of {at - (newest or 0.0):.2f} s ago")
                break
    return problems


def whole(bag: Run, run: dict, evidence: Evidence) -> list[str]:
    """What is wrong with the run as a whole."""
    problems = []
    for robot, series in bag.commands.items():
        foreign = any(fault.get("publish") in FOREIGN for fault in run["faults"])
        # Written so that what is no number is beyond too.
        beyond = [value for value in series.values if not (abs(value[0]) <= LIMITS[0] and abs(value[1]) <= LIMITS[1])]
        if beyond and not foreign:
            problems.append(f"a command for {robot} is beyond its limits: {beyond[0]}")
    victims = {str(fault.get("kill", fault.get("victim", ""))).split("/")[-1] for fault in run["faults"]} - {""}
    for label, status in re.findall(r"\[([\w/.-]+)\]: process has died \[pid \d+, ([^\]]*)\]", evidence.log):
        if label.rsplit("-", 1)[0] not in victims and "operator" not in label:
            problems.append(f"{label} died too: {status}")
    if not any(fault.get("ends") for fault in run["faults"]) and evidence.exit_code != 0:
        problems.append(f"the run ended with {evidence.exit_code}")
    if len(evidence.memory) == 2:
        before, after = evidence.memory
        for label in before.keys() & after.keys():
            if after[label] - before[label] > GROWTH:
                problems.append(f"{label} grew by {(after[label] - before[label]) / 1e6:.1f} MB")
    problems += stale(bag, Run(evidence.seen).basis if evidence.seen.exists() else bag.basis)
    gaps = [later - earlier for earlier, later in zip(bag.log_times, bag.log_times[1:])]
    if not gaps or max(gaps) > GAP:
        problems.append(f"the bag has a gap of {max(gaps, default=math.inf):.1f} s")
    return problems
