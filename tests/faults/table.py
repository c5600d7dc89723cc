"""docs/FAULTS.md from the results of the runs of the matrix."""

import json
from pathlib import Path

HEAD = """# Faults

What `scripts/faults` did to a running formation, and what came of it. Each row is one fault of
[the matrix](../tests/faults/matrix.yaml), met by four robots on their way in the square ([config/formations/square_slow.yaml](../config/formations/square_slow.yaml)),
as processes in real time on the simulated test bed, judged by ground truth and diagnostics (tests/faults/judge.py). Times are
the worst of all seeds that were run:

- no contact; no robot moves on information older than 0.25 s and the time it takes to brake; only the victim ends; commands finite and within
  limits; memory grows by less than 10 MB; the bag has no gap of a second;
- **diagnostic**: the one that names the fault, within 0.5 s; *launcher*: the launcher's own report of the process that died;
- **still**: where control cannot be safe, all robots concerned stand within 0.6 s (0.25 s on old information, then braking) and until the fault is over;
- **driven**: all robots move again, or are where they are to be, within 2 s of its end (the victim lives again, the injection is off);
- **formed**: all robots within 40 mm of their goal points, which move on, within 10 s of its end and until the
  next fault begins.

Runs named *hosts* have the base station and each robot's controller on hosts of their own (network namespaces), by DDS on
one network, or by Zenoh through a router between two ([hosts.md](hosts.md)).

| fault | run | diagnostic, s | still, s | driven, s | formed, s | verdict | seeds | date (UTC) |
|---|---|---|---|---|---|---|---|---|
"""


def write(runs: list[dict], results: Path, page: Path) -> None:
    """Writes the page."""
    lines = []
    for run in runs:
        files = sorted((results / run["name"]).glob("*/verdicts.json"), key=lambda file: int(file.parent.name))
        documents = [json.loads(file.read_text()) for file in files]
        date = max((document["date"] for document in documents), default="-")
        for fault in run["faults"]:
            met = [verdict for document in documents for verdict in document["verdicts"] if verdict["fault"] == fault["name"]]
            lines.append(row(fault, run, met, date))
    page.write_text(HEAD + "\n".join(lines) + "\n", encoding="utf-8")


def row(fault: dict, run: dict, met: list[dict], date: str) -> str:
    """What came of a fault in all runs in which it was met."""
    if not met:
        return f"| {fault['name']} | {run['name']} | | | | | not run | | - |"
    says = "launcher" if fault.get("says") == "launcher" else worst(met, "diagnosed")
    failed = [verdict for verdict in met if verdict["problems"]]
    note = f" ({fault['note']})" if "note" in fault else ""
    result = f"pass{note}" if not failed else f"**fails**: {'; '.join(failed[0]['problems'])}"
    cells = [fault["name"], run["name"], says, *(worst(met, key) for key in ("stood", "recovered", "formed"))]
    return f"| {' | '.join(cells)} | {result} | {len(met) - len(failed)} of {len(met)} | {date} |"


def worst(met: list[dict], key: str) -> str:
    """The longest time, or nothing."""
    times = [verdict[key] for verdict in met if verdict[key] is not None]
    return f"{max(times):.2f}" if times else ""
