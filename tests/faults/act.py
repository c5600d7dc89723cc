"""Does what a fault of the matrix says, from outside the nodes; each gives when it began and was over (s, wall clock)."""

import os
import re
import signal
import subprocess
import threading
import time
from pathlib import Path

import inject
from changes import Changes
from hosts import BASE
from launched import APART, PATIENCE, ROBOTS, Launched

# s, for which the bed is watched after the launcher's death.
ALONE = 3.0


def do(fault: dict, launched: Launched, ears: inject.Ears, changes: Changes) -> tuple[float, float]:
    """Whatever the fault says."""
    if "joins" in fault:
        return join(fault, launched, changes)
    if "launcher" in fault:
        return kill_launcher(fault, launched)
    if "kill" in fault:
        return kill(fault, launched)
    if "parts" in fault:
        return part(fault, launched)
    if "dies" in fault:
        return dies(fault, launched)
    if "double" in fault:
        return double(fault, launched)
    if "pause" in fault:
        return pause(fault, launched)
    if "network" in fault:
        return network(fault, launched)
    if "second" in fault:
        return second(fault, launched)
    if "serial" in fault:
        return serial(fault, launched)
    if "nothing" in fault:
        # What it is about was done before the run, or goes on all the time.
        began = time.time()
        time.sleep(fault.get("for", 0.0))
        return began, time.time()
    if "fill" in fault:
        return fill(fault, launched)
    if "clock" in fault:
        return clock(fault, launched)
    began = inject.INJECTIONS[fault["publish"]](ears, fault["for"])
    return began, time.time()


class Watch:
    """Waits beside what is done until the launcher names a process; then `fault["reported"]` is how long that took, s."""

    # Longer than a report may take, s, and how often it is looked for.
    PATIENCE, GLANCE = 1.0, 0.01

    def __init__(self, fault: dict, launched: Launched, pid: int, what: str):
        label = next((label for label, known in launched.processes().items() if known == pid), None)
        self.fault, self.launched = fault, launched
        self.pattern = None if label is None else rf"\[{re.escape(label.partition(':')[2])}\]: process {what}"
        self.before = self._count()
        self.began = time.monotonic()
        self.thread = threading.Thread(target=self._wait)
        self.thread.start()

    def _count(self) -> int:
        return 0 if self.pattern is None else len(re.findall(self.pattern, self.launched.all_logs()))

    def _wait(self) -> None:
        while time.monotonic() < self.began + self.PATIENCE:
            if self._count() > self.before:
                self.fault["reported"] = time.monotonic() - self.began
                return
            time.sleep(self.GLANCE)

    def end(self) -> None:
        """Waits no longer than it may take."""
        self.thread.join()


def kill(fault: dict, launched: Launched) -> tuple[float, float]:
    """kill -9; over when the victim lives again."""
    others = [pid for label, pid in launched.processes().items() if not label.startswith(f"{APART}:")]
    before = launched.all_logs().count("process started with pid")
    pid = launched.pid_of(fault["kill"])
    watch = Watch(fault, launched, pid, "has died")
    fault["pid"] = pid
    os.kill(pid, signal.SIGKILL)
    began = time.time()
    try:
        return killed(fault, launched, others, before, began)
    finally:
        watch.end()


def killed(fault: dict, launched: Launched, others: list[int], before: int, began: float) -> tuple[float, float]:
    """Waits until the victim lives again, or the others do not."""
    if fault.get("ends"):
        fault["alive_after"] = outlive(others)
        # The bed goes on, and shows what robots do.
        time.sleep(max(0.0, began + ALONE - time.time()))
    elif not fault.get("gone"):
        deadline = time.monotonic() + 5.0
        while launched.all_logs().count("process started with pid") <= before and time.monotonic() < deadline:
            time.sleep(0.02)
        return began, time.time()
    return began, began


def kill_launcher(fault: dict, launched: Launched) -> tuple[float, float]:
    """kill -9 of the launcher of a host that is not the base station; after a while somebody starts it again. Over when its nodes live again."""
    host = fault["launcher"]
    nodes = [pid for label, pid in launched.processes().items() if label.startswith(f"{host}:")]
    os.kill(launched.launchers[host].pid, signal.SIGKILL)
    began = time.time()
    fault["alive_after"] = outlive(nodes)
    launched.launchers[host].wait()
    time.sleep(max(0.0, began + fault["for"] - time.time()))
    launched.launch_again(host)
    return began, time.time()


def double(fault: dict, launched: Launched) -> tuple[float, float]:
    """The same command line once more: it must be refused."""
    pid = launched.pid_of(fault["double"])
    line = Path(f"/proc/{pid}/cmdline").read_bytes().decode().strip("\0").split("\0")
    began = time.time()
    second = launched.start(BASE, Path(line[0]).name, *line[1:])
    try:
        fault["code"] = second.wait(3.0)
    except subprocess.TimeoutExpired:
        second.kill()
        fault["code"] = second.wait()
    ended = time.time()
    said = (launched.folder / f"{BASE}-{Path(line[0]).name}.log").read_text(encoding="utf-8", errors="replace")
    if "another process on this host is" in said:
        fault["reported"] = ended - began
    return began, ended


def second(fault: dict, launched: Launched) -> tuple[float, float]:
    """The same command line once more for a while, on another host or as another node, where no lease is held."""
    pid = launched.pid_of(fault["second"])
    line = Path(f"/proc/{pid}/cmdline").read_bytes().decode().strip("\0").split("\0")
    host, program = fault.get("host", BASE), Path(line[0]).name
    if "as" in fault:
        line = [re.sub("^__node:=.*", f"__node:={fault['as']}", word) for word in line]
    began = time.time()
    other = launched.start(host, program, *line[1:])
    log = launched.folder / f"{host}-{program}.log"
    while time.time() < began + fault["for"]:
        if "reported" not in fault and "another process uses it" in log.read_text(encoding="utf-8", errors="replace"):
            fault["reported"] = time.time() - began
        time.sleep(0.01)
    ended = time.time()
    other.send_signal(signal.SIGINT)
    other.wait(PATIENCE)
    return began, ended


def join(fault: dict, launched: Launched, changes: Changes) -> tuple[float, float]:
    """The host of a robot that was never there is switched on, and the robot is named among those that take part; over when it does."""
    began = time.time()
    launched.switch_on(fault["joins"])
    changes.ask(robots=ROBOTS)
    return began, time.time()


def serial(fault: dict, launched: Launched) -> tuple[float, float]:
    """The serial line is out of its socket for a while."""
    began = time.time()
    launched.line.say("out")
    time.sleep(fault["for"])
    launched.line.say("in")
    return began, time.time()


def fill(fault: dict, launched: Launched) -> tuple[float, float]:
    """The disk of the recorder is full."""
    fault["pid"] = launched.pid_of(fault["victim"])
    watch = Watch(fault, launched, fault["pid"], "has died")
    began = time.time()
    with open(launched.disk / "filler", "wb", buffering=0) as filler:
        try:
            while True:
                filler.write(bytes(4096))
        except OSError:
            pass
    ended = time.time()
    watch.end()
    if "reported" in fault:
        # It is full now, and was not before.
        fault["reported"] = max(0.0, fault["reported"] - (ended - began))
    return began, ended


def clock(fault: dict, launched: Launched) -> tuple[float, float]:
    """The wall clock of a host jumps by so many hours, and stays there."""
    now = time.time()
    launched.set_clock(fault.get("host", BASE), fault["clock"])
    return now, now


def pause(fault: dict, launched: Launched) -> tuple[float, float]:
    """SIGSTOP for a while."""
    pid = launched.pid_of(fault["pause"])
    watch = Watch(fault, launched, pid, "was stopped")
    began = time.time()
    os.kill(pid, signal.SIGSTOP)
    time.sleep(max(0.0, began + fault["for"] - time.time()))
    os.kill(pid, signal.SIGCONT)
    ended = time.time()
    watch.end()
    return began, ended


def dies(fault: dict, launched: Launched) -> tuple[float, float]:
    """A process is dead for a while: it does nothing, and is only then killed, so that its launcher starts another."""
    pid = launched.pid_of(fault["dies"])
    began = time.time()
    os.kill(pid, signal.SIGSTOP)
    time.sleep(fault["for"])
    killed = kill(fault | {"kill": fault["dies"]}, launched)
    fault["pid"] = pid
    return began, killed[1]


def network(fault: dict, launched: Launched) -> tuple[float, float]:
    """Bad links of hosts for a while."""
    began = time.time()
    launched.hosts.change(fault["hosts"], fault["network"])
    time.sleep(fault["for"])
    launched.hosts.change(fault["hosts"], {})
    return began, time.time()


def part(fault: dict, launched: Launched) -> tuple[float, float]:
    """The hosts of pairs do not reach one another for a while; where a process `dies`, from `before` its death to its next life."""
    began = time.time()
    launched.hosts.part(fault["parts"])
    if "dies" in fault:
        time.sleep(fault["before"])
        began, _ = dies(fault, launched)
    else:
        time.sleep(fault["for"])
    launched.hosts.part([])
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
