#!/usr/bin/env python3
"""What the real `ros2 launch` gives each process of the files in launch/: program, arguments, parameter files, variables.

  record.py [NAME...]            writes tests/launch/real/NAME.json anew, for each launch file if none is named
  record.py --check [NAME...]    says what they would hold now, and ends with 1 if that is something else

Wants `ros2` on PATH: eval "$(scripts/ros2-launch --env)". The programs are stood in for by this very script under their
names, which keeps what it was started with and waits for its end.
"""
import difflib, json, os, pathlib, re, signal, subprocess, sys, tempfile, time

HERE = pathlib.Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
PROGRAMS = ["bag_recorder", "formation_controller", "leader_assignment", "obstacle_mapper", "operator",
            "overhead_localizer", "rf_bridge", "testbed", "trench"]
TEAM = "robots:=[robot1, robot2]"
# The real launcher takes no empty value: this is the empty text as YAML writes it.
NO_OBSTACLES = "obstacles:=''"
POSES = "poses:=[0.5, 0.5, 0.0, 1.0, 1.5, -0.25]"
# What each file is run with; by default nothing, and what most take.
USUAL = [[], ["together:=true"], ["record:=true", "bag:=run/a bag"], ["render:=false", "bed:=ideal", "seed:=7"]]
# Those whose robots follow one another may be split over hosts.
SPLIT = [*USUAL, ["controllers:=false"], ["bridge:=false", "key:=/etc/trench/key"]]
CASES = {
    "bed": [[TEAM, POSES], [TEAM, POSES, "render:=false", "lasers:=[robot2]", "known_poses:=[]", "robot_reach:=1.5"]],
    "bridge_host": [[TEAM, "port:=/dev/ttyUSB0"], [TEAM, "port:=/dev/ttyUSB0", "read_best_effort:=[\"*\"]"]],
    "chain": SPLIT,
    "column": [*SPLIT, ["target_robot:=robot5", "formation:=behind", "everybody:=[robot1, robot2, robot3, robot4, robot5]"]],
    "controller": [["robot:=robot1", TEAM], ["robot:=robot2", TEAM, "world:=large", "profile:=thesis"]],
    "controllers": [[TEAM], ["robots:=[robot1]", "profile:=chain"]],
    "corridor": SPLIT,
    "pursuit": [*SPLIT, ["order:=nearest"], [NO_OBSTACLES], ["lasers:=[robot1, robot5]", "publish_obstacles:=false"]],
    "nearest_chain": [*SPLIT, [NO_OBSTACLES]],
    "robot_host": [["robot:=robot1", TEAM], ["robot:=robot1", TEAM, "read_best_effort:=[/team_state, /goals]"],
                   ["robot:=robot2", TEAM, "profile:=chain", "world:=large", "face:=arrived"]],
    "router": [[]],
    "square": [*USUAL, ["controllers:=false", "bridge:=false", "testbed:=false"], ["known_poses:=[]", "key:=/etc/trench/key"]],
    "team": [[TEAM, POSES, "formation:=square", "profile:=tuned", f"together:={together}", "bed:=honest", "seed:=1",
              "render:=true", "duration:=40.0", "tolerance:=0.02", "record:=true", "bag:=run/bag", "port:=/tmp/port"]
             for together in ("true", "false")],
    "testbed": [[TEAM, POSES], [TEAM, POSES, "bed:=ideal", "world:=large", "camera:=overhead_four"]],
}
# Of the machine or of how ros2 itself runs.
IGNORED = {"LD_LIBRARY_PATH", "OLDPWD", "PWD", "SHLVL", "_", "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}
PATIENCE = 60.0


def stand_in():
    """As one of the programs: keeps arguments, files and variables, and waits for the end."""
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    argv = [pathlib.Path(sys.argv[0]).name, *sys.argv[1:]]
    files = {after: open(after).read() for flag, after in zip(argv, argv[1:]) if flag == "--params-file"}
    kept = pathlib.Path(os.environ["TRENCH_KEPT"], str(os.getpid()))
    kept.write_text(json.dumps({"argv": argv, "files": files, "env": dict(os.environ)}))
    kept.rename(kept.with_suffix(".json"))
    signal.sigwait({signal.SIGINT, signal.SIGTERM})


def run(file, arguments):
    """The processes of one launch."""
    with tempfile.TemporaryDirectory() as folder:
        programs, kept = pathlib.Path(folder, "programs"), pathlib.Path(folder, "kept")
        programs.mkdir(), kept.mkdir()
        for program in PROGRAMS:
            (programs / program).symlink_to(__file__)
        environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}", "TRENCH_KEPT": str(kept),
                       "ROS_LOG_DIR": str(pathlib.Path(folder, "log"))}
        log = open(pathlib.Path(folder, "output"), "w+")
        launcher = subprocess.Popen(["ros2", "launch", str(file), *arguments], env=environment, stdout=log, stderr=log)
        try:
            processes = wait_for_all(launcher, log, kept)
        finally:
            launcher.send_signal(signal.SIGINT)
            launcher.wait()
        return sorted((comparable(process, environment) for process in processes), key=json.dumps)


def wait_for_all(launcher, log, kept):
    """Until all processes that the launcher has started have said what they got, and for two seconds none was new."""
    start = quiet_since = time.monotonic()
    before = None
    while True:
        log.seek(0)
        said = log.read()
        now = (said.count("process started with pid"), len(list(kept.glob("*.json"))))
        if now != before:
            before, quiet_since = now, time.monotonic()
        if now[0] == now[1] > 0 and time.monotonic() - quiet_since > 2.0:
            return [json.loads(file.read_text()) for file in kept.glob("*.json")]
        if launcher.poll() is not None or time.monotonic() - start > PATIENCE:
            sys.exit(f"record.py: the launch came to nothing:\n{said}")
        time.sleep(0.1)


def comparable(process, environment):
    """Without what differs between machines. A parameter file that the launcher wrote becomes its text."""
    relative = lambda text: text.replace(str(REPOSITORY), "<repository>")
    arguments = []
    for argument in process["argv"]:
        written = process["files"].get(argument)
        ours = written is None or argument.startswith(str(REPOSITORY))
        arguments.append(relative(argument) if ours else {"parameters": relative(written)})
    variables = {name: relative(value) for name, value in process["env"].items()
                 if environment.get(name) != value and name not in IGNORED}
    return {"argv": arguments, "env": variables}


def main():
    check, wanted = "--check" in sys.argv, [name for name in sys.argv[1:] if name != "--check"]
    if any(name.startswith("-") for name in wanted):
        sys.exit(__doc__)
    changed = False
    for file in sorted((REPOSITORY / "launch").glob("*.launch.yaml")):
        name = file.name.removesuffix(".launch.yaml")
        if wanted and name not in wanted:
            continue
        runs = [{"arguments": case, "processes": run(file, case)} for case in CASES.get(name, USUAL)]
        golden, text = HERE / "real" / f"{name}.json", json.dumps(runs, indent=1) + "\n"
        held = golden.read_text() if golden.exists() else ""
        changed |= held != text
        print(f"{name}: {len(runs)} runs, {sum(len(run['processes']) for run in runs)} processes"
              f"{'' if held == text else ', not what was recorded'}", flush=True)
        if check:
            sys.stdout.writelines(difflib.unified_diff(held.splitlines(True), text.splitlines(True), str(golden), "now"))
        else:
            golden.write_text(text)
    sys.exit(1 if check and changed else 0)


if __name__ == "__main__":
    stand_in() if "TRENCH_KEPT" in os.environ else main()
