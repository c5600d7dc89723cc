"""docs/FAULTS.md from the results of the last run of each row of the matrix."""

import json
from pathlib import Path

HEAD = """# Faults

What `scripts/faults` did to a running formation, and what came of it. Each row is one fault of
[the matrix](../tests/faults/matrix.yaml), met by four robots on their way in the square ([config/formations/square_slow.yaml](../config/formations/square_slow.yaml)),
as processes in real time on the simulated test bed, judged by ground truth and diagnostics (tests/faults/judge.py):

- no contact; only the victim ends; commands finite and within limits; memory grows by less than 10 MB; the bag has no gap of a second;
- **diagnostic**: the one that names the fault, within 0.5 s; *launcher*: the launcher's own report of the process that died;
- **still**: where control cannot be safe, all robots concerned stand within 0.6 s (0.25 s on old information, then braking) and until the fault is over;
- **driven**: all robots move again, or are where they are to be, within 2 s of its end (the victim lives again, the injection is off);
- **formed**: all robots within 40 mm of their goal points, which move on, within 10 s of its end and until the
  next fault begins.

| fault | run | diagnostic, s | still, s | driven, s | formed, s | verdict | date (UTC) |
|---|---|---|---|---|---|---|---|
"""


def write(runs: list[dict], results: Path, page: Path) -> None:
    """Writes the page."""
    lines = []
    for run in runs:
        path = results / run["name"] / "verdicts.json"
        document = json.loads(path.read_text()) if path.exists() else {"verdicts": [], "date": "-"}
        verdicts = {verdict["fault"]: verdict for verdict in document["verdicts"]}
        for fault in run["faults"]:
            verdict = verdicts.get(fault["name"])
            if verdict is None:
                lines.append(f"| {fault['name']} | {run['name']} | | | | | not run | - |")
                continue
            says = "launcher" if fault.get("says") == "launcher" else number(verdict["diagnosed"])
            result = "pass" if not verdict["problems"] else f"**fails**: {'; '.join(verdict['problems'])}"
            cells = [fault["name"], run["name"], says, *(number(verdict[key]) for key in ("stood", "recovered", "formed"))]
            lines.append(f"| {' | '.join(cells)} | {result} | {document['date']} |")
    page.write_text(HEAD + "\n".join(lines) + "\n", encoding="utf-8")


def number(value: float | None) -> str:
    """A time, or nothing."""
    return "" if value is None else f"{value:.2f}"
