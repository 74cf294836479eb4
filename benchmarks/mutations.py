#!/usr/bin/env python3
"""How many single-line mistakes the tests catch.

usage: mutations.py BUILD COUNT SEED [--folders F ...] [--after PLACE]

Chooses COUNT lines of the stages' sources by SEED and makes one mistake in each: a comparison turned, a sign or a
term changed, a call left out, a condition negated. Builds the tests of the folder, then those of pipeline/, and runs
them until one fails. Prints a table; mistakes that do not compile are replaced by others. Works in the tree it is in
(commit first: the file is restored after each) and with a build folder of the Ninja generator. --after PLACE goes on
after the last row of an interrupted run, for COUNT more.
"""
import argparse
import pathlib
import random
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ["geometry", "cad", "mesh", "sizing", "surface", "layers", "volume", "improve", "io"]

# What is looked for in a line of code, what takes its place, and what the mistake is called.
MISTAKES = [
    (r"(?<=[\w)\]]) < (?=[\w(-])", " >= ", "comparison turned"),
    (r"(?<=[\w)\]]) > (?=[\w(-])", " <= ", "comparison turned"),
    (r" <= ", " < ", "bound shifted"),
    (r" >= ", " > ", "bound shifted"),
    (r" == ", " != ", "equality negated"),
    (r" != ", " == ", "equality negated"),
    (r" && ", " || ", "condition loosened"),
    (r" \|\| ", " && ", "condition tightened"),
    (r"(?<=[\w)\]]) \+ (?=[\w(])", " - ", "sign turned"),
    (r"(?<=[\w)\]]) - (?=[\w(])", " + ", "sign turned"),
    (r" \* [\w.]+(?=[;)])", "", "factor dropped"),
    (r"\bstd::min\(", "std::max(", "extreme turned"),
    (r"\bstd::max\(", "std::min(", "extreme turned"),
    (r"\bif \((?!!)", "if (!", "negated"),  # completed below
    (r"^(\s+)[a-z_][\w.]*(?:->\w+)?\([^;{}]*\);$", r"\1;", "call left out"),
]


def candidates(folders):
    """Every (file, line number, mistake) there is, in a fixed order."""
    found = []
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*.cpp")):
            for number, line in enumerate(path.read_text().splitlines()):
                code = line.split("//")[0]
                if not code.startswith("  ") or '"' in code or "throw" in code or "template" in code or "static_assert" in code:
                    continue
                for k, (pattern, _, _) in enumerate(MISTAKES):
                    if re.search(pattern, code):
                        found.append((path, number, k))
    return found


def mutate(line, k, choice):
    pattern, replacement, name = MISTAKES[k]
    if name == "negated":
        at = re.search(r"\bif \((.*)\)( \{| [a-z].*;)$", line)
        if not at or at[1].count("(") != at[1].count(")"):
            return None
        return line[:at.start()] + f"if (!({at[1]})){at[2]}"
    places = list(re.finditer(pattern, line))
    at = choice.choice(places)
    return line[:at.start()] + at.expand(replacement) + line[at.end():]


def run(command, log, seconds=1500):
    with open(log, "w", encoding="utf-8") as out:
        try:
            return subprocess.run([str(c) for c in command], stdout=out, stderr=subprocess.STDOUT, cwd=ROOT,
                                  timeout=seconds, check=False).returncode
        except subprocess.TimeoutExpired:
            return -1


def judge(build, folder, log):
    """Which folder's tests caught the mistake; 'missed', or None where it does not compile."""
    for tests in (folder, "pipeline"):
        if not (build / "tests" / tests).is_dir():
            continue
        if run(["ninja", "-C", build, f"tests/{tests}/all"], log) != 0:
            return None
        # End-to-end tests need the program.
        if tests == "pipeline" and run(["ninja", "-C", build, "bin/aeroloom"], log) != 0:
            return None
        # The quick ones first: most mistakes do not live longer.
        for which in (["-L", "fast"], ["-LE", "fast"]):
            if run(["ctest", "--test-dir", build / "tests" / tests, "-j2", "--stop-on-failure", *which], log) != 0:
                return tests
    return "missed"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("count", type=int)
    parser.add_argument("seed", type=int)
    parser.add_argument("--folders", nargs="*", default=FOLDERS)
    parser.add_argument("--after", metavar="PLACE", help="FILE:LINE of the last row there is")
    options = parser.parse_args()
    build = options.build.resolve()
    choice = random.Random(options.seed)
    pool = candidates(options.folders)
    choice.shuffle(pool)
    print("| place | mistake | was | caught by |\n|---|---|---|---|", flush=True)
    caught = done = 0
    skipping = options.after is not None
    for path, number, k in pool:
        if done == options.count:
            break
        original = path.read_text()
        lines = original.split("\n")
        mutated = mutate(lines[number], k, choice)
        if mutated is None:
            continue
        place = f"{path.relative_to(ROOT)}:{number + 1}"
        if skipping:
            skipping = place != options.after
            continue
        try:
            path.write_text("\n".join([*lines[:number], mutated, *lines[number + 1:]]))
            folder = path.relative_to(ROOT).parts[0]
            verdict = judge(build, folder, build / "mutations.log")
        finally:
            path.write_text(original)
        if verdict is None:
            continue
        done += 1
        caught += verdict != "missed"
        was = lines[number].strip().replace("|", "\\|")
        print(f"| {place} | {MISTAKES[k][2]} | `{was}` | {verdict} |", flush=True)
    print(f"\n{caught} of {done} caught")
    return 0


if __name__ == "__main__":
    sys.exit(main())
