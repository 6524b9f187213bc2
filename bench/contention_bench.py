#!/usr/bin/python3
"""Training speed beside a busy process: trajectories an hour, as a share of the speed on the quiet machine.

In each round, the same session runs once without and once with a process that keeps one core busy, in alternation, for
each setting of the environment. Prints medians over the rounds. Nothing else should run.
Example: bench/contention_bench.py --rounds 5 --setting "" --setting OMP_WAIT_POLICY=passive
"""
import argparse
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

FOLDER = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def environment(setting):
    """The environment with 'NAME=VALUE NAME=VALUE' set."""
    result = {name: value for name, value in os.environ.items()
              if name not in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT", "OMP_NUM_THREADS")}
    for assignment in setting.split():
        name, equals, value = assignment.partition("=")
        if not equals:
            sys.exit(f"contention_bench.py: '{assignment}' is not NAME=VALUE")
        result[name] = value
    return result


def trajectories_an_hour(options, setting, busy):
    """One session. The busy process is pinned to the first core that this process may use."""
    output = tempfile.mkdtemp(prefix="contention_bench_")
    hogs = [subprocess.Popen(["taskset", "-c", str(min(os.sched_getaffinity(0))), "sh", "-c", "while :; do :; done"])
            for _ in range(busy)]
    command = [options.program, "train", "--task", options.task, "--trajectories", str(options.trajectories),
               "--evaluation-episodes", "0", "--output", os.path.join(output, "run")]
    try:
        began = time.monotonic()
        subprocess.run(command, env=environment(setting), check=True, stdout=subprocess.DEVNULL)
        return 3600 * options.trajectories / (time.monotonic() - began)
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"contention_bench.py: {error}")
    finally:
        for hog in hogs:
            hog.kill()
            hog.wait()
        shutil.rmtree(output, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(FOLDER, "devel/lib/early_fusion/early_fusion"),
                        help="the early_fusion program [%(default)s]")
    parser.add_argument("--task", default="simple", help="[%(default)s]")
    parser.add_argument("--trajectories", type=int, default=400, help="length of a session [%(default)s]")
    parser.add_argument("--rounds", type=int, default=3, help="sessions for each median [%(default)s]")
    parser.add_argument("--busy", type=int, default=1, help="number of busy processes beside [%(default)s]")
    parser.add_argument("--setting", action="append",
                        help="environment, such as 'OMP_WAIT_POLICY=passive'; can be given again [none]")
    options = parser.parse_args()
    speeds = {}  # (setting, busy) -> trajectories an hour
    for round_number in range(options.rounds):
        for setting in options.setting or [""]:
            for busy in (0, options.busy):
                speed = trajectories_an_hour(options, setting, busy)
                speeds.setdefault((setting, busy), []).append(speed)
                print(f"round {round_number + 1}/{options.rounds}: '{setting}' beside {busy}: {speed:,.0f}/h",
                      file=sys.stderr, flush=True)
    for setting in options.setting or [""]:
        quiet, beside = (statistics.median(speeds[setting, busy]) for busy in (0, options.busy))
        print(f"'{setting}': {quiet:,.0f} trajectories/h on the quiet machine, {beside:,.0f} beside {options.busy} "
              f"busy process(es): {beside / quiet:.2f}")


if __name__ == "__main__":
    main()
