#!/usr/bin/env python3
"""Tells which ten tests take longest, beside their limits. usage: dearest_tests.py BUILD_FOLDER [--most SECONDS]
Reads tests.xml of `ctest --output-junit` there. With --most it fails where a test took longer: a cap for machines that have
nothing else to do, well below the limits, which must hold on busy ones."""
import argparse
import json
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as xml


def limits_of(folder):
    listed = subprocess.run(["ctest", "--show-only=json-v1"], cwd=folder, check=True, capture_output=True, text=True)
    limits = {}
    for test in json.loads(listed.stdout)["tests"]:
        limits[test["name"]] = next((p["value"] for p in test["properties"] if p["name"] == "TIMEOUT"), 1500)
    return limits


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--most", type=float)
    arguments = parser.parse_args()
    cases = xml.parse(arguments.folder / "tests.xml").getroot().iter("testcase")
    seconds = {case.get("name"): float(case.get("time")) for case in cases}
    limits = limits_of(arguments.folder)
    dearest = sorted(seconds, key=seconds.get, reverse=True)[:10]
    print(f"{len(seconds)} tests, {sum(seconds.values()):.0f} s one after another; the dearest:")
    for name in dearest:
        print(f"  {seconds[name]:6.1f} s of {limits[name]:4.0f}  {name}")
    if arguments.most and seconds[dearest[0]] > arguments.most:
        sys.exit(f"{dearest[0]} takes more than {arguments.most:g} s: divide it, or find what is slow")


if __name__ == "__main__":
    main()
