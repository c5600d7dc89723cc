"""docs/FAULTS.md from the results of the runs of the matrix: those that are kept beside it, and those of this machine."""

from pathlib import Path

import history
import recovery
from judge import REPORTERS

HEAD = """# Faults

What `scripts/faults` did to a running formation, and what came of it. Each row is one fault of
[the matrix](../tests/faults/matrix.yaml), met by four robots on their way in the square ([config/formations/square_slow.yaml](../config/formations/square_slow.yaml)),
as processes in real time on the simulated test bed, judged by ground truth, diagnostics and the bytes on the serial line (tests/faults/judge.py, which judge_test.py judges). Some
runs are half as fast ([square_slower.yaml](../config/formations/square_slower.yaml)), three are a column behind a moving target. Times are
the worst of all seeds that were run:

- no contact from the start of the run to its end; no robot drives or turns on information older than 0.25 s, a frame, and what braking takes from its speed of then; the
  victim ends and no other process before the run is over, on any host, with whatever exit code, and none leaves anything in shared memory; commands of the robots' own controllers finite and within
  limits; memory grows by less than 10 MB, also from one life of a process to the next; the bag has no gap of a second, and where the launch records one itself,
  that is whole and has at most a second less (and a pause of its recorder). Each speed
  that is sent to wheels, as the serial line has it, is one that the robot's own controller commanded on information of the last 0.25 s: no burst of
  old commands, and nobody else's;
- in CHANGING runs somebody wants the formation in another size while a fault is on (`changes` in the matrix): it must be granted, and formed is held
  against the new one;
- **diagnostic**: the one that names the fault, within 0.5 s, and was not there before; *(launcher)*: the launcher's own report of the process that
  died or was stopped; *(itself)*: the word of the second process that does not start, or gets nothing; *(log)*: a node's word on its
  standard error, where it has no way to others; where nobody can know of it, why;
- **still**: where control cannot be safe, all robots concerned, which moved before, stand from 0.25 s of old information (0.5 s without goals or
  obstacles), a frame and the time to brake, until the fault is over;
- where nothing keeps robots from driving (lost packets that others make good for, voices that are refused), none stands for longer than the
  matrix says (`drives`);
- **rest**: after the death of a process, how long a robot stood at most: no longer than until the victim lives again, and a second;
- **driven**: all robots move again, or are where their resting goal points are, within 2 s of its end (the victim lives again, the injection is off);
- **formed**: all robots within 40 mm of their goal points, which move on, within 10 s of its end and until the
  next fault begins.

The table is made of [faults.jsonl](faults.jsonl), where each run stands with its seed and the commit that was tried; which commits a row is of is
said behind its date.

Runs named *hosts* have the base station and each robot's controller on hosts of their own (network namespaces), by DDS on
one network, or by Zenoh through a router between two ([hosts.md](hosts.md)); in *hosts-radio* the bridge alone is on a host of its own,
with somebody who looks through a camera, and commands count as old as they are there.

| fault | run | diagnostic, s | still, s | rest, s | driven, s | formed, s | verdict | seeds | date (UTC), commits |
|---|---|---|---|---|---|---|---|---|---|
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
            unknown = f"| {fault['name']} | {run['name']} | | | | | | not run | | - |"
            lines.append(row(fault, run, met, failed_beside, stamp(alone)) if met else unknown)
    head = HEAD.replace("CHANGING", str(sum("changes" in run for run in runs)))
    page.write_text(head + "\n".join(lines) + "\n", encoding="utf-8")
    recovery.write(told, page.with_name("BENCHMARKS.md"))


def stamp(documents: list[dict]) -> str:
    """The newest date, and all commits."""
    commits = dict.fromkeys(document["commit"] for document in documents)
    return ", ".join([max(document["date"] for document in documents), *commits])


def of(fault: dict, documents: list[dict]) -> list[dict]:
    """What came of a fault in these runs."""
    return [told for document in documents for told in document["verdicts"] if told["fault"] == fault["name"]]


def row(fault: dict, run: dict, met: list[dict], failed_beside: list[dict], stamp: str) -> str:
    """What came of a fault in all runs in which it was met."""
    by = f" ({fault['says']})" if fault.get("says") in REPORTERS else " (log)" if "warns" in fault else ""
    says = worst(met, "diagnosed") + by if "unnamed" not in fault else f"none: {fault['unnamed']}"
    failed = [told for told in met if told["problems"]]
    notes = [fault["note"]] if "note" in fault else []
    notes += [f"beside other runs {len(failed_beside)} failed: {briefly(told['problems'])}; alone it is as said here" for told in failed_beside[:1]]
    result = f"**fails**: {briefly(failed[0]['problems'])}" if failed else "pass"
    result += f" ({'; '.join(notes)})" if notes else ""
    cells = [fault["name"], run["name"], says, *(worst(met, key) for key in ("stood", "rested", "recovered", "formed"))]
    return f"| {' | '.join(cells)} | {result} | {len(met) - len(failed)} of {len(met)} | {stamp} |"


def briefly(problems: list[str]) -> str:
    """The first of them, as a cell of a table may have it."""
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return problems[0].replace("|", "\\|") + more


def worst(met: list[dict], key: str) -> str:
    """The longest time, or nothing."""
    times = [told[key] for told in met if told.get(key) is not None]
    return f"{max(times):.2f}" if times else ""
