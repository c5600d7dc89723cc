"""Judges a fault run from its bag: ground truth and diagnostics."""

import bisect
import math
import re

import beside
import wheels
from air import air
from bag import NEAR, Run
from evidence import Evidence
from hosts import BASE
from left import GAP, left_behind, recorded
from motion import AGE, FRAME, allowed, burst, idle, moves, rest, resting_share, spans, stale, standstill, stretch
from verdict import Verdict

# s, from a fault's beginning to the diagnostic that names it.
DIAGNOSTIC = 0.5
# s, before a fault's beginning, in which nothing may say what names it, and by how much the bed may tell of its beginning later than
# nodes do that met it.
BEFORE, LATE = 0.8, 0.1
# s, from a fault's end until every robot is driven again, and until the formation stands again.
RECOVERY, FORMATION = 2.0, 10.0
# s, for which a robot may stand as any does on its way.
STALLED = 0.1
# s, in which a robot drives again that a restarted process drives, and from a robot's silence to an assignment without it: 2 s
# (`age.robot`), looked at once a second.
RESUMED, QUIT = 1.0, 3.0
# s, after a fault's end in which `drives` holds on: a fault of an instant would be no test of it.
AFTERWARDS = 1.0
# s, within which a robot moves that is driven, and m/s, below which a goal point rests.
LATELY, RESTS = 0.5, 0.005
# rad/s and m/s, beyond which no command goes.
LIMITS = (0.31, 5.0)
# m, between the middles of two robots that touch, and s, within which one that is carried to touch somebody does.
TOUCH, PUT = 0.16, 0.2
# What the test bed says of two robots; else it is `obstacle 3` or `west edge` that is touched.
ROBOTS_TOUCH = re.compile(r" touches robot\d+$")
# bytes, by which a process may grow in a run.
GROWTH = 10_000_000
# s, within which nodes end when their launcher was killed.
ORPHANED = 1.0
OK = b"\x00"
# Who names a fault elsewhere than on /diagnostics (act.py looks there): the launcher, which says it there too, and a process that refuses to start.
REPORTERS = ("launcher", "launcher's log", "itself")
# What the launcher says on /diagnostics of a process that dies or is stopped, as long as it does not run.
ENDS = r"(?:has died (?!.*was started again)|was stopped by a signal and does nothing)"
# With which a second process of a node ends.
TAKEN = 5


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
    for fault, began, _ in windows:
        fault["began"] = began
    # A fault is judged until the next one begins.
    begins = sorted(began for _, began, _ in windows) + [math.inf]
    verdicts = [
        one(bag, run, fault, (began, ended, begins[bisect.bisect_right(begins, began)]), evidence)
        for fault, began, ended in windows
    ]
    general = whole(bag, run, evidence) + contacts(bag, windows)
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
    verdict.lasted = ended - began
    if fault.get("touches") and bag.nearest(fault["touches"], began, began + PUT) > TOUCH:
        verdict.problems.append(f"{fault['touches']} touched nobody")
    if fault.get("rounds") and (room := beside.room(bag, run, began, ended)) > beside.NEAR:
        verdict.problems.append(f"no robot went round an obstacle: {room:.2f} m of room")
    diagnose(bag, fault, began, evidence, verdict)
    stopped = sorted(bag.truth) if fault.get("stops") or fault.get("ends") else fault.get("halts", [])
    resting = [robot for robot in stopped if not any(moves(state) for _, state in bag.truth[robot].between(began - 1.0, began))]
    if resting:
        verdict.problems.append(f"{', '.join(resting)} stood before it: that they stand says nothing")
    if fault.get("ends"):
        if evidence.alive_after is None or evidence.alive_after > ORPHANED:
            verdict.problems.append(f"nodes lived on for {evidence.alive_after} s")
        # The bed lives on: what robots do without anybody can be seen.
        verdict.stood = standstill(bag, stopped, began, began + 2.0 * ORPHANED)
        if verdict.stood is None or verdict.stood > ORPHANED:
            verdict.problems.append(f"robots did not stand within {ORPHANED} s")
        return verdict
    if "double" in fault and fault["code"] != TAKEN:
        verdict.problems.append(f"the second {fault['double']} ended with {fault['code']}, not {TAKEN}")
    if fault.get("alive_after", 0.0) > ORPHANED:
        verdict.problems.append(f"nodes lived on for {fault['alive_after']:.1f} s")
    if "bag" in fault:
        verdict.problems += left_behind(evidence, fault["bag"], began)
    if "images" in fault:
        came = [at for at, _ in Run(evidence.seen).images.between(began, ended)]
        waits = [later - earlier for earlier, later in zip([began, *came], [*came, ended])]
        if max(waits) > fault["images"]:
            verdict.problems.append(f"no image came for {max(waits):.1f} s")
    if stopped:
        verdict.stood = standstill(bag, stopped, began, ended)
        most = max(allowed(bag.truth[robot], began, fault.get("age", AGE)) for robot in stopped)
        if verdict.stood is None or verdict.stood > most:
            told = "never" if verdict.stood is None else f"after {verdict.stood:.2f} s"
            verdict.problems.append(f"{', '.join(stopped)} stood {told}, not within {most:.2f} s")
    verdict.problems += air(bag, fault, began, ended)
    # As everywhere, what stands is seen to do so a frame late.
    if "pulses" in fault and (longest := stretch(bag, began + AGE, ended)) > fault["pulses"] + FRAME:
        verdict.problems.append(f"a robot moved for {longest:.2f} s at a time")
    if "drives" in fault:
        spared = [*fault.get("halts", []), *fault.get("spares", [])]
        if (stood := idle(bag, began, min(ended + AFTERWARDS, following), spared)) > fault["drives"]:
            verdict.problems.append(f"a robot stood for {stood:.2f} s, although nothing keeps it from driving")
    if "rests" in fault and (least := resting_share(bag, began, ended)) < fault["rests"]:
        verdict.problems.append(f"a robot stood for {least:.0%} of the time, not {fault['rests']:.0%}")
    if "kill" in fault or "launcher" in fault:
        verdict.rested = rest(bag, began, min(ended + FORMATION, following))
        if "kill" in fault and verdict.rested > ended - began + RESUMED:
            verdict.problems.append(f"a robot rested for {verdict.rested:.2f} s, and the victim lived again after {ended - began:.2f} s")
    if "pause" in fault:
        # Where robots' hosts have recorders of their own, what was held back on the way to the base station's was not sent then.
        said = [Run(folder, run.get("clocks", False)) for folder in sorted(evidence.spoken.glob("*"))]
        verdict.problems += [problem for record in said or [bag] for problem in burst(record, ended)]
    structure(bag, fault, (began, ended, min(ended + FORMATION, following)), verdict)
    recover(bag, ended, min(ended + FORMATION, following), verdict, fault)
    return verdict


def diagnose(bag: Run, fault: dict, began: float, evidence: Evidence, verdict: Verdict) -> None:
    """When the fault was named, if anybody can know of it (a reason why not is told by `unnamed`); before, it must not have been."""
    pattern = fault.get("says")
    harm = began + fault.get("later", 0.0)
    if fault.get("stalls"):
        stood = [span.first for span in spans(bag, began, began + fault["for"]) if not span.moving and span.last - span.first > STALLED]
        if not stood:
            return
        said = [at for at, (_, text, level) in zip(bag.said, bag.diagnostics) if level != OK and re.search(pattern, text)]
        verdict.diagnosed = min((at - min(stood) for at in said if at >= began - BEFORE), default=None)
        if verdict.diagnosed is None or verdict.diagnosed > DIAGNOSTIC:
            verdict.problems.append(f"nothing like {pattern!r} named within {DIAGNOSTIC} s why robots stand")
        return
    if "warns" in fault:
        pattern = fault["warns"]
        said = "\n".join(evidence.logs.values())
        lines = re.findall(r"\[(?:WARN|ERROR)\] \[(\d+\.\d+)\] \[[\w.]+\]: (.*)", said)
        times = [float(at) - harm for at, text in lines if float(at) >= began - BEFORE and re.search(pattern, text)]
    elif pattern in REPORTERS:
        times = [fault["reported"]] if "reported" in fault else []
        if pattern == "launcher" and times:
            # Who looks at /diagnostics sees no log.
            told = re.compile(rf"/(?:launch_\w+/)?{fault.get('kill') or fault.get('pause')}(?:-\d+)?: process: {ENDS}")
            said = [at - harm for at, text, level in bag.diagnostics if level != OK and told.match(text)]
            times = [max(*times, at) for at in said if at >= -BEFORE]
    elif pattern is not None:
        said = [at for at, text, level in bag.diagnostics if level != OK and re.search(pattern, text)]
        times = [at - harm for at in said if at >= began - BEFORE]
    else:
        if "unnamed" not in fault:
            verdict.problems.append("the matrix does not say what names it, or why nobody can")
        return
    verdict.diagnosed = min(times, default=None)
    if verdict.diagnosed is not None and verdict.diagnosed < began - harm - LATE:
        verdict.problems.append(f"{pattern!r} was said {-verdict.diagnosed:.2f} s before it, too: it does not name it")
    if verdict.diagnosed is None or verdict.diagnosed > DIAGNOSTIC:
        verdict.problems.append(f"nothing like {pattern!r} named it within {DIAGNOSTIC} s")


def structure(bag: Run, fault: dict, window: tuple[float, float, float], verdict: Verdict) -> None:
    """What the assignments must say: with `keeps` they stay as they are, with `joins` they have a robot more, without the robot that `quits`
    (which led) or `leaves` (which followed) the others close up."""
    began, ended, until = window
    before = bag.assignments.at(began) or {}
    if fault.get("keeps"):
        changed = [made for _, made in bag.assignments.between(began, until) if made != before]
        if not before or changed:
            verdict.problems.append(f"the assignment did not stay: {before} became {changed[:1]}")
    if follower := fault.get("retargets"):
        retargets(bag, follower, window, verdict)
    newcomer = fault.get("joins")
    if newcomer and (newcomer in before or not any(newcomer in made for _, made in bag.assignments.between(began, until))):
        verdict.problems.append(f"{newcomer} did not join: {before} became {bag.assignments.at(until)}")
    robot = fault.get("quits") or fault.get("leaves")
    if robot is None:
        return
    queue, rank, _ = before.get(robot, (0, 0, ""))
    if "quits" in fault and rank != 1:
        verdict.problems.append(f"{robot} did not lead before: {before}")
    if "leaves" in fault and rank < 2:
        verdict.problems.append(f"{robot} did not follow before: {before}")
    gone = next(((at, made) for at, made in bag.assignments.between(began, ended) if robot not in made), None)
    if gone is None or gone[0] - began > QUIT:
        verdict.problems.append(f"{robot} had not quit the assignment after {QUIT} s: {gone}")
        return
    left = bag.assignments.at(ended)
    others = {name for name, (its, _, _) in before.items() if its == queue} - {robot}
    places = sorted((rank, name, leader) for name, (its, rank, leader) in left.items() if its == queue)
    chain = [name for _, name, _ in places]
    if set(chain) != others or [rank for rank, _, _ in places] != list(range(1, len(others) + 1)):
        verdict.problems.append(f"those behind {robot} did not close up: {left}")
    if [leader for _, _, leader in places] != ["", *chain[:-1]]:
        verdict.problems.append(f"they do not follow one another: {places}")
    again = next((at for at, made in bag.assignments.between(ended, until) if robot in made), None)
    if again is None:
        verdict.problems.append(f"{robot} has no rank again by {until - ended:.1f} s after its return")


def retargets(bag: Run, follower: str, window: tuple[float, float, float], verdict: Verdict) -> None:
    """A robot must follow the target while its leader is not heard, and that leader again afterwards (Remark 8.4.1)."""
    began, ended, until = window

    def leader(at: float) -> str | None:
        return (bag.assignments.at(at) or {}).get(follower, (0, 0, None))[2]

    before, meanwhile, after = leader(began), leader(ended), leader(until - LATE)
    if not before or meanwhile != "" or after != before:
        verdict.problems.append(f"{follower} followed {before!r} before, {meanwhile!r} meanwhile, {after!r} afterwards")


def since_when(holds, ended: float, until: float) -> float | None:
    """How long after the end something begins to hold until the next fault; none if it does not."""
    steps = [ended + 0.05 * step for step in range(int((until - ended) / 0.05))]
    failed = [at for at in steps if not holds(at)]
    if not steps or (failed and failed[-1] == steps[-1]):
        return None
    return failed[-1] + 0.05 - ended if failed else 0.0


def recover(bag: Run, ended: float, until: float, verdict: Verdict, fault: dict) -> None:
    """When all robots were driven again, and, where there is time to, when the formation stood, for the rest of it.

    A chain behind a moving target stands where each robot is on its segment (`forms: segments`); else at its goal points.
    """
    robots = sorted(bag.truth)
    until = min(until, max(series.times[-1] for series in bag.truth.values()), bag.stopped or math.inf)

    def is_driven(robot: str, at: float) -> bool:
        # What it did before the end of the fault does not count.
        since = max(ended, at - LATELY)
        driven = any(moves(state) for _, state in bag.truth[robot].between(since, at))
        distance, speed = bag.distance(robot, at), bag.goal_speed(robot, at)
        return driven or (distance is not None and distance < NEAR and speed < RESTS)

    verdict.recovered = since_when(lambda at: all(is_driven(robot, at) for robot in robots), ended, until)
    if verdict.recovered is None or verdict.recovered > RECOVERY:
        verdict.problems.append(f"not all robots were driven within {RECOVERY} s of its end")
    if fault.get("unsettled"):
        return

    def from_place(robot: str, at: float) -> float | None:
        return bag.segments[robot].at(at) if fault.get("forms") == "segments" else bag.distance(robot, at)

    def stands(at: float) -> bool:
        distances = [from_place(robot, at) for robot in robots]
        return all(distance is not None and distance < NEAR for distance in distances)

    verdict.formed = since_when(stands, ended, until)
    if verdict.formed is None:
        far = {robot: from_place(robot, until - 0.1) for robot in robots}
        verdict.problems.append(f"the formation did not stand within {until - ended:.1f} s: {far}")


def whole(bag: Run, run: dict, evidence: Evidence) -> list[str]:
    """What is wrong with the run as a whole."""
    problems = list(evidence.refused)
    for robot, series in bag.commands.items():
        # Written so that what is no number is beyond too.
        beyond = [value for value in series.values if not (abs(value[0]) <= LIMITS[0] and abs(value[1]) <= LIMITS[1])]
        if beyond:
            problems.append(f"a command for {robot} is beyond its limits: {beyond[0]}")
    problems += exits(run, evidence) + too_soon(bag, run)
    if not any(fault.get("ends") for fault in run["faults"]) and evidence.exit_code != 0:
        problems.append(f"the run ended with {evidence.exit_code}")
    if len(evidence.memory) == 2:
        before, after = evidence.memory
        for label in before.keys() & after.keys():
            if after[label] - before[label] > GROWTH:
                problems.append(f"{label} grew by {(after[label] - before[label]) / 1e6:.1f} MB")
    said = [bag, *(Run(folder, run.get("clocks", False)) for folder in sorted(evidence.spoken.glob("*")))]
    unfounded, basis = wheels.founded(bag, said, evidence.tap)
    problems += unfounded
    problems += stale(bag, basis)
    gaps = [later - earlier for earlier, later in zip(bag.log_times, bag.log_times[1:])]
    if not gaps or max(gaps) > GAP:
        problems.append(f"the bag has a gap of {max(gaps, default=math.inf):.1f} s")
    return problems + recorded(bag, run, evidence) + [f"{name} is left in shared memory" for name in evidence.left]


def contacts(bag: Run, windows: list) -> list[str]:
    """Bodies that touched, whenever that was, robots, obstacles and edges, but for a robot that was carried to touch another one."""
    put = [began for fault, began, _ in windows if fault.get("touches")]

    # The bed tells of a contact when it comes, of what is in force a frame later at most.
    def is_told(at: float, text: str) -> bool:
        return ROBOTS_TOUCH.search(text) is not None and any(began - FRAME <= at <= began + PUT for began in put)

    return [f"contact: {text}" for at, text in bag.contacts if not is_told(at, text)][:1]


# A line of the launcher's own about the end of a process: its label, how it ended, its pid, and with what.
END = re.compile(r"^\[\w+\] \[([\w/.-]+)\]: process has (died|finished cleanly) \[pid (\d+)(?:, ([^\]]*))?\]", re.MULTILINE)


def exits(run: dict, evidence: Evidence) -> list[str]:
    """Processes that ended, however, before the operator ended the run, and were no victims."""
    victims = {fault["pid"] for fault in run["faults"] if "pid" in fault}
    problems = []
    for host, log in evidence.logs.items():
        for label, how, pid, status in END.findall(log):
            # The operator's end is the run's; the launchers of other hosts end later.
            if host == BASE and label.startswith("operator-"):
                break
            if int(pid) not in victims:
                problems.append(f"{label} on {host} ended too: {how} {status}".rstrip())
    gone = {fault["kill"] for fault in run["faults"] if fault.get("gone") or fault.get("ends")}
    return problems + [f"{name} ended too" for name in evidence.missing if name not in gone]


def too_soon(bag: Run, run: dict) -> list[str]:
    """An operator that ended the run before it was over."""
    if any(fault.get("ends") for fault in run["faults"]) or not bag.t0 or not bag.stopped:
        return []
    lasted = bag.stopped - bag.t0
    return [f"the run was stopped {lasted:.1f} s after the start"] if lasted < float(run["arguments"]["duration"]) - 0.5 else []
