#!/usr/bin/env python3
"""Runs docs/tutorial.md as a reader does: its commands one after another, in an empty folder.
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


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
    environment = os.environ | {"PATH": f"{program.parent}:{os.environ['PATH']}"}
    for name in ("ALLOW_RUN_AS_ROOT", "ALLOW_RUN_AS_ROOT_CONFIRM", "MCA_rmaps_base_oversubscribe"):
        environment[f"OMPI_{name}"] = "1"
    blocks = commands((SOURCE / "docs" / "tutorial.md").read_text())
    assert len(blocks) >= 8, len(blocks)
    said = {}
    for word, text in blocks:
        if word == "openfoam" and shutil.which("checkMesh") is None:
            print("not tested: no OpenFOAM")
            continue
        done = subprocess.run(["bash", "-e", "-c", text], cwd=folder, env=environment, capture_output=True, text=True,
                              timeout=200)
        assert done.returncode == 0, f"{text}\n{done.stdout}{done.stderr}"
        said[text] = done.stdout + done.stderr
    everything = "".join(said.values())
    report = json.loads((folder / "out" / "report.json").read_text())
    assert report["status"] == "ok" and report["quality"]["min_dihedral_deg"] > 10, report["quality"]
    assert report["resumed"] == ["geometry", "sizing", "surface", "volume", "improve"], report["resumed"]
    assert {p["name"] for p in report["patches"]} == {"fuselage", "wings", "farfield"}, report["patches"]
    for name in ("report.html", "mesh.pvtu", "mesh.cgns", "mesh.su2", "openfoam/mesh.foam"):
        assert (folder / "out" / name).exists(), name
    assert "Mesh OK" in everything or shutil.which("checkMesh") is None, everything[-3000:]
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
