"""The table of docs/BENCHMARKS.md of how soon robots drive on after the death of a process: from the results that docs/FAULTS.md is made of."""

from pathlib import Path

import matrix

BEGIN, END = "<!-- recovery -->\n", "<!-- end of recovery -->\n"
HEAD = "| who was killed | stood, s | lives again after, s | driven after that, s | seeds | date (UTC), commits |\n|---|---|---|---|---|---|\n"
# Where nobody starts what was killed again.
FOR_GOOD = "for good"


def rows(told: list[dict]) -> str:
    """A line for each death, of runs that had the machine to themselves."""
    lines = []
    for run in matrix.runs():
        alone = [document for document in told if document["run"] == run["name"] and not document["in_company"]]
        for fault in run["faults"]:
            met = [verdict for document in alone for verdict in document["verdicts"] if verdict["fault"] == fault["name"]]
            if not met or not ("kill" in fault or "launcher" in fault):
                continue
            # Of who ends the run, and of who robots go on without, nobody waits for the next life.
            stood = worst(met, "stood") if fault.get("ends") else worst(met, "rested") or worst(met, "stood")
            lives = FOR_GOOD if fault.get("gone") or fault.get("ends") else worst(met, "lasted")
            where = f", {run['name']}" if "hosts" in run else ""
            when = ", ".join([max(document["date"] for document in alone), *dict.fromkeys(document["commit"] for document in alone)])
            victim = fault.get("kill") or f"launcher of {fault['launcher']}"
            cells = [f"{victim} ({fault['name']}{where})", stood, lives, worst(met, "recovered"), str(len(met)), when]
            lines.append(f"| {' | '.join(cells)} |\n")
    return "".join(lines)


def worst(met: list[dict], key: str) -> str:
    """The longest time, or nothing where none was taken."""
    times = [verdict[key] for verdict in met if key in verdict]
    return f"{max(times):.2f}" if times else ""


def write(told: list[dict], page: Path) -> None:
    """Puts the table in its place on the page."""
    before, rest = page.read_text(encoding="utf-8").split(BEGIN)
    _, after = rest.split(END)
    page.write_text(before + BEGIN + HEAD + rows(told) + END + after, encoding="utf-8")
