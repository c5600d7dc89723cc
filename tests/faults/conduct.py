"""Conducts one run of the matrix: launches a formation, does what the run says, has the bag judged.

usage: conduct.py BINARIES FOLDER RUN SEED

FOLDER takes verdicts.json and all that the run leaves. In the ROS domain of the environment; started by run.py.
"""

import os
import resource
import shutil
import sys
from pathlib import Path

import act
import inject
import judge
import matrix
import verdict
from changes import Changes
from evidence import Evidence
from launched import PATIENCE, ROBOTS, Launched

# How much less important judging is than what others have running, who may be timed; and all the memory that it gets, bytes.
NICE, MEMORY = 10, 4 << 30


def conduct(run: dict, binaries: Path, folder: Path, seed: int) -> list[verdict.Verdict]:
    """Carries out a run and judges its faults."""
    if run.get("after") == "killed":
        # A run that was killed leaves its shared memory, checkpoints and the link of the port to the next one.
        first = Launched(run, binaries, folder, seed)
        try:
            inject.Ears(first.log).wait_for_start(PATIENCE)
        finally:
            first.kill()
        for recorded in ("bag", "own-bag"):
            shutil.rmtree(folder / recorded, ignore_errors=True)
        shutil.rmtree(folder / "launch")
    launched = Launched(run, binaries, folder, seed)
    ears = inject.Ears(launched.log)
    windows, memory, code, changes, logs, missing = [], [], None, None, {}, []
    try:
        changes = Changes(run, launched)
        if "late" in run:
            # Those who are there begin without it.
            changes.ask(robots=[robot for robot in ROBOTS if robot != run["late"]])
        ears.wait_for_start(PATIENCE)
        changes.begin(ears.t0)
        # What a process takes to begin with is not what it grows by.
        ears.wait_until(3.0)
        memory.append(launched.memory())
        for fault in run["faults"]:
            if "bed" in fault:
                continue
            ears.wait_until(fault["at"])
            began, ended = act.do(fault, launched, ears, changes)
            windows.append((fault, began, ended))
        if not any(fault.get("ends") for fault in run["faults"]):
            ears.wait_until(float(run["arguments"]["duration"]) - 1.0)
            memory.append(launched.memory())
        code = launched.wait()
        logs, missing = launched.logs(), launched.missing()
    finally:
        if changes:
            changes.end()
        ears.close()
        launched.end()
    os.nice(NICE)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    lived = [fault["alive_after"] for fault in run["faults"] if "alive_after" in fault]
    evidence = Evidence(
        bag=folder / "bag", logs=logs, exit_code=code, memory=memory, alive_after=max(lived, default=None),
        own_bag=folder / "own-bag", split_bag=folder / "split-bag", binaries=binaries, seen=launched.seen, tap=launched.tap, spoken=launched.spoken, refused=changes.problems,
        missing=missing, left=launched.left,
    )
    return judge.judge(run, windows, evidence)


if __name__ == "__main__":
    BINARIES, FOLDER, RUN, SEED = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3], int(sys.argv[4])
    verdict.write(FOLDER, SEED, conduct(matrix.run(RUN), BINARIES, FOLDER, SEED))
