"""A case of OpenFOAM as the program writes it: what may be set in it, its run, and what it leaves."""
import math
import os
import re
import subprocess

#: Of the free stream, as 0.orig/conditions has it.
SPEED = 50.0


def environment(written):
    """What programs of OpenFOAM need, where nothing else has set it."""
    return os.environ | {"PWD": str(written), "WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam")}


def set_conditions(written, **numbers):
    """Numbers of 0.orig/conditions by name."""
    conditions = written / "0.orig" / "conditions"
    text = conditions.read_text()
    for name, value in numbers.items():
        text, count = re.subn(rf"^({name}\s+)[^;]*;", rf"\g<1>{value};", text, flags=re.MULTILINE)
        if not count:
            raise SystemExit(f"{conditions}: no '{name}' there")
    conditions.write_text(text)


def turn_flow(written, angle):
    turn = math.radians(angle)
    cos, sin = math.cos(turn), math.sin(turn)
    set_conditions(written, velocity=f"({SPEED * cos:.9g} 0 {SPEED * sin:.9g})", drag_direction=f"({cos:.9g} 0 {sin:.9g})",
                   lift_direction=f"({-sin:.9g} 0 {cos:.9g})")


def set_iterations(written, count):
    control = written / "system" / "controlDict"
    control.write_text(re.sub(r"^(endTime\s+)\d+;", rf"\g<1>{count};", control.read_text(), flags=re.MULTILINE))


def run(written):
    """By the script beside the case, from the last step written."""
    return subprocess.run(["./run.sh"], cwd=written, env=environment(written), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          check=False).returncode


def tables(written, function, file):
    """Rows of words, comments among them, of what a function object wrote in all starts, later starts last. A start from a step that had
    one before gives its file another name."""
    stem, ending = file.split(".")
    for path in sorted((written / "postProcessing" / function).glob(f"*/{stem}*.{ending}"), key=lambda p: p.stat().st_mtime_ns):
        yield from (line.split() for line in path.read_text().splitlines() if line.strip())


def speeds(written, after=0):
    """The largest speed at each look after so many iterations, over that of the free stream."""
    found = []
    for file in sorted((written / "postProcessing" / "extremes").rglob("fieldMinMax*.dat")):
        rows = [[word.strip() for word in line.split("\t")] for line in file.read_text().splitlines() if not line.startswith("#")]
        found += [float(row[4]) / SPEED for row in rows if row[1] == "mag(U)" and float(row[0]) > after]
    return found


def coefficients(written):
    """Columns of the table of forces by name, `Time` among them; of a step that several starts made, the last."""
    names, rows = [], {}
    for words in tables(written, "forces", "coefficient.dat"):
        if words[:2] == ["#", "Time"]:
            names = words[1:]
        elif words[0] != "#":
            rows[float(words[0])] = [float(word) for word in words]
    return {name: [rows[step][i] for step in sorted(rows)] for i, name in enumerate(names)}
