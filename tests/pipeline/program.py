"""Runs the program as a user does, for the end-to-end tests."""
import json
import os
import pathlib
import pickle
import subprocess
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
GEOMETRY = pathlib.Path(os.environ.get("AEROLOOM_GEOMETRY", SOURCE.parent / "shared" / "geometry"))

# The built-in aircraft, coarse: two seconds on one core.
COARSE_TRANSPORT = """
geometry: {builtin: transport, trailing_edges: sharpen}
farfield: {shape: box, extent: 3}
sizing: {minimum: 0.5, maximum: 20, surface_maximum: 4, curvature_angle: 30, growth: 1.8, proximity: 0}
"""

# A wing on a body from a file, coarser: a second. For what is about the program, not about the mesh.
COARSE_WING = f"""
geometry: {{file: "{SOURCE}/tests/data/wing_body.step", trailing_edges: sharpen}}
farfield: {{shape: box, extent: 3}}
sizing: {{minimum: 0.5, feature_minimum: 0.5, maximum: 10, surface_maximum: 2, curvature_angle: 40, growth: 1.9, proximity: 0}}
"""

# The fluid in a duct: less than a second, most of it the start. For what is about command lines.
COARSE_DUCT = f"""
geometry: {{file: "{SOURCE}/configs/geometry/duct.step", domain: fluid}}
sizing: {{target_tetrahedra: 2000}}
"""
NO_PICTURES = "output: {pictures: false}\n"

# What several tests look at once it is finished: in pieces, with a patch whose name is markup.
HOSTILE = "<script>alert('&amp;')</script><img src=x onerror=alert(1)>"
SHARED_CASE = COARSE_TRANSPORT + f"""
surface: {{piece_triangles: 400}}
volume: {{piece_tets: 12000}}
output: {{tasks: true}}
patches:
  "{HOSTILE}": {{faces: ['wing_*_upper']}}
"""
SHARED_RANKS = 2


def with_fault(fault):
    """The environment of a run with this fault in its sandboxed tasks, such as "zone=aborts"; none: as it is."""
    return {**os.environ, "AEROLOOM_FAULT": fault} if fault else None


class Run:
    """One finished run: exit code, output, seconds, report and output folder."""

    def __init__(self, program, case, ranks=1, overrides=(), seconds=280, folder=None, fault=None):
        self.folder = pathlib.Path(folder or tempfile.mkdtemp(prefix="aeroloom_test_"))
        case_file = self.folder / "case.yaml"
        case_file.write_text(case)
        self.output = self.folder / "out"
        command = [SOURCE / "scripts" / "mpirun_local.sh", str(ranks), program, "run", case_file]
        for override in (f"output.directory={self.output}", *overrides):
            command += ["--set", override]
        start = time.monotonic()
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, cwd=self.folder, env=with_fault(fault))
        self.seconds = time.monotonic() - start
        self.code, self.text = done.returncode, done.stdout + done.stderr
        report = self.output / "report.json"
        self.report = json.loads(report.read_text()) if report.exists() else None


def shared_run(program):
    """The run of SHARED_CASE on SHARED_RANKS, to be read only: that of shared_run.py where AEROLOOM_SHARED_RUN names it, as
    the tests of a build do, else a new one."""
    kept = os.environ.get("AEROLOOM_SHARED_RUN")
    if kept and (pathlib.Path(kept) / "run.pickle").exists():
        return pickle.loads((pathlib.Path(kept) / "run.pickle").read_bytes())
    run = Run(program, SHARED_CASE, SHARED_RANKS)
    assert run.code == 0, run.text
    return run
