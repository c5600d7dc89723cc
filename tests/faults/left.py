"""What recorders left: bags of the launch, and of recorders that did not end as they should."""

import math
import shutil
import subprocess
from pathlib import Path

from mcap.exceptions import McapError
from mcap.reader import make_reader

from bag import Run, Series
from evidence import Evidence
from motion import FRAME

# s, the longest gap in the bag.
GAP = 1.0
# Which bag a recorder that did not end as it should has left: that of the launch, in one file, or one in many, all of which but the last are finished.
LAUNCHED, SPLIT = "launched", "split"


def left_behind(evidence: Evidence, kind: str, began: float) -> list[str]:
    """What is wrong with a bag whose recorder did not end as it should: as it is `trench bag info` reads it, recovered it lacks a second at most of what
    came before the fault, and files that were finished before are whole bags by themselves."""
    bag, trench, problems = evidence.own_bag if kind == LAUNCHED else evidence.split_bag, str(evidence.binaries / "trench"), []
    if subprocess.run([trench, "bag", "info", str(bag)], check=False, capture_output=True).returncode != 0:
        problems.append(f"trench bag info cannot read {bag.name} as it was left")
    if kind == SPLIT:
        finished = sorted(bag.glob("*.mcap"), key=lambda file: int(file.stem.rpartition("_")[2]))[:-1]
        problems += [f"{file.name} is not whole, although the recorder had gone on to the next file" for file in finished if not is_whole(file)]
        if not finished:
            problems.append("no file was finished before the fault")
    recovered = bag.with_name(f"{bag.name}-recovered")
    shutil.rmtree(recovered, ignore_errors=True)
    done = subprocess.run([trench, "bag", "recover", str(bag), str(recovered)], check=False, capture_output=True)
    times = Run(recovered).log_times if done.returncode == 0 else []
    lost = began - max((at for at in times if at <= began), default=-math.inf)
    return problems + ([f"the bag ends {lost:.1f} s before the fault"] if lost > GAP else [])


def is_whole(file: Path) -> bool:
    """Whether a file of a bag has its index at the end, and a reader that knows nothing of Trench gets all that it counts."""
    try:
        with open(file, "rb") as stream:
            reader = make_reader(stream, validate_crcs=True)
            summary = reader.get_summary()
            counted = summary.statistics if summary else None
            return counted is not None and sum(1 for _ in reader.iter_messages()) == counted.message_count
    except (McapError, ValueError, OSError):
        return False


def recorded(bag: Run, run: dict, evidence: Evidence) -> list[str]:
    """What the bag that the launch itself records has lost of the run, which is at most a second but for a pause of its recorder."""
    if run["arguments"].get("record") != "true" or any("bag" in fault for fault in run["faults"]):
        return []
    if not (evidence.own_bag / "metadata.yaml").exists():
        return ["the launch has not finished its bag"]
    own, t0, end = Run(evidence.own_bag, run.get("clocks", False)), bag.t0 or math.inf, bag.stopped or math.inf
    # Who ends the run ends its recorder, which must have what came before.
    end = min([end, *(fault["began"] for fault in run["faults"] if fault.get("ends") and "began" in fault)])

    def samples(series: Series) -> int:
        # A wall clock that jumps goes by whole hours.
        return sum(t0 <= at - 3600.0 * round((at - t0) / 3600.0) <= end for at in series.times)

    paused = sum(fault["for"] for fault in run["faults"] if fault.get("pause") == "bag_recorder")
    lost = {robot: FRAME * (samples(series) - samples(own.truth.get(robot, Series()))) for robot, series in bag.truth.items()}
    return [f"the bag of the launch has lost {most:.1f} s of {robot}" for robot, most in lost.items() if most > GAP + paused]
