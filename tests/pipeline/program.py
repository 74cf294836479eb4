"""Runs the program as a user does, for the end-to-end tests."""
import json
import os
import pathlib
import subprocess
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
GEOMETRY = pathlib.Path(os.environ.get("AEROLOOM_GEOMETRY", SOURCE.parent / "shared" / "geometry"))

# The built-in aircraft, coarse: a few seconds on one core.
COARSE_TRANSPORT = """
geometry: {builtin: transport}
farfield: {shape: box, extent: 3}
sizing: {minimum: 0.12, maximum: 12, surface_maximum: 1.2, curvature_angle: 20, growth: 1.5}
"""


class Run:
    """One finished run: exit code, output, seconds, report and output folder."""

    def __init__(self, program, case, ranks=1, overrides=(), seconds=280):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
        case_file = self.folder / "case.yaml"
        case_file.write_text(case)
        self.output = self.folder / "out"
        command = [SOURCE / "scripts" / "mpirun_local.sh", str(ranks), program, "run", case_file]
        for override in (f"output.directory={self.output}", *overrides):
            command += ["--set", override]
        start = time.monotonic()
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, cwd=self.folder)
        self.seconds = time.monotonic() - start
        self.code, self.text = done.returncode, done.stdout + done.stderr
        report = self.output / "report.json"
        self.report = json.loads(report.read_text()) if report.exists() else None
