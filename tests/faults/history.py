"""Results of runs of the matrix from machine to machine: one line a run and seed, in a file of the repository."""

import json
from pathlib import Path

import verdict


# Beside the folders of a run's seeds: what came of attempts that were made again.
ATTEMPTS = "attempts.jsonl"


def merged(runs: list[dict], results: Path, path: Path) -> list[dict]:
    """What is in the file, each run and seed replaced by its results of this machine where there are any; the file has it afterwards.

    What is replaced stays among the `attempts` of its run and seed: who fails and passes the next time has not passed always.
    """
    known = {key(document): document for document in read_lines(path)}
    found = [compact(run, kept.parent) for run in runs for kept in sorted((results / run["name"]).glob("[0-9]*/verdicts.json"))]
    earlier = [document for run in runs for document in read_lines(results / run["name"] / ATTEMPTS)]
    before: dict[tuple[str, int], list[dict]] = {}
    for document in [*known.values(), *earlier]:
        before.setdefault(key(document)[:2], []).extend([*document.get("attempts", []), brief(document)])
    # What failed beside others before was of another run of this seed.
    for document in found:
        known.pop((document["run"], document["seed"], True), None)
    known |= {key(document): document for document in found}
    for run, seed, in_company in known:
        # Those of a seed stand with the run that counts.
        known[run, seed, in_company].pop("attempts", None)
        now = [brief(known[of]) for of in ((run, seed, False), (run, seed, True)) if of in known]
        gone = [attempt for attempt in each_once(before.get((run, seed), [])) if attempt not in now]
        if gone and not in_company:
            known[run, seed, in_company]["attempts"] = gone
    order = {run["name"]: place for place, run in enumerate(runs)}
    told = sorted((document for document in known.values() if document["run"] in order), key=lambda document: (order[document["run"]], *key(document)[1:]))
    path.write_text("".join(json.dumps(document) + "\n" for document in told), encoding="utf-8")
    return told


def read_lines(path: Path) -> list[dict]:
    """The documents of a file, one a line; none where there is no file."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []


def put_by(run: dict, folder: Path) -> None:
    """Keeps what came of a run whose folder is about to be emptied for the next attempt."""
    if (folder / "verdicts.json").exists():
        with open(folder.with_name(ATTEMPTS), "a", encoding="utf-8") as kept:
            kept.write(json.dumps(compact(run, folder)) + "\n")


def brief(document: dict) -> dict:
    """An attempt: when, of which commit, and the first problem of each fault, nothing where it passed."""
    problems = {told["fault"]: told["problems"][0] if told["problems"] else "" for told in document["verdicts"]}
    return {"date": document["date"], "commit": document["commit"], "in_company": document["in_company"], "problems": problems}


def each_once(attempts: list[dict]) -> list[dict]:
    """In the order of their dates."""
    kept: list[dict] = []
    for attempt in sorted(attempts, key=lambda attempt: attempt["date"]):
        if attempt not in kept:
            kept.append(attempt)
    return kept


def attempts_of(fault: str, documents: list[dict]) -> list[bool]:
    """Of each attempt at a fault that is known of, those that count among them, whether it passed."""
    made = [attempt for document in documents for attempt in [*document.get("attempts", []), brief(document)]]
    return [not attempt["problems"][fault] for attempt in made if fault in attempt["problems"]]


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
