#!/usr/bin/env python3
"""The command line as a user meets it: mistakes, versions, info, progress. usage: command_line_test.py PROGRAM"""
import json
import os
import pty
import re
import shutil
import sys

from program import COARSE_TRANSPORT, COARSE_WING, shared_run
from shell import Shell


def check_mistakes(shell):
    for line, *words in (("", "a command is missing", "improve", "aeroloom --help"),
                         ("rnu case.yaml", "unknown command 'rnu'", "did you mean 'run'?"),
                         ("run case.yaml --sett a=b", "unknown option '--sett'", "'--set'"),
                         ("quality m.vtu --gate.smalest_angle=3", "'--gate.smallest_angle'"),
                         ("convert a.vtu", "to is required", "aeroloom convert --help"),
                         ("convert a.vtu b --format cgn", "no format is called 'cgn'", "'cgns'"),
                         ("run case.yaml again.yaml", "unexpected argument 'again.yaml'"),
                         ("--bogus", "unknown option '--bogus'"),
                         ("run case.yaml --resume --checkpoints", "excludes"),
                         ("-v run case.yaml -q", "--verbose and --quiet exclude each other"),
                         ("info case.yaml -q -v", "--verbose and --quiet exclude each other"),
                         ("run case.yaml --set sizng.minimum=1", "did you mean 'sizing'?")):
        for ranks in (1, 2) if line.startswith("rnu") else (1,):
            code, out, err = shell.run(line, ranks)
            assert code == 2 and out == "", f"{line!r}: exit {code}\n{out}{err}"
            assert all(word in err for word in words), f"{line!r}: {err}"
            assert err.count("error") == 1 or ranks > 1, err


def check_files(shell):
    """What cannot be read or written, and what is not what it should be, in one line each."""
    (shell.folder / "cad.stp").write_text("ISO-10303-21;\n" + "#1=CARTESIAN_POINT('',(0.,0.,0.));\n" * 1000)
    (shell.folder / "absent.yaml").write_text("geometry: {file: absent.stp}\n")
    (shell.folder / "long.yaml").write_text("word " * 1000)
    for line, expected, *words in (("run cad.stp", 2, "a geometry, but a case", "aeroloom init case.yaml --geometry cad.stp"),
                                   ("run nowhere.yaml", 2, "cannot be opened: No such file or directory", "aeroloom init"),
                                   ("run .", 2, "cannot be opened: Is a directory"),
                                   ("run long.yaml", 2, "expected keys, got 'word", "...'"),
                                   ("info absent.vtu", 7, "cannot read 'absent.vtu': No such file or directory"),
                                   ("check absent.yaml", 7, "cannot read 'absent.stp': No such file or directory"),
                                   ("schema --output /proc/x", 7, "cannot write '/proc/x': No such file or directory"),
                                   ("run case.yaml --set output.directory=/proc/x", 7, "output.directory:", "'/proc/x'")):
        code, out, err = shell.run(line)
        assert code == expected and out == "", f"{line!r}: exit {code}\n{out}{err}"
        assert all(word in err for word in words) and len(err) < 300, f"{line!r}: {err}"
        assert "iostream" not in err and "filesystem error" not in err, err


def check_loudness(shell):
    """-q leaves warnings and errors, wherever it stands; -v says more."""
    assert shell.run("-q convert out/mesh.pvtu a.cgns")[1:] == ("", "")
    assert shell.run("convert out/mesh.pvtu a.cgns --quiet")[1:] == ("", "")
    assert "wrote" in shell.run("convert out/mesh.pvtu a.cgns")[1]
    assert shell.run("run quick.yaml --set output.directory=quick -q")[1] == ""
    normal = len(shell.run("run quick.yaml --set output.directory=quick")[1])
    assert len(shell.run("-v run quick.yaml --set output.directory=quick")[1]) > normal


def on_terminal(shell, line, **environment):
    """What the program writes to a terminal."""
    written = b""

    def read(descriptor):
        nonlocal written
        data = os.read(descriptor, 65536)
        written += data
        return data

    command = ["env", "-u", "NO_COLOR", "TERM=xterm", *(f"{name}={value}" for name, value in environment.items()),
               "sh", "-c", f'cd "{shell.folder}" && exec "{shell.program}" {line}']
    silent = os.open(os.devnull, os.O_WRONLY)
    screen = os.dup(1)
    os.dup2(silent, 1)
    try:
        pty.spawn(command, read)
    finally:
        os.dup2(screen, 1)
    return written.decode().replace("\r\n", "\n")


def check_progress(shell):
    """On a terminal one line that leaves nothing behind; plain lines, here too few to show, where that is asked for."""
    erase = "\r\x1b[K"
    text = on_terminal(shell, "run quick.yaml --set output.directory=quick")
    assert re.search(re.escape(erase) + r"(sizing|surface|volume|improve) +\d+ %  \d+ [a-z ]+  \d+ MB  \d+\.\d s", text), text
    left = [line.split(erase)[-1] for line in text.split("\n")]
    assert not any(re.search(r" \d+ MB  ", line) for line in left), left
    facts = [line for line in shell.run("run quick.yaml --set output.directory=quick")[1].split("\n") if re.match("(geometry|sizing|surface|hash):", line)]
    assert [line for line in facts if "MB" not in line and line not in left] == [], left
    for how in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
        assert "\x1b" not in on_terminal(shell, "run quick.yaml --set output.directory=quick", **how)
    assert erase not in on_terminal(shell, "-q run quick.yaml --set output.directory=quick")


def check_version(shell):
    code, text, _ = shell.run("--version")
    assert code == 0 and text.startswith("aeroloom "), text
    for library in ("OpenCASCADE", "TetGen", "VTK", "HDF5", "METIS", "p4est", "muparser", "CGAL", "Eigen", "MPI", "yaml-cpp",
                    "nlohmann_json", "CLI11", "fmt", "spdlog"):
        assert re.search(rf"^  {library} +\S*.*\d+\.\d+", text, re.M), f"{library}: {text}"
    assert "AGPL" in text


def check_info(shell):
    def facts(file, ranks=1):
        code, text, err = shell.run(f"info --json {file}", ranks)
        assert code == 0, err
        return json.loads(text)

    mesh = facts("out/mesh.pvtu")
    assert mesh == facts("out/mesh.pvtu", 2)
    report = json.loads((shell.folder / "out" / "report.json").read_text())["mesh"]
    assert mesh["kind"] == "mesh" and mesh["parts"] >= 1
    assert (mesh["tetrahedra"], mesh["points"]) == (report["tetrahedra"], report["points"])
    patches = {patch["name"]: patch for patch in mesh["patches"]}
    assert patches["fuselage"]["type"] == "wall" and patches["farfield"]["type"] == "farfield"
    assert sum(patch["triangles"] for patch in mesh["patches"]) == report["boundary_triangles"]
    assert mesh["regions"] == [{"name": "fluid", "cells": mesh["cells"]}]
    low, high = mesh["bounds"]
    assert all(a < -50 and b > 50 for a, b in zip(low, high)), mesh["bounds"]
    text = shell.run("info out/mesh.pvtu")[1]
    assert f"tetrahedra {mesh['tetrahedra']}" in text and "patch fuselage" in text, text

    cad = facts("wing.step")
    assert (cad["kind"], cad["format"], cad["unit"], cad["solids"], cad["shells"]) == ("cad", "STEP", "m", 1, 1)
    assert cad["bounds"] == cad["bounds_in_metres"] and abs(cad["bounds"][1][0] - 37.6) < 1e-6
    assert {"name": "fuselage", "faces": 12} in cad["face_names"] and cad["parts"][0]["name"] == "transport"
    millimetres = (shell.folder / "wing.step").read_text().replace("SI_UNIT($,.METRE.)", "SI_UNIT(.MILLI.,.METRE.)")
    (shell.folder / "small.step").write_text(millimetres)
    small = facts("small.step")
    assert small["unit"] == "mm" and abs(small["bounds"][1][0] / small["bounds_in_metres"][1][0] - 1000) < 1e-9

    case = facts("case.yaml")
    assert case["kind"] == "case" and "growth: 1.8" in case["configuration"]
    (shell.folder / "wrong.yaml").write_text("geometry: {fil: a.step}\n")
    (shell.folder / "broken.vtu").write_text("<VTKFile")
    for file, code, word in (("nowhere.step", 7, "nowhere.step"), ("out", 3, "is a folder"),
                             ("out/report.json", 3, "neither STEP"), ("mesh.cgns", 7, "not read"),
                             ("wrong.yaml", 2, "'file'"), ("broken.vtu", 3, "broken.vtu")):
        for ranks in (1, 2):
            found, out, err = shell.run(f"info {file}", ranks)
            assert found == code and word in err and out == "", f"{file}: {found} {out} {err}"


def main():
    shell = Shell(sys.argv[1])
    (shell.folder / "case.yaml").write_text(COARSE_TRANSPORT)
    (shell.folder / "quick.yaml").write_text(COARSE_WING + "output: {pictures: false}\n")
    shutil.copytree(shared_run(sys.argv[1]).output, shell.folder / "out")
    assert shell.run("export-cad case.yaml wing.step -q")[0] == 0
    check_version(shell)
    check_mistakes(shell)
    check_files(shell)
    check_info(shell)
    check_loudness(shell)
    check_progress(shell)


if __name__ == "__main__":
    main()
