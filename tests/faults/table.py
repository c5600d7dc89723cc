"""docs/FAULTS.md from the results of the runs of the matrix: those that are kept beside it, and those of this machine."""

from pathlib import Path

import history
import recovery
from judge import REPORTERS

# s, from the start of the test bed to t0, and for what takes no time by itself (a death, a clock that jumps): so long at most until all is as before.
STARTS, AN_INSTANT = 1.0, 1.0

HEAD = """# Faults

What `scripts/faults` did to a running formation, and what came of it. Each row is one fault of
[the matrix](../tests/faults/matrix.yaml), met by four robots on their way in the square ([config/formations/square_slow.yaml](../config/formations/square_slow.yaml)),
as processes in real time on the simulated test bed, judged by ground truth, diagnostics and the bytes on the serial line (tests/faults/judge.py, which judge_test.py judges). Some
runs are half as fast ([square_slower.yaml](../config/formations/square_slower.yaml)), three are a column behind a moving target. Times are
the worst of all seeds that were run:

- no contact from the start of the run to its end; no robot drives or turns on information older than 0.25 s, a frame, and what braking takes from its speed of then; the
  victim ends and no other process before the run is over, on any host, with whatever exit code, and none leaves anything in shared memory; commands of the robots' own controllers finite and within
  limits; memory grows by less than 10 MB, also from one life of a process to the next; the bag has no gap of a second, and where the launch records one itself (in RECORDED of the RUNS runs),
  that is finished, whole and has at most a second less (and a pause of its recorder). A bag whose recorder was killed, or had no more room, is read as it was left, a second at
  most is missing when it is recovered, and files that were finished before are whole bags by themselves. Each speed
  that is sent to wheels, as the serial line has it, is one that the robot's own controller commanded on information of the last 0.25 s: no burst of
  old commands, and nobody else's;
- in CHANGING runs somebody wants the formation otherwise, in another size, in SHAPED of them in another shape (`changes` in the matrix), while a fault is on, which is so
  for WITHIN of the FAULTS faults: it must be granted, and formed is held against the new one;
- **diagnostic**: the one that names the fault, within 0.5 s, and was not there before; *(launcher)*: the launcher's own report of the process that
  died or was stopped, in its log and on /diagnostics, whichever was later; *(launcher's log)*: the same where no word passes; *(itself)*: the word of the second process that does not start, or gets nothing; *(log)*: a node's word on its
  standard error, where it has no way to others; where nobody can know of it, why;
- **still**: where control cannot be safe, all robots concerned, which moved before, stand from 0.25 s of old information (0.5 s without goals or
  obstacles), a frame and the time to brake, until the fault is over;
- where nothing keeps robots from driving (lost packets that others make good for, voices that are refused, a fault of another robot alone), none stands for
  longer than the matrix says (`drives`), during the fault and for a second after it. Where some halt and may stand, that holds for the others;
- where control is not safe for most of the time (a network that loses half, or brings most of it too late), passing is to stop safely: each robot stands for the share of the
  time that the matrix says (`rests`), moves for no longer at a time than it says and a frame more (`pulses`), and as everywhere never on what is older than 0.25 s; the verdict says so;
- **rest**: after the death of a process, how long a robot stood at most: no longer than until the victim lives again, and a second;
- **driven**: all robots move again, or are where their resting goal points are, within 2 s of its end (the victim lives again, the injection is off);
- **formed**: all robots within 40 mm of their goal points, which move on, within 10 s of its end and until the
  next fault begins.

Seeds says how many of them passed in the run that counts, which is the last one; attempts, how many passed of all that were ever made with them and are known of:
those that were made again count too, beside other runs, on older commits and under older criteria as well.

The table is made of [faults.jsonl](faults.jsonl), where each run stands with its seed and the commit that was tried; which commits a row is of is
said behind its date.

Runs named *hosts* have the base station and each robot's controller on hosts of their own (network namespaces), by DDS on
one network, or by Zenoh through a router between two ([hosts.md](hosts.md)); in *hosts-radio* the bridge alone is on a host of its own,
with somebody who looks through a camera, and commands count as old as they are there.

| fault | run | diagnostic, s | still, s | rest, s | driven, s | formed, s | verdict | seeds | attempts | date (UTC), commits |
|---|---|---|---|---|---|---|---|---|---|---|
"""


def write(runs: list[dict], results: Path, page: Path) -> None:
    """Writes the page, and beside it what it is made of."""
    told = history.merged(runs, results, page.with_name("faults.jsonl"))
    lines = []
    for run in runs:
        documents = [document for document in told if document["run"] == run["name"]]
        alone = [document for document in documents if not document["in_company"]]
        beside = [document for document in documents if document["in_company"]]
        for fault in run["faults"]:
            met, failed_beside = of(fault, alone), [told for told in of(fault, beside) if told["problems"]]
            unknown = f"| {fault['name']} | {run['name']} | | | | | | not run | | | - |"
            attempts = history.attempts_of(fault["name"], documents)
            lines.append(row(fault, run, met, failed_beside, attempts, stamp(alone)) if met else unknown)
    counts = {
        "CHANGING": sum("changes" in run for run in runs),
        "SHAPED": sum(any("shape" in change for change in run.get("changes", [])) for run in runs),
        "WITHIN": sum(changes_within(run) for run in runs),
        "RECORDED": sum(run["arguments"].get("record") == "true" for run in runs),
        "RUNS": len(runs),
        "FAULTS": sum(len(run["faults"]) for run in runs),
    }
    head = HEAD
    for word, count in counts.items():
        head = head.replace(word, str(count))
    page.write_text(head + "\n".join(lines) + "\n", encoding="utf-8")
    recovery.write(told, page.with_name("BENCHMARKS.md"))


def changes_within(run: dict) -> int:
    """Into how many of its faults a change of the formation falls, by the times of the matrix."""
    times = [change["at"] for change in run.get("changes", [])]
    return sum(any(began <= at <= ended for at in times) for began, ended in map(window, run["faults"]))


def window(fault: dict) -> tuple[float, float]:
    """When a fault is on, s after t0."""
    if "bed" in fault:
        return fault["bed"]["from"] - STARTS, fault["bed"]["to"] - STARTS
    return fault["at"], fault["at"] + fault.get("for", AN_INSTANT)


def stamp(documents: list[dict]) -> str:
    """The newest date, and all commits."""
    commits = dict.fromkeys(document["commit"] for document in documents)
    return ", ".join([max(document["date"] for document in documents), *commits])


def of(fault: dict, documents: list[dict]) -> list[dict]:
    """What came of a fault in these runs."""
    return [told for document in documents for told in document["verdicts"] if told["fault"] == fault["name"]]


def row(fault: dict, run: dict, met: list[dict], failed_beside: list[dict], attempts: list[bool], stamp: str) -> str:
    """What came of a fault in all runs in which it was met."""
    by = f" ({fault['says']})" if fault.get("says") in REPORTERS else " (log)" if "warns" in fault else ""
    says = worst(met, "diagnosed") + by if "unnamed" not in fault else f"none: {fault['unnamed']}"
    failed = [told for told in met if told["problems"]]
    notes = [fault["note"]] if "note" in fault else []
    notes += [f"beside other runs {len(failed_beside)} failed: {briefly(told['problems'])}; alone it is as said here" for told in failed_beside[:1]]
    result = f"**fails**: {briefly(failed[0]['problems'])}" if failed else "pass"
    result += f" ({'; '.join(notes)})" if notes else ""
    cells = [fault["name"], run["name"], says, *(worst(met, key) for key in ("stood", "rested", "recovered", "formed"))]
    return f"| {' | '.join(cells)} | {result} | {len(met) - len(failed)} of {len(met)} | {sum(attempts)} of {len(attempts)} | {stamp} |"


def briefly(problems: list[str]) -> str:
    """The first of them, as a cell of a table may have it."""
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return problems[0].replace("|", "\\|") + more


def worst(met: list[dict], key: str) -> str:
    """The longest time, or nothing."""
    times = [told[key] for told in met if told.get(key) is not None]
    return f"{max(times):.2f}" if times else ""
