#!/usr/bin/env python3
"""Runs the tutorial and the page on inner flow as a reader does: commands one after another, in an empty folder.
usage: tutorial_test.py PROGRAM"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from program import SOURCE


def commands(page):
    """Word behind ```sh, text of the block."""
    return re.findall(r"^```sh *(\w*)\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)


def run_page(program, page):
    """The folder in which the page's commands ran, and all that they said."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
    environment = os.environ | {"PATH": f"{program.parent}:{os.environ['PATH']}", "AEROLOOM": str(SOURCE)}
    for name in ("ALLOW_RUN_AS_ROOT", "ALLOW_RUN_AS_ROOT_CONFIRM", "MCA_rmaps_base_oversubscribe"):
        environment[f"OMPI_{name}"] = "1"
    blocks = commands((SOURCE / "docs" / page).read_text())
    assert len(blocks) >= 4, len(blocks)
    said = ""
    for word, text in blocks:
        if word == "openfoam" and shutil.which("checkMesh") is None:
            print("not tested: no OpenFOAM")
            continue
        done = subprocess.run(["bash", "-e", "-c", text], cwd=folder, env=environment, capture_output=True, text=True,
                              timeout=200)
        assert done.returncode == 0, f"{text}\n{done.stdout}{done.stderr}"
        said += done.stdout + done.stderr
    assert "Mesh OK" in said or shutil.which("checkMesh") is None, said[-3000:]
    return folder, said


def patches_of(report):
    return {p["name"]: p["type"] for p in report["patches"]}


def check_tutorial(program):
    folder, _ = run_page(program, "tutorial.md")
    report = json.loads((folder / "out" / "report.json").read_text())
    assert report["status"] == "ok" and report["quality"]["min_dihedral_deg"] > 10, report["quality"]
    assert report["resumed"] == ["geometry", "sizing", "surface", "volume", "improve"], report["resumed"]
    assert set(patches_of(report)) == {"fuselage", "wings", "farfield"}, report["patches"]
    for name in ("report.html", "mesh.pvtu", "mesh.cgns", "mesh.su2", "openfoam/mesh.foam"):
        assert (folder / "out" / name).exists(), name
    shutil.rmtree(folder)


def check_internal_flow(program):
    folder, said = run_page(program, "how_to_internal_flow.md")
    report = json.loads((folder / "out" / "report.json").read_text())
    assert report["status"] == "ok" and report["mesh"]["prisms"] > 1000, report["mesh"]
    types = patches_of(report)
    assert (types["inlet"], types["outlet"], types["branch"]) == ("inlet", "outlet", "outlet"), types
    assert "farfield" not in types, types
    assert "fluid, as requested" in said, said[:3000]
    shutil.rmtree(folder)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    check_tutorial(program)
    check_internal_flow(program)


if __name__ == "__main__":
    main()
