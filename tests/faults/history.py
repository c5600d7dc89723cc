"""Results of runs of the matrix from machine to machine: one line a run and seed, in a file of the repository."""

import json
from pathlib import Path

import verdict


def merged(runs: list[dict], results: Path, path: Path) -> list[dict]:
    """What is in the file, each run and seed replaced by its results of this machine where there are any; the file has it afterwards."""
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    known = {key(document): document for document in map(json.loads, lines)}
    found = [compact(run, kept.parent) for run in runs for kept in sorted((results / run["name"]).glob("[0-9]*/verdicts.json"))]
    # What failed beside others before was of another run of this seed.
    for document in found:
        known.pop((document["run"], document["seed"], True), None)
    known |= {key(document): document for document in found}
    order = {run["name"]: place for place, run in enumerate(runs)}
    told = sorted((document for document in known.values() if document["run"] in order), key=lambda document: (order[document["run"]], *key(document)[1:]))
    path.write_text("".join(json.dumps(document) + "\n" for document in told), encoding="utf-8")
    return told


def key(document: dict) -> tuple[str, int, bool]:
    """What there is one of."""
    return document["run"], document["seed"], document["in_company"]


def compact(run: dict, folder: Path) -> dict:
    """The document of a run for the file: times in hundredths of seconds, nothing that is not there."""
    document = verdict.read(folder)
    return {
        "run": run["name"],
        "seed": document["seed"],
        "in_company": folder.name.endswith(verdict.IN_COMPANY),
        "commit": document.get("commit", ""),
        "date": document["date"],
        "verdicts": [short(told) for told in document["verdicts"]],
    }


def short(told: dict) -> dict:
    """One fault's verdict without its run, which stands above, and without times that were not taken."""
    rounded = {name: round(value, 2) if isinstance(value, float) else value for name, value in told.items() if name != "run"}
    return {name: value for name, value in rounded.items() if value is not None}
