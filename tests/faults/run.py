"""Runs the fault matrix: launches a formation, does what a run of tests/faults/matrix.yaml says, has the bag judged.

Started by scripts/faults, which sets the environment up.
"""

import argparse
import datetime
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import asdict
from pathlib import Path

import yaml

import inject
import judge
import table

ROOT = Path(__file__).resolve().parents[2]
RESULTS = ROOT / "run" / "faults"

# Nothing that a run waits for takes longer, s.
PATIENCE = 60.0


class Launched:
    """A formation as processes, with a domain, shared memory, state folder and serial port of its own."""

    def __init__(self, run: dict, binaries: Path, folder: Path, seed: int):
        self.folder, self.binaries = folder, binaries
        self.environment = os.environ | {
            "ROS_DOMAIN_ID": os.environ["ROS_DOMAIN_ID"],
            "TRENCH_SHM_PREFIX": f"faults{os.getpid()}_",
            "TRENCH_STATE_DIR": str(folder / "state"),
            "PATH": f"{binaries}:{os.environ['PATH']}",
        }
        bed = [fault["bed"] for fault in run["faults"] if "bed" in fault]
        faults = folder / "faults.yaml"
        faults.write_text(yaml.safe_dump({"faults": bed}))
        arguments = run.get("arguments", {}) | {
            "port": str(folder / "port"),
            "bag": str(folder / "own-bag"),
            "seed": str(seed),
            **({"faults": str(faults)} if bed else {}),
        }
        self.recorder = self.start(
            "bag_recorder", "--ros-args", "-r", "__node:=judge", "-p", f"output:={folder / 'bag'}",
            "-p", "robots:=[robot1, robot2, robot3, robot4]",
        )
        self.launcher = self.start(
            "trench", "launch", str(ROOT / "launch" / f"{run['launch']}.launch.yaml"), "--run-dir", str(folder / "launch"),
            *(f"{name}:={value}" for name, value in arguments.items()),
        )

    def start(self, program: str, *arguments: str) -> subprocess.Popen:
        with open(self.folder / f"{program}.log", "w", encoding="utf-8") as log:
            return subprocess.Popen(
                [str(self.binaries / program), *arguments], env=self.environment, stdout=log, stderr=log, cwd=ROOT
            )

    def log(self) -> str:
        path = self.folder / "launch" / "log" / "launch.log"
        return path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""

    def processes(self) -> dict[str, int]:
        """Label of each process and its latest pid."""
        started = re.findall(r"\[([\w/.-]+)\]: process started with pid \[(\d+)\]", self.log())
        return {label: int(pid) for label, pid in started}

    def pid_of(self, victim: str) -> int:
        """Of `overhead_localizer` or `robot2/formation_controller`."""
        if victim == "launcher":
            return self.launcher.pid
        *namespace, program = victim.split("/")
        for pid in self.processes().values():
            try:
                line = Path(f"/proc/{pid}/cmdline").read_bytes().decode(errors="replace").split("\0")
            except OSError:
                continue
            if Path(line[0]).name == program and all(f"__ns:=/{name}" in line for name in namespace):
                return pid
        raise LookupError(f"no process {victim}")

    def memory(self) -> dict[str, int]:
        """Resident bytes of each process, by pid and label."""
        result = {}
        for label, pid in self.processes().items():
            try:
                pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
            except (OSError, IndexError):
                continue
            result[f"{label} {pid}"] = pages * os.sysconf("SC_PAGE_SIZE")
        return result

    def end(self) -> int:
        """Waits for the launch and ends the recorder; gives the launcher's exit code."""
        try:
            code = self.launcher.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.launcher.send_signal(signal.SIGINT)
            code = self.launcher.wait(PATIENCE)
        self.recorder.send_signal(signal.SIGINT)
        self.recorder.wait(PATIENCE)
        return code


def do(fault: dict, launched: Launched, ears: inject.Ears) -> tuple[float, float]:
    """Does what a fault says; gives when it began and was over (s, wall clock)."""
    began = time.time()
    if "kill" in fault:
        others = list(launched.processes().values())
        os.kill(launched.pid_of(fault["kill"]), signal.SIGKILL)
        began = ended = time.time()
        if fault.get("ends"):
            fault["alive_after"] = outlive(others)
        if not (fault.get("gone") or fault.get("ends")):
            # Over when the victim lives again.
            text = launched.log()
            deadline = time.monotonic() + 5.0
            before = text.count("process started with pid")
            while launched.log().count("process started with pid") <= before and time.monotonic() < deadline:
                time.sleep(0.02)
            ended = time.time()
        return began, ended
    if "double" in fault:
        # The same command line once more: it must be refused.
        pid = launched.pid_of(fault["double"])
        line = Path(f"/proc/{pid}/cmdline").read_bytes().decode().strip("\0").split("\0")
        double = launched.start(Path(line[0]).name, *line[1:])
        try:
            fault["code"] = double.wait(3.0)
        except subprocess.TimeoutExpired:
            double.kill()
            fault["code"] = double.wait()
        return began, time.time()
    if "pause" in fault:
        pid = launched.pid_of(fault["pause"])
        os.kill(pid, signal.SIGSTOP)
        time.sleep(fault["for"])
        os.kill(pid, signal.SIGCONT)
        return began, time.time()
    began = inject.INJECTIONS[fault["publish"]](ears, fault["for"])
    return began, time.time()


def lives(pid: int) -> bool:
    """Whether a process runs: one that has ended and waits for its parent does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def outlive(pids: list[int]) -> float:
    """How long the last of these lives on, s; gives up after ten."""
    begun = time.monotonic()
    while any(map(lives, pids)) and time.monotonic() < begun + 10.0:
        time.sleep(0.01)
    return time.monotonic() - begun


def conduct(run: dict, binaries: Path, seed: int) -> list[judge.Verdict]:
    """Carries out a run and judges its faults."""
    folder = RESULTS / run["name"]
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    launched = Launched(run, binaries, folder, seed)
    ears = inject.Ears(launched.log)
    windows, memory = [], []
    try:
        ears.wait_for_start(PATIENCE)
        memory.append(launched.memory())
        for fault in run["faults"]:
            if "bed" in fault:
                continue
            ears.wait_until(fault["at"])
            began, ended = do(fault, launched, ears)
            windows.append((fault, began, ended))
        if not any(fault.get("ends") for fault in run["faults"]):
            ears.wait_until(float(run["arguments"]["duration"]) - 1.0)
            memory.append(launched.memory())
    finally:
        ears.close()
        code = launched.end()
    lived = [fault["alive_after"] for fault in run["faults"] if "alive_after" in fault]
    alive_after = max(lived, default=None)
    subprocess.run(["bash", "-c", f"rm -f /dev/shm/{launched.environment['TRENCH_SHM_PREFIX']}*"], check=False)
    evidence = judge.Evidence(
        bag=folder / "bag", log=launched.log(), exit_code=code, memory=memory, alive_after=alive_after,
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


def chosen(runs: list[dict], arguments: argparse.Namespace) -> list[dict]:
    """The runs that the command line asks for."""
    if arguments.sample:
        day = datetime.date.today().toordinal()
        sample = [run for run in runs if run.get("sample")]
        return [sample[day % len(sample)]]
    if not arguments.names:
        return runs
    picked = []
    for name in arguments.names:
        found = [run for run in runs if name == run["name"] or any(name == fault["name"] for fault in run["faults"])]
        if not found:
            sys.exit(f"scripts/faults: there is no run or fault {name}; see scripts/faults --list")
        picked += [run for run in found if run not in picked]
    return picked


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*")
    parser.add_argument("--binaries", type=Path, required=True)
    parser.add_argument("--sample", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    runs = yaml.safe_load((ROOT / "tests" / "faults" / "matrix.yaml").read_text(encoding="utf-8"))["runs"]
    if arguments.list:
        for run in runs:
            print(f"{run['name']:12} {', '.join(fault['name'] for fault in run['faults'])}")
        return
    if not arguments.table:
        os.environ.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % 100))
        failed = False
        for run in chosen(runs, arguments):
            for verdict in conduct(run, arguments.binaries, arguments.seed):
                print(verdict.line(), flush=True)
                failed |= not verdict.passed
        if arguments.sample:
            sys.exit(failed)
    table.write(runs, RESULTS, ROOT / "docs" / "FAULTS.md")
    if not arguments.table:
        sys.exit(failed)


if __name__ == "__main__":
    main()
