"""Shows that the judge sees what it is there for: a good run, and one doctored run for each criterion.

usage: python -m unittest judge_test, in this folder and the environment of scripts/ros-venv; scripts/test does that.
"""

import binascii
import os
import struct
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

from mcap_ros2.writer import Writer

import judge
import left
import matrix
import motion
from bag import Run, Series
from evidence import Evidence
from motion import FRAME
from wheels import PIECE, SPEED_TIMES_TIMER

# s, when the run begins, its fault begins and is over, and the run ends.
T0, BEGAN, ENDED, OVER = 1000.0, 1010.0, 1011.0, 1030.0
SPEED = 0.1
FAULT = {"name": "a-fault", "says": "camera: frozen"}
RUN = {"name": "a-run", "arguments": {"duration": "30.0"}, "faults": [FAULT]}
STAMPS = [T0 - 1.0 + FRAME * step for step in range(int((OVER - T0 + 1.5) / FRAME))]
LOG = "[ERROR] [rf_bridge-3]: process has died [pid 12, signal: 9 (SIGKILL)]\n"
OPERATOR = "[INFO] [operator-9]: process has finished cleanly [pid 19]\n"


def stuffed(body: bytes) -> bytes:
    """COBS of less than 254 bytes."""
    blocks = (body + b"\0").split(b"\0")[:-1]
    return b"".join(bytes([len(block) + 1]) + block for block in blocks) + b"\0"


def packet(speed: float) -> bytes:
    """Tells robot1's wheels one speed (docs/protocols/radio.md)."""
    timer = round(SPEED_TIMES_TIMER / speed)
    body = bytes([0x30, 0x30]) + bytes(7) + struct.pack("<BIHHB", 0, 1 << 1, timer, timer, 0)
    return stuffed(body + binascii.crc_hqx(body, 0xFFFF).to_bytes(2, "little"))


# As much of nav_msgs/Odometry as a bag is judged by.
RULE = "=" * 80 + "\nMSG: "
ODOMETRY = f"""std_msgs/Header header
a/Pose pose
a/Twist twist
{RULE}std_msgs/Header
builtin_interfaces/Time stamp
{RULE}a/Pose
a/Place pose
{RULE}a/Place
a/Vector position
{RULE}a/Twist
a/Turn twist
{RULE}a/Turn
a/Vector linear
a/Vector angular
{RULE}a/Vector
float64 x
float64 y
float64 z
"""


def write_bag(file: Path, start: float, end: float) -> None:
    """A bag of ground truth of robot1 in small chunks, which stands somewhere."""
    vector = {"x": 0.0, "y": 0.0, "z": 0.0}
    with open(file, "wb") as stream:
        writer = Writer(stream, chunk_size=500)
        schema = writer.register_msgdef("nav_msgs/msg/Odometry", ODOMETRY)
        for step in range(int((end - start) / FRAME)):
            at = start + step * FRAME
            stamp = {"sec": int(at), "nanosec": int(1e9 * (at % 1.0))}
            message = {"header": {"stamp": stamp}, "pose": {"pose": {"position": vector}}, "twist": {"twist": {"linear": vector, "angular": vector}}}
            writer.write_message("/ground_truth/robot1/odom", schema, message, log_time=int(1e9 * at), publish_time=int(1e9 * at))
        writer.finish()


def programs() -> Path:
    """Where the programs are that were built last: scripts/test builds them first."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", matrix.ROOT / "target"))
    built = [program for program in (target / "debug" / "trench", target / "release" / "trench") if program.exists()]
    if not built:
        raise FileNotFoundError(f"there is no trench in {target}: build it by cargo build --workspace --bins")
    return max(built, key=lambda program: program.stat().st_mtime).parent


class Judged(unittest.TestCase):
    """A robot that drives straight on behind its goal point, and stands while its camera is frozen."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.bag = Run(self.folder)
        self.bag.t0, self.bag.stopped = T0, OVER
        self.bag.truth["robot1"], self.bag.commands["robot1"], self.bag.stamps["robot1"] = Series(), Series(), Series()
        place, pieces = 0.0, []
        for at in STAMPS:
            drives = T0 <= at < OVER and not BEGAN + 0.1 <= at < ENDED
            place += SPEED * FRAME if drives else 0.0
            self.bag.truth["robot1"].add(at, (place, 0.0, SPEED if drives else 0.0, 0.0))
            self.bag.goals.add(at, {"robot1": (place, 0.0)})
            self.bag.log_times.append(at)
            if drives:
                self.bag.commands["robot1"].add(at, (SPEED, 0.0))
                self.bag.stamps["robot1"].add(at, at)
                pieces.append((at + 0.001, packet(SPEED)))
        self.bag.diagnostics = [(BEGAN + 0.1, "/overhead_localizer: camera: frozen", b"\2")]
        self.told(pieces)
        self.evidence = Evidence(
            bag=self.folder, logs={"base": OPERATOR}, exit_code=0, memory=[], alive_after=None, own_bag=self.folder, split_bag=self.folder, binaries=self.folder,
            seen=self.folder, tap=self.folder / "tap", spoken=self.folder / "spoken", refused=[], missing=[], left=[],
        )

    def told(self, pieces: list[tuple[float, bytes]]) -> None:
        """What the tap of the serial line has."""
        (self.folder / "tap").write_bytes(b"".join(PIECE.pack(at, len(piece)) + piece for at, piece in pieces))

    def problems(self, fault: dict | None = None, run: dict | None = None, **evidence) -> str:
        """What the judge has against the run."""
        fault = FAULT | (fault or {})
        run, evidence = RUN | {"faults": [fault]} | (run or {}), replace(self.evidence, **evidence)
        verdict = judge.one(self.bag, run, fault, (BEGAN, ENDED, OVER + 1.0), evidence)
        return "; ".join(verdict.problems + judge.whole(self.bag, run, evidence) + judge.contacts(self.bag, [(fault, BEGAN, ENDED)]))

    def moved(self, since: float, until: float, speed: float) -> None:
        """Other speeds of the robot, wherever it is."""
        series = self.bag.truth["robot1"]
        series.values = [(*value[:2], speed, 0.0) if since <= at < until else value for at, value in zip(series.times, series.values)]

    def test_a_good_run_passes(self):
        self.assertEqual(self.problems({"stops": True}), "")

    def test_contacts_count_whenever_they_are(self):
        self.bag.contacts = [(T0 + 1.0, "robot1 touches robot2")]
        self.assertIn("contact: robot1 touches robot2", self.problems())
        self.bag.contacts = [(BEGAN + 0.1, "robot1 touches robot2")]
        self.assertIn("contact", self.problems())
        self.assertNotIn("contact", self.problems({"touches": "robot1"}))

    def test_contacts_with_obstacles_and_edges_count_too(self):
        for thing in ("obstacle 3", "west edge"):
            self.bag.contacts = [(BEGAN + 0.1, f"robot1 touches {thing}")]
            self.assertIn(f"contact: robot1 touches {thing}", self.problems())
            self.assertIn(f"contact: robot1 touches {thing}", self.problems({"touches": "robot1"}))

    def test_a_contact_of_the_bag_is_what_the_test_bed_says(self):
        stamp = SimpleNamespace(sec=int(T0), nanosec=0)
        message = SimpleNamespace(header=SimpleNamespace(stamp=stamp), status=[SimpleNamespace(message="robot1 touches obstacle 3")])
        self.bag._take("/ground_truth/contacts", T0, message)
        self.assertIn("contact: robot1 touches obstacle 3", self.problems())

    def test_robots_must_be_beside_obstacles_where_the_matrix_says_so(self):
        self.bag.truth["robot1"].values = [(0.74, 0.478, *state[2:]) for state in self.bag.truth["robot1"].values]
        run = {"arguments": {"duration": "30.0", "obstacles": "tests/faults/obstacles.yaml"}}
        self.assertNotIn("went round an obstacle", self.problems({"rounds": True}, run))
        self.bag.truth["robot1"].values = [(0.74, 0.40, *state[2:]) for state in self.bag.truth["robot1"].values]
        self.assertIn("no robot went round an obstacle: 0.09 m of room", self.problems({"rounds": True}, run))

    def test_the_launcher_must_say_it_in_its_log_and_on_diagnostics(self):
        fault = {"says": "launcher", "kill": "robot1/formation_controller", "reported": 0.1}
        name = "/robot1/formation_controller: process: has died (signal: 9 (SIGKILL))"

        def said(at: float, text: str, more: dict | None = None) -> bool:
            self.bag.diagnostics = [(at, text, b"\1")]
            return "named it within" not in self.problems(fault | (more or {}))

        self.assertTrue(said(BEGAN + 0.2, f"{name} and is to be started again"))
        self.assertTrue(said(BEGAN + 0.2, f"{name}, not started again"))
        self.assertFalse(said(BEGAN + 0.6, f"{name} and is to be started again"))
        self.assertFalse(said(BEGAN + 0.2, f"{name} and is to be started again", {"reported": 0.6}))
        self.assertFalse(said(BEGAN + 0.2, f"{name} and was started again"))
        self.assertFalse(said(BEGAN + 0.2, f"{name.replace('robot1', 'robot2')} and is to be started again"))
        stopped = "/rf_bridge: process: was stopped by a signal and"
        self.assertTrue(said(BEGAN + 0.2, f"{stopped} does nothing until SIGCONT", {"kill": None, "pause": "rf_bridge"}))
        self.assertFalse(said(BEGAN + 0.2, f"{stopped} goes on", {"kill": None, "pause": "rf_bridge"}))

    def test_nobody_but_the_victim_may_end(self):
        self.assertIn("rf_bridge-3 on base ended too: died signal: 9 (SIGKILL)", self.problems(logs={"base": LOG + OPERATOR}))
        self.assertEqual(self.problems({"pid": 12}, logs={"base": LOG + OPERATOR}), "")
        self.assertEqual(self.problems(logs={"base": OPERATOR + LOG}), "")
        finished = LOG.replace("died", "finished cleanly").replace(", signal: 9 (SIGKILL)", "")
        self.assertIn("ended too", self.problems(logs={"base": OPERATOR, "robot2": finished}))
        self.assertIn("view ended too", self.problems(missing=["view"]))
        self.assertEqual(self.problems({"kill": "view", "gone": True, "pid": 12}, missing=["view"]).count("ended too"), 0)
        self.assertIn("the run ended with 11", self.problems(exit_code=11))

    def test_a_run_must_last(self):
        self.bag.stopped = OVER - 5.0
        self.assertIn("the run was stopped 25.0 s after the start", self.problems())

    def test_a_fault_must_be_named_in_time_and_not_before(self):
        said = self.bag.diagnostics[0][1]
        for at, complaint in ((BEGAN + 0.7, "named it within 0.5 s"), (BEGAN - 0.3, "was said 0.30 s before it")):
            self.bag.diagnostics = [(at, said, b"\2")]
            self.assertIn(complaint, self.problems())
        self.bag.diagnostics = [(BEGAN + 0.1, said, b"\0")]
        self.assertIn("named it", self.problems())
        self.assertIn("does not say what names it", self.problems({"says": None}))

    def test_robots_must_stand_where_control_is_not_safe(self):
        self.moved(BEGAN + 0.5, BEGAN + 0.6, SPEED)
        self.assertIn("robot1 stood after 0.5", self.problems({"stops": True}))
        self.moved(BEGAN - 2.0, BEGAN, 0.0)
        self.assertIn("robot1 stood before it", self.problems({"stops": True}))

    def test_robots_must_drive_where_nothing_keeps_them(self):
        self.assertIn("a robot stood for 0.8", self.problems({"drives": 0.3}))
        self.assertEqual(self.problems({"drives": 1.0}), "")
        self.assertEqual(self.problems({"drives": 0.3, "halts": ["robot1"]}), "")
        # Who is spared may stand or drive, who halts must not drive.
        self.assertEqual(self.problems({"drives": 0.3, "spares": ["robot1"]}), "")
        self.moved(BEGAN, ENDED, SPEED)
        self.assertNotIn("stood", self.problems({"drives": 0.3, "spares": ["robot1"]}))
        self.assertIn("robot1 stood never", self.problems({"drives": 0.3, "halts": ["robot1"]}))

    def test_robots_must_drive_after_a_fault_of_an_instant(self):
        self.moved(BEGAN, ENDED, SPEED)
        self.assertNotIn("a robot stood", self.problems({"drives": 0.3}))
        self.moved(ENDED + 0.2, ENDED + 0.8, 0.0)
        self.assertIn("a robot stood for 0.6", self.problems({"drives": 0.3}))

    def test_robots_must_stand_for_most_of_the_time_where_control_is_mostly_not_safe(self):
        self.assertEqual(self.problems({"rests": 0.8, "pulses": 0.3}), "")
        self.moved(BEGAN + 0.3, BEGAN + 0.7, SPEED)
        self.assertIn("a robot stood for 4", self.problems({"rests": 0.8}))
        moved = motion.stretch(self.bag, BEGAN + motion.AGE, ENDED)
        self.assertIn("a robot moved for 0.3", self.problems({"pulses": moved - 1.5 * motion.FRAME}))
        self.assertNotIn("moved for", self.problems({"pulses": moved - 0.5 * motion.FRAME}))
        self.bag.truth["robot1"] = Series()
        self.assertEqual(motion.resting_share(self.bag, BEGAN, ENDED), 0.0)

    def test_robots_that_stand_because_of_a_slow_network_are_told_of_by_the_stamp(self):
        fault = {"stalls": True, "for": ENDED - BEGAN, "says": "the pose is"}
        for said, missing in ((0.5, False), (0.7, True), (None, True)):
            self.bag.diagnostics = [(BEGAN + 5.0, "/robot1/formation_controller: motion: resting: the pose is 0.2 s old", b"\1")] if said else []
            self.bag.said = [BEGAN + said] if said else []
            self.assertEqual("why robots stand" in self.problems(fault), missing, said)
        self.moved(BEGAN, ENDED, SPEED)
        self.assertNotIn("why robots stand", self.problems(fault))

    def test_no_robot_moves_on_what_is_old(self):
        self.told([(at + 0.001, packet(SPEED)) for at in STAMPS if T0 <= at < T0 + 5.0])
        self.assertIn("robot1 moves at 5.", self.problems())

    def test_wheels_turn_on_young_commands_of_their_own_controller_alone(self):
        self.told([(at + 0.001, packet(0.2)) for at in STAMPS if T0 <= at < OVER])
        self.assertIn("which no command says", self.problems())
        last = max(at for at in self.bag.stamps["robot1"].values if at < BEGAN + 0.2)
        for late, named in ((0.5, True), (0.26, True), (0.24, False)):
            self.told([(last + late, packet(SPEED))])
            self.assertEqual("which no command says" in self.problems(), named, late)
        self.told([(BEGAN + 0.9, packet(SPEED))])
        self.assertIn("which no command says", self.problems())
        self.told([])
        self.assertIn("nothing was said to wheels", self.problems())

    def test_no_burst_of_old_commands(self):
        for step in range(9):
            self.bag.commands["robot1"].add(ENDED + 0.01 * step, (SPEED, 0.0))
            self.bag.stamps["robot1"].add(ENDED + 0.01 * step, BEGAN)
        for series in (self.bag.commands["robot1"], self.bag.stamps["robot1"]):
            pairs = sorted(zip(series.times, series.values))
            series.times, series.values = [at for at, _ in pairs], [value for _, value in pairs]
        self.assertIn("was commanded to move on information of", self.problems({"pause": "overhead_localizer"}))
        # Who held them back on their way, as a router does, did not send them: a recorder on the robot's host knows.
        (self.folder / "spoken" / "robot1").mkdir(parents=True)
        self.assertNotIn("was commanded to move on information of", self.problems({"pause": "router"}))

    def test_commands_are_numbers_within_limits(self):
        for command in ((0.4, 0.0), (0.0, 9.0), (float("nan"), 0.0), (float("inf"), 0.0)):
            self.bag.commands["robot1"].values[5] = command
            self.assertIn("is beyond its limits", self.problems())

    def test_robots_drive_again_and_form_in_time(self):
        self.moved(ENDED, ENDED + 2.5, 0.0)
        self.assertIn("not all robots were driven within 2.0 s of its end", self.problems())
        self.bag.goals.values = [{"robot1": (value["robot1"][0] + 0.05, 0.0)} for value in self.bag.goals.values]
        self.assertIn("the formation did not stand within 10.0 s", self.problems())

    def test_memory_does_not_grow_and_none_is_left(self):
        memory = [{"base:rf_bridge-3": 20_000_000}, {"base:rf_bridge-3": 31_000_000}]
        self.assertIn("base:rf_bridge-3 grew by 11.0 MB", self.problems(memory=memory))
        self.assertIn("is left in shared memory", self.problems(left=["trench_0_a_service"]))

    def test_bags_have_no_gaps(self):
        self.bag.log_times = [at for at in self.bag.log_times if not T0 + 2.0 < at < T0 + 3.5]
        self.assertIn("the bag has a gap of 1.5 s", self.problems())
        recorded = {"arguments": {"duration": "30.0", "record": "true"}}
        self.assertIn("the launch has not finished its bag", self.problems(run=recorded))
        (self.folder / "metadata.yaml").touch()
        self.assertIn("the bag of the launch has lost", self.problems(run=recorded))
        # Who ends the run ends its recorder: what counts came before.
        write_bag(self.folder / "own.mcap", T0 - 1.0, BEGAN + 0.3)
        self.assertIn("the bag of the launch has lost 19.", self.problems(run=recorded))
        ending = {"ends": True, "began": BEGAN, "kill": "launcher"}
        self.assertNotIn("the bag of the launch has lost", self.problems(ending, recorded, alive_after=0.1))
        write_bag(self.folder / "own.mcap", T0 - 1.0, BEGAN - 2.0)
        self.assertIn("the bag of the launch has lost 2.", self.problems(ending, recorded, alive_after=0.1))

    def test_a_bag_that_is_left_behind_is_read_and_lacks_little(self):
        bag, end = self.folder / "bag", T0
        bag.mkdir()
        for number in range(3):
            write_bag(bag / f"bag_{number}.mcap", end, end + 3.0 + 0.5 * number)
            end += 3.0 + 0.5 * number
        last = bag / "bag_2.mcap"
        last.write_bytes(last.read_bytes()[: last.stat().st_size - 1000])
        evidence = replace(self.evidence, split_bag=bag, own_bag=bag, binaries=programs())
        self.assertEqual(left.left_behind(evidence, left.SPLIT, end + 0.5), [])
        self.assertIn("the bag ends 4.", "".join(left.left_behind(evidence, left.LAUNCHED, end + 4.0)))
        first = bag / "bag_0.mcap"
        whole = first.read_bytes()
        for spoilt in (whole[:-200], whole[:300] + bytes([whole[300] ^ 1]) + whole[301:], b""):
            first.write_bytes(spoilt)
            self.assertIn("bag_0.mcap is not whole", "".join(left.left_behind(evidence, left.SPLIT, end + 0.5)))
        for file in bag.glob("*.mcap"):
            file.write_bytes(b"nothing that could be read")
        told = "".join(left.left_behind(evidence, left.LAUNCHED, end))
        self.assertIn("trench bag info cannot read bag as it was left", told)
        self.assertIn("the bag ends inf s before", told)
        self.assertIn("trench bag info cannot read bag", self.problems({"bag": left.LAUNCHED}, own_bag=bag, binaries=programs()))

    def test_links_say_that_a_robot_is_out_of_reach_and_no_other(self):
        for at in STAMPS:
            self.bag.links.setdefault("robot1", Series()).add(at, (True, 0.0, 2 if BEGAN <= at < ENDED else 1))
            self.bag.links.setdefault("robot2", Series()).add(at, (True, 0.0, 1))
        self.assertEqual(self.problems({"relayed": "robot1"}), "")
        self.assertIn("robot2 was reached through others for 0% of the time only", self.problems({"relayed": "robot2"}))
        # Once in a while is chance.
        places = [place for place, at in enumerate(STAMPS) if BEGAN <= at < ENDED]
        self.bag.links["robot2"].values[places[5]] = (True, 0.0, 2)
        self.assertEqual(self.problems({"relayed": "robot1"}), "")
        for place in places[:15]:
            self.bag.links["robot2"].values[place] = (True, 0.0, 2)
        self.assertIn("robot2 was out of reach, too", self.problems({"relayed": "robot1"}))

    def test_bursts_are_what_all_links_met_at_once(self):
        for number, robot in enumerate(("robot1", "robot2")):
            for at in STAMPS:
                # One burst for both; another one for robot2 alone.
                met = BEGAN + 0.2 <= at < BEGAN + 0.4 or (number == 1 and at > BEGAN + 0.6)
                self.bag.links.setdefault(robot, Series()).add(at, (True, 0.5 if met else 0.03, 1))
        self.assertEqual(self.problems({"bursts": 1}), "")
        self.assertIn("there were 1 bursts of interference, not 2", self.problems({"bursts": 2}))

    def test_nodes_of_another_host_end_with_its_launcher(self):
        self.assertEqual(self.problems({"launcher": "robot2", "alive_after": 0.3}), "")
        self.assertIn("nodes lived on for 1.4 s", self.problems({"launcher": "robot2", "alive_after": 1.4}))

    def test_who_does_not_hear_its_leader_follows_the_target_meanwhile(self):
        behind, alone = {"robot4": (0, 2, "robot1")}, {"robot4": (0, 2, "")}
        for at, made in ((T0, behind), (BEGAN + 0.6, alone), (ENDED + 2.0, behind)):
            self.bag.assignments.add(at, made)
        self.assertEqual(self.problems({"retargets": "robot4"}), "")
        self.bag.assignments.values[1] = behind
        self.assertIn("robot4 followed 'robot1' before, 'robot1' meanwhile", self.problems({"retargets": "robot4"}))

    def test_those_behind_a_robot_that_leaves_close_up_and_it_returns(self):
        chain = [{"robot1": (0, 1, ""), "robot4": (0, 2, "robot1"), "robot2": (0, 3, "robot4")}, {"robot1": (0, 1, ""), "robot2": (0, 2, "robot1")}]
        for at, made in ((T0, chain[0]), (BEGAN + 0.5, chain[1]), (ENDED + 2.0, chain[0])):
            self.bag.assignments.add(at, made)
        self.assertEqual(self.problems({"leaves": "robot4"}), "")
        self.assertIn("robot4 did not lead before", self.problems({"quits": "robot4"}))
        self.assertIn("robot1 did not follow before", self.problems({"leaves": "robot1"}))
        self.bag.assignments.values[1] = {"robot1": (0, 1, ""), "robot2": (0, 2, "")}
        self.assertIn("they do not follow one another", self.problems({"leaves": "robot4"}))
        self.bag.assignments.values[1] = chain[0]
        self.assertIn("robot4 had not quit the assignment after 3.0 s", self.problems({"leaves": "robot4"}))
        self.bag.assignments.values = [chain[0], chain[1], chain[1]]
        self.assertIn("robot4 has no rank again", self.problems({"leaves": "robot4"}))


if __name__ == "__main__":
    unittest.main()
