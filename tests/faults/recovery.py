"""The table of docs/BENCHMARKS.md of how soon robots drive on after the death of a process: from the results that docs/FAULTS.md is made of."""

from pathlib import Path

import matrix

BEGIN, END = "<!-- recovery -->\n", "<!-- end of recovery -->\n"
HEAD = "| who was killed | stood, s | seeds | date (UTC), commits |\n|---|---|---|---|\n"


def rows(told: list[dict]) -> str:
    """A line for each death on one host that somebody misses, of runs that had the machine to themselves."""
    lines = []
    for run in matrix.runs():
        kills = {fault["name"]: fault["kill"] for fault in run["faults"] if "kill" in fault and not fault.get("ends")}
        if "hosts" in run or "view" in run:
            continue
        alone = [document for document in told if document["run"] == run["name"] and not document["in_company"]]
        for name, victim in kills.items():
            met = [verdict["rested"] for document in alone for verdict in document["verdicts"] if verdict["fault"] == name and "rested" in verdict]
            if met:
                commits = dict.fromkeys(document["commit"] for document in alone)
                when = ", ".join([max(document["date"] for document in alone), *commits])
                lines.append(f"| {victim} ({name}) | {max(met):.2f} | {len(met)} | {when} |\n")
    return "".join(lines)


def write(told: list[dict], page: Path) -> None:
    """Puts the table in its place on the page."""
    before, rest = page.read_text(encoding="utf-8").split(BEGIN)
    _, after = rest.split(END)
    page.write_text(before + BEGIN + HEAD + rows(told) + END + after, encoding="utf-8")
