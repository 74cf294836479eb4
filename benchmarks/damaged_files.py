#!/usr/bin/env python3
"""All damaged files that readers must survive; the tests take one in a few of them. usage: damaged_files.py BUILD_FOLDER [RANKS ...]

One line RESULT for each test of damage on each number of ranks (default 1 2 3; files of CAD on one), with its seconds.
"""
import os
import pathlib
import re
import subprocess
import sys
import time

LAUNCHER = pathlib.Path(__file__).resolve().parent.parent / "scripts" / "mpirun_local.sh"
SUITES = [
    ("io_test", "*Damage*:*Hostile*"),
    ("pipeline_test", "DamagedFiles.EndInAModelOrAMessage"),
]


def tests_of(program, pattern):
    listed = subprocess.run([program, "--gtest_list_tests", f"--gtest_filter={pattern}"], check=True, capture_output=True,
                            text=True).stdout
    suite = ""
    for line in listed.splitlines():
        if re.fullmatch(r"\S+\.", line):
            suite = line
        elif suite and line.startswith("  "):
            yield suite + line.strip()


def main():
    folder = pathlib.Path(sys.argv[1]) / "tests"
    counts = [int(word) for word in sys.argv[2:]] or [1, 2, 3]
    environment = os.environ | {"AEROLOOM_ALL_DAMAGE": "1"}
    failed = 0
    for name, pattern in SUITES:
        for test in tests_of(folder / name, pattern):
            for ranks in counts if name == "io_test" else counts[:1]:
                start = time.monotonic()
                done = subprocess.run([LAUNCHER, str(ranks), folder / name, f"--gtest_filter={test}"], env=environment,
                                      capture_output=True, text=True)
                passed = done.returncode == 0
                failed += not passed
                print(f"RESULT test={test} ranks={ranks} passed={int(passed)} seconds={time.monotonic() - start:.1f}", flush=True)
                if not passed:
                    print(done.stdout + done.stderr)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
