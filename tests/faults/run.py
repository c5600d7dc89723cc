"""Runs the fault matrix: launches a formation, does what a run of tests/faults/matrix.yaml says, has the bag judged.

Started by scripts/faults, which sets the environment up.
"""

import argparse
import datetime
import json
import os
import shutil
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

import yaml

import act
import inject
import judge
import table
from launched import PATIENCE, ROOT, Launched

RESULTS = ROOT / "run" / "faults"
# Seeds that the sample takes by turns.
SEEDS = 3


def conduct(run: dict, binaries: Path, seed: int) -> list[judge.Verdict]:
    """Carries out a run and judges its faults."""
    folder = RESULTS / run["name"] / str(seed)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    if run.get("after") == "killed":
        # A run that was killed leaves its shared memory, checkpoints and the link of the port to the next one.
        first = Launched(run, binaries, folder, seed)
        try:
            inject.Ears(first.log).wait_for_start(PATIENCE)
        finally:
            first.kill()
        shutil.rmtree(folder / "bag", ignore_errors=True)
        shutil.rmtree(folder / "launch")
    launched = Launched(run, binaries, folder, seed)
    ears = inject.Ears(launched.log)
    windows, memory, code = [], [], None
    try:
        ears.wait_for_start(PATIENCE)
        # What a process takes to begin with is not what it grows by.
        ears.wait_until(3.0)
        memory.append(launched.memory())
        for fault in run["faults"]:
            if "bed" in fault:
                continue
            ears.wait_until(fault["at"])
            began, ended = act.do(fault, launched, ears)
            windows.append((fault, began, ended))
        if not any(fault.get("ends") for fault in run["faults"]):
            ears.wait_until(float(run["arguments"]["duration"]) - 1.0)
            memory.append(launched.memory())
        code = launched.wait()
    finally:
        ears.close()
        launched.end()
    lived = [fault["alive_after"] for fault in run["faults"] if "alive_after" in fault]
    evidence = judge.Evidence(
        bag=folder / "bag", log=launched.all_logs(), exit_code=code, memory=memory, alive_after=max(lived, default=None),
        own_bag=folder / "own-bag", binaries=binaries,
    )
    verdicts = judge.judge(run, windows, evidence)
    (folder / "verdicts.json").write_text(
        json.dumps({
            "date": datetime.datetime.now(datetime.UTC).strftime("%F %H:%M"), "seed": seed,
            "verdicts": [asdict(verdict) for verdict in verdicts],
        }, indent=1)
    )
    return verdicts


def passed(run: dict, seed: int) -> bool:
    """Whether this run has passed with this seed before."""
    path = RESULTS / run["name"] / str(seed) / "verdicts.json"
    if not path.exists():
        return False
    verdicts = {verdict["fault"]: verdict for verdict in json.loads(path.read_text())["verdicts"]}
    return all(fault["name"] in verdicts and not verdicts[fault["name"]]["problems"] for fault in run["faults"])


def chosen(runs: list[dict], arguments: argparse.Namespace) -> list[tuple[dict, int]]:
    """The runs that the command line asks for, each with a seed."""
    if arguments.sample:
        day = datetime.date.today().toordinal()
        sample = [run for run in runs if run.get("sample")]
        return [(sample[day % len(sample)], 1 + day // len(sample) % SEEDS)]
    picked = []
    for name in arguments.names:
        found = [run for run in runs if name == run["name"] or any(name == fault["name"] for fault in run["faults"])]
        if not found:
            sys.exit(f"scripts/faults: there is no run or fault {name}; see scripts/faults --list")
        picked += [run for run in found if run not in picked]
    if arguments.seeds is None:
        return [(run, arguments.seed) for run in picked or runs]
    # What has passed is not run again: all of it takes hours.
    every = [(run, seed) for seed in range(1, arguments.seeds + 1) for run in picked or runs]
    return [(run, seed) for run, seed in every if not passed(run, seed)]


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*")
    parser.add_argument("--binaries", type=Path, required=True)
    parser.add_argument("--sample", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seeds", type=int)
    arguments = parser.parse_args()
    runs = yaml.safe_load((ROOT / "tests" / "faults" / "matrix.yaml").read_text(encoding="utf-8"))["runs"]
    if arguments.list:
        for run in runs:
            print(f"{run['name']:12} {', '.join(fault['name'] for fault in run['faults'])}")
        return
    failed = False
    if not arguments.table:
        os.environ.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % 100))
        for run, seed in chosen(runs, arguments):
            for verdict in conduct(run, arguments.binaries, seed):
                print(verdict.line(), flush=True)
                failed |= not verdict.passed
    if not arguments.sample:
        table.write(runs, RESULTS, ROOT / "docs" / "FAULTS.md")
    if arguments.seeds is not None:
        every = [passed(run, seed) for run in runs for seed in range(1, arguments.seeds + 1)]
        print(f"figure: {sum(every)} of {len(every)} runs of the matrix pass, {arguments.seeds} seeds")
        failed = not all(every)
    sys.exit(failed)


if __name__ == "__main__":
    main()
