"""A formation as processes, on this host or on several, and the recorder whose bag is judged."""

import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import time
import zlib
from collections.abc import Callable
from pathlib import Path

import yaml

from hosts import BASE, GATE, RADIO, SLOW_CONNECTS, SLOW_LISTENS, ZENOH, Hosts

ROOT = Path(__file__).resolve().parents[2]
# Nothing that a run waits for takes longer, s.
PATIENCE = 60.0
# A file system in memory.
MEMORY = Path("/dev/shm")
# What a viewer on another host sees, and its pixels: 9 kB an image.
IMAGES, PICTURE = "/side/image_raw", (64, 48)
# Where the launcher of the test bed is where it is not that of the nodes.
APART = "bed"
# Where a Zenoh router listens.
ROUTER = 7447
# Topics of what robots report.
REPORTS = r"/robot\d/(link|battery_state|wheel_odom|range_\d)"
ROBOTS = ["robot1", "robot2", "robot3", "robot4"]
# Where they begin in the square, where the bed is launched apart (launch/square.launch.yaml).
POSES = "[0.15, 0.25, 0.50, 0.95, 0.20, 0.40, 0.20, 1.60, -0.30, 0.90, 1.55, -0.80]"


class Line:
    """A serial line that can be unplugged (line.py)."""

    def __init__(self, far: Path, near: Path, tap: Path):
        program = Path(__file__).with_name("line.py")
        command = [sys.executable, str(program), str(far), str(near), str(tap)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.process.stdout.readline()

    def say(self, word: str) -> None:
        """`out` or `in`."""
        self.process.stdin.write(word + "\n")
        self.process.stdin.flush()
        self.process.stdout.readline()

    def close(self) -> None:
        """The line is gone."""
        self.process.stdin.close()
        self.process.wait(PATIENCE)


def picture(width: int, height: int) -> bytes:
    """A grey PNG."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    rows = zlib.compress((b"\0" + b"\x80" * 3 * width) * height)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


def listens(pid: int, port: int) -> bool:
    """Whether somebody in the network of this process takes connections."""
    tables = [Path(f"/proc/{pid}/net/{family}").read_text(encoding="ascii") for family in ("tcp", "tcp6")]
    return any(f":{port:04X} " in table for table in tables)


def wait_for(holds: Callable[[], bool]) -> None:
    """Until it holds."""
    deadline = time.monotonic() + PATIENCE
    while not holds():
        if time.monotonic() > deadline:
            raise TimeoutError("what a run waits for did not come")
        time.sleep(0.02)


class Launched:
    """A formation with a domain, shared memory, state folders and serial port of its own."""

    def __init__(self, run: dict, binaries: Path, folder: Path, seed: int):
        self.folder, self.binaries = folder, binaries
        # Where nodes keep it by themselves, too: a disk that is slow to replace a file is no fault of the matrix.
        self.state = MEMORY / f"trench-faults-{os.getpid()}"
        self.hosts = Hosts(run["hosts"], ROBOTS, seed) if "hosts" in run else None
        self.launchers: dict[str, subprocess.Popen] = {}
        # What each of them was started with: a launch file and its arguments.
        self.files: dict[str, tuple[str, dict[str, str]]] = {}
        self.recorder, self.line, self.disk = None, None, None
        # What runs beside the launch, by name, and what somebody on another host saw.
        self.named: dict[str, subprocess.Popen] = {}
        self.seen = folder / "seen"
        # Names of files in shared memory, when all had ended.
        self.left: list[str] = []
        self.clocks = run.get("clocks", False)
        # Arguments of what runs on a robot's own host.
        self.of_robots = run.get("of_robots", {})
        self.own_bag = folder / "own-bag"
        self.tap, self.spoken = folder / "line.tap", folder / "spoken"
        try:
            self._start(run, seed)
        except BaseException:
            self.end()
            raise

    def _start(self, run: dict, seed: int) -> None:
        if self.hosts and self.hosts.kind == ZENOH:
            self.launch(GATE, "router")
        if self.hosts and self.hosts.kind == RADIO:
            near = self.named["near router"] = self.start(BASE, "trench", "router", variables={"ZENOH_CONFIG_OVERRIDE": SLOW_LISTENS})
            wait_for(lambda: listens(near.pid, ROUTER))
        bed = [*run.get("bed", []), *(fault["bed"] for fault in run["faults"] if "bed" in fault)]
        faults = self.folder / "faults.yaml"
        faults.write_text(yaml.safe_dump({"faults": bed}))
        # The test bed of a run that was killed left its link, and the terminal behind it may be the line's own by now.
        (self.folder / "port").unlink(missing_ok=True)
        self.line = Line(self.folder / "port", self.folder / "plug", self.tap)
        if self.clocks:
            self._make_clocks()
        if "disk" in run:
            self.disk = self.folder / "disk"
            self.disk.mkdir()
            subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={run['disk']}", "tmpfs", str(self.disk)], check=True)
            self.own_bag = self.disk / "own-bag"
        arguments = run.get("arguments", {}) | {
            "port": str(self.folder / "port"),
            "bag": str(self.own_bag),
            "seed": str(seed),
            **({"faults": str(faults)} if bed else {}),
            **({"key": str(self._make_key())} if run.get("key") else {}),
            "bridge_port": str(self.folder / "plug"),
            **({} if not self.hosts else {"bridge": "false"} if self.hosts.kind == RADIO else {"controllers": "false"}),
        }
        # Over a slow link nobody records what robots report.
        left_out = ["-p", f"exclude_regex:={REPORTS}"] if self.hosts and self.hosts.kind == RADIO else []
        self.recorder = self.start(
            BASE, "bag_recorder", "--ros-args", "-r", "__node:=judge", "-p", f"output:={self.folder / 'bag'}",
            "-p", f"robots:=[{', '.join(ROBOTS)}]", *left_out, true_clock=True,
        )
        if run.get("apart"):
            known = {name: arguments[name] for name in ("port", "seed", "faults", "key") if name in arguments}
            self.launch(APART, "testbed", robots=f"[{', '.join(ROBOTS)}]", poses=POSES, **known)
            arguments |= {"testbed": "false", "poses": POSES}
        self.launch(BASE, run["launch"], **arguments)
        if self.hosts and self.hosts.kind == RADIO:
            # Whoever comes late, when hundreds of things are declared already, hears of all of them.
            far = self.named["far router"] = self.start(RADIO, "trench", "router", variables={"ZENOH_CONFIG_OVERRIDE": SLOW_CONNECTS})
            wait_for(lambda: listens(far.pid, ROUTER))
            self.launch(
                RADIO, "bridge_host", robots=f"[{', '.join(ROBOTS)}]", port=str(self.folder / "plug"), read_best_effort='["*"]'
            )
            self._look()
        elif self.hosts:
            for robot in ROBOTS:
                if robot != run.get("late"):
                    self.switch_on(robot)
        if "splits" in run:
            self.named["splitting recorder"] = self.start(
                BASE, "bag_recorder", "--ros-args", "-r", "__node:=splitter", "-p", f"output:={self.folder / 'split-bag'}",
                "-p", f"robots:=[{', '.join(ROBOTS)}]", "-p", f"max_bag_duration:={run['splits']}",
            )
        if "view" in run:
            self.named["view"] = self.start(BASE, "trench", "view", "--port", "0")
            self._camera()

    def switch_on(self, robot: str) -> None:
        """A robot's own host. Where a router is killed, what its controller says is recorded there, too: on the way to the base station it may
        be lost for who records, and come to the bridge. (By DDS it is said again.)"""
        if self.hosts.kind == ZENOH:
            self.named[f"recorder of {robot}"] = self.start(
                robot, "bag_recorder", "--ros-args", "-r", "__node:=recorder", "-r", f"__ns:=/{robot}", "-p", f"output:={self.spoken / robot}",
                "-p", f"topics:=['/{robot}/cmd_vel:geometry_msgs/msg/TwistStamped']", true_clock=True,
            )
        self.launch(robot, "robot_host", robot=robot, robots=f"[{', '.join(ROBOTS)}]", **self.of_robots)

    def _look(self) -> None:
        """A small camera on the base station, and somebody on the radio's host who records it."""
        self._camera()
        self.named["viewer"] = self.start(
            RADIO, "bag_recorder", "--ros-args", "-r", "__node:=viewer", "-p", f"output:={self.seen}",
            "-p", f"topics:=['{IMAGES}:sensor_msgs/msg/Image']", "-p", 'read_best_effort:=["*"]',
        )

    def _camera(self) -> None:
        """A camera besides the one that robots are localized by."""
        pictures = self.folder / "pictures"
        pictures.mkdir()
        (pictures / "floor.png").write_bytes(picture(*PICTURE))
        self.named["camera"] = self.start(
            BASE, "overhead_camera", "--ros-args", "-r", "__node:=side_camera", "-r", f"/overhead/image_raw:={IMAGES}",
            "-p", "source:=folder", "-p", f"path:={pictures}", "-p", "rate:=10.0", "-p", "repeat:=true",
            "-p", f"publish_over_network:=[{IMAGES}]", "-p", "network_rate:=25000.0",
        )

    def launch(self, host: str, file: str, **arguments: str) -> None:
        """Starts a launch file on a host."""
        self.files[host] = (file, arguments)
        self.launchers[host] = self.start(
            host, "trench", "launch", str(ROOT / "launch" / f"{file}.launch.yaml"),
            "--run-dir", str(self.folder / "launch" / host), *(f"{name}:={value}" for name, value in arguments.items()),
        )

    def launch_again(self, host: str) -> None:
        """Starts on a host what was started there before, and waits until it is."""
        before = self.folder / "launch" / host
        before.rename(before.with_name(f"{host}-before"))
        file, arguments = self.files[host]
        self.launch(host, file, **arguments)
        wait_for(lambda: "process started with pid" in self.log(host))

    def environment(self, host: str, true_clock: bool = False) -> dict[str, str]:
        """Of a process on a host."""
        own = {"TRENCH_SHM_PREFIX": self.shared_memory()} if self.hosts is None else self.hosts.environment(host)
        own |= {"TRENCH_STATE_DIR": str(self.state / host), "PATH": f"{self.binaries}:{os.environ['PATH']}"}
        if self.clocks and not true_clock:
            own |= {"LD_PRELOAD": str(self.folder / "wall_clock.so"), "WALL_CLOCK": str(self.folder / f"{host}.clock")}
        return os.environ | own

    def _make_key(self) -> Path:
        path = self.folder / "key"
        path.touch(mode=0o600)
        path.write_text("000102030405060708090a0b0c0d0e0f\n", encoding="ascii")
        return path

    def _make_clocks(self) -> None:
        library, source = self.folder / "wall_clock.so", Path(__file__).with_name("wall_clock.c")
        subprocess.run(["cc", "-shared", "-fPIC", "-O2", "-o", str(library), str(source), "-ldl"], check=True)
        for host in [BASE, *ROBOTS]:
            self.set_clock(host, 0.0)

    def set_clock(self, host: str, hours: float) -> None:
        """How far the wall clock of a host is off from now on."""
        # Written in place: processes have it in their memory.
        path = self.folder / f"{host}.clock"
        with open(path, "r+b" if path.exists() else "wb") as clock:
            clock.write(struct.pack("<q", int(hours * 3.6e12)))

    def start(
        self, host: str, program: str, *arguments: str, true_clock: bool = False, variables: dict[str, str] | None = None
    ) -> subprocess.Popen:
        """Starts a program of ours on a host."""
        command = [*self._there(host), str(self.binaries / program), *arguments]
        with open(self.folder / f"{host}-{program}.log", "a", encoding="utf-8") as log:
            return subprocess.Popen(command, env=self.environment(host, true_clock) | (variables or {}), stdout=log, stderr=log, cwd=ROOT)

    def run(self, host: str, command: list[str], name: str) -> subprocess.Popen:
        """Starts a program of the tests' on a host, which is spoken to line by line."""
        with open(self.folder / f"{host}-{name}.log", "w", encoding="utf-8") as log:
            return subprocess.Popen(
                [*self._there(host), *command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=log, text=True
            )

    def _there(self, host: str) -> list[str]:
        """What stands in front of a command that runs on a host."""
        return self.hosts.command(host) if self.hosts else []

    def shared_memory(self) -> str:
        """With what the names of its shared memory begin."""
        return f"tf{os.getpid()}"

    def log(self, host: str = BASE) -> str:
        """What the launcher of a host says so far."""
        path = self.folder / "launch" / host / "log" / "launch.log"
        return path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""

    def logs(self) -> dict[str, str]:
        """What the launcher of each host says so far."""
        return {host: self.log(host) for host in self.launchers}

    def all_logs(self) -> str:
        """What all launchers say."""
        return "\n".join(self.logs().values())

    def missing(self) -> list[str]:
        """What runs beside the launch of the base station, and has ended."""
        others = {f"the launcher of {host}": launcher for host, launcher in self.launchers.items() if host != BASE}
        return [name for name, process in {**others, **self.named, "the judge's recorder": self.recorder}.items() if process.poll() is not None]

    def processes(self) -> dict[str, int]:
        """Label of each process, behind its host, and its latest pid."""
        return {
            f"{host}:{label}": int(pid)
            for host in self.launchers
            for label, pid in re.findall(r"\[([\w/.-]+)\]: process started with pid \[(\d+)\]", self.log(host))
        }

    def pid_of(self, victim: str) -> int:
        """Of `overhead_localizer`, `robot2/formation_controller` or `router`."""
        if victim == "launcher":
            return self.launchers[BASE].pid
        if victim in self.named:
            return self.named[victim].pid
        *namespace, program = victim.split("/")
        for label, pid in self.processes().items():
            # What is not a program of its own is known by its name in the launch file.
            if label.partition(":")[2].rpartition("-")[0] == victim:
                return pid
            try:
                line = Path(f"/proc/{pid}/cmdline").read_bytes().decode(errors="replace").split("\0")
            except OSError:
                continue
            if Path(line[0]).name == program and all(f"__ns:=/{name}" in line for name in namespace):
                return pid
        raise LookupError(f"no process {victim}")

    def memory(self) -> dict[str, int]:
        """Resident bytes of each process, by label: who was started again is held against its earlier life."""
        result = {}
        beside = {f"launcher of {host}": launcher for host, launcher in self.launchers.items()} | self.named
        for label, pid in {**self.processes(), **{name: process.pid for name, process in beside.items()}}.items():
            try:
                pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
            except (OSError, IndexError):
                continue
            result[label] = pages * os.sysconf("SC_PAGE_SIZE")
        return result

    def kill(self) -> None:
        """kill -9 of everything at once, as when the machine runs out of memory: nobody tidies up."""
        for pid in [*self.processes().values(), *(launcher.pid for launcher in self.launchers.values()), self.recorder.pid]:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        for process in [*self.launchers.values(), self.recorder]:
            process.wait(PATIENCE)
        # The line is ours: two between the same ends would feed each other.
        self.line.close()

    def wait(self) -> int:
        """Waits for the base station's launch to end; gives its exit code."""
        launcher = self.launchers[BASE]
        try:
            return launcher.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            launcher.send_signal(signal.SIGINT)
            return launcher.wait(PATIENCE)

    def end(self) -> None:
        """Ends whatever still runs, and forgets what it shared."""
        left = [*self.launchers.values(), *self.named.values(), *([self.recorder] if self.recorder else [])]
        for process in left:
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        for process in left:
            process.wait(PATIENCE)
        if self.line:
            self.line.close()
        if self.disk:
            shutil.copytree(self.own_bag, self.folder / "own-bag", dirs_exist_ok=True)
            subprocess.run(["umount", str(self.disk)], check=True)
        if self.hosts:
            self.hosts.close()
        shutil.rmtree(self.state, ignore_errors=True)
        # What iceoryx2 keeps for the next process of these names: an empty folder, and a page that says that there is nobody.
        files = (file for found in self.shared() for file in [found, *found.rglob("*")] if file.is_file())
        self.left = [file.name for file in files if file.suffix != ".global_mgmt"]
        for file in self.shared():
            if file.is_dir():
                shutil.rmtree(file, ignore_errors=True)
            else:
                file.unlink(missing_ok=True)

    def shared(self) -> list[Path]:
        """What there is of its shared memory."""
        # Not that of a process whose number begins with the digits of ours.
        return sorted(MEMORY.glob(f"trench_*_{self.shared_memory()}[!0-9]*"))
