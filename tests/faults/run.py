"""The command line of the fault matrix (scripts/faults, which sets the environment up): what to run, and the table of it."""

import argparse
import sys
import time
from pathlib import Path

import matrix
import table
import verdict
from company import Company, Job
from launched import ROOT

RESULTS = ROOT / "run" / "faults"
# Seeds that the sample takes by turns, how many runs it takes, and how long a turn is, s.
SEEDS, SAMPLE, TURN = 3, 2, 3600


def passed(run: dict, seed: int, since: float) -> bool:
    """Whether this run has passed with this seed, with these binaries and as the matrix is now."""
    folder = RESULTS / run["name"] / str(seed)
    if not (folder / "verdicts.json").exists() or (folder / "verdicts.json").stat().st_mtime < since:
        return False
    passes = {told["fault"]: not told["problems"] for told in verdict.read(folder)["verdicts"]}
    return all(passes.get(fault["name"], False) for fault in run["faults"])


def newest(binaries: Path) -> float:
    """When what is tried, or how it is judged, was made last (s, wall clock)."""
    programs = [path for path in binaries.iterdir() if path.is_file() and not path.suffix]
    return max(path.stat().st_mtime for path in [*programs, *Path(__file__).parent.glob("*.[py]*")])


def seeds(text: str) -> list[int]:
    """`20`: 1 to 20; `2,3`: these."""
    return [int(seed) for seed in text.split(",") if seed] if "," in text else list(range(1, int(text) + 1))


def sampled(runs: list[dict], turn: int) -> list[Job]:
    """The next of these runs by turns, and after all of them the next seed."""
    places = [SAMPLE * turn + place for place in range(SAMPLE)]
    return [Job(runs[place % len(runs)], 1 + place // len(runs) % SEEDS) for place in places]


def chosen(runs: list[dict], arguments: argparse.Namespace) -> list[Job]:
    """The runs that the command line asks for, each with a seed."""
    if arguments.sample:
        return sampled([run for run in runs if run.get("sample")], int(time.time()) // TURN)
    picked = []
    for name in arguments.names:
        found = [run for run in runs if name == run["name"] or any(name == fault["name"] for fault in run["faults"])]
        if not found:
            sys.exit(f"scripts/faults: there is no run or fault {name}; see scripts/faults --list")
        picked += [run for run in found if run not in picked]
    if arguments.seeds is None:
        return [Job(run, arguments.seed) for run in picked or runs]
    # What has passed is not run again: all of it takes hours.
    since = newest(arguments.binaries)
    every = [Job(run, seed) for seed in arguments.seeds for run in picked or runs]
    return [job for job in every if not passed(job.run, job.seed, since)]


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*")
    parser.add_argument("--binaries", type=Path, required=True)
    parser.add_argument("--sample", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seeds", type=seeds)
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    runs = matrix.runs()
    if arguments.list:
        for run in runs:
            print(f"{run['name']:16} {', '.join(fault['name'] for fault in run['faults'])}")
        return
    company = Company(RESULTS, arguments.binaries, arguments.jobs)
    if not arguments.table:
        company.conduct(chosen(runs, arguments))
    if not arguments.sample:
        table.write(runs, RESULTS, ROOT / "docs" / "FAULTS.md")
    if arguments.seeds is not None and not arguments.names:
        since = newest(arguments.binaries)
        every = [passed(run, seed, since) for run in runs for seed in arguments.seeds]
        print(f"figure: {sum(every)} of {len(every)} runs of the matrix pass, {len(arguments.seeds)} seeds")
    sys.exit(company.failed)


if __name__ == "__main__":
    main()
