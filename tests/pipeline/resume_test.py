#!/usr/bin/env python3
"""Checkpoints: killed runs resumed on another number of ranks, full disks; tests/pipeline/checkpoints_test.cpp has the rest.
usage: resume_test.py PROGRAM"""
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

from killed_run import command, run_and_kill
from program import COARSE_WING

CASE = COARSE_WING + "volume: {piece_tets: 1500}\nsurface: {piece_triangles: 100}\noutput: {pictures: false}\n"


class Runs:
    def __init__(self, program, folder):
        self.program, self.folder, self.output = program, folder, folder / "out"
        self.case = folder / "case.yaml"
        self.case.write_text(CASE)

    def run(self, ranks, *overrides):
        """Exit code, all that was printed, report."""
        done = subprocess.run(command(self.program, self.case, self.output, ranks, *overrides), capture_output=True,
                              text=True, timeout=200)
        report = self.output / "report.json"
        return done.returncode, done.stdout + done.stderr, json.loads(report.read_text()) if report.exists() else None

    def kill(self, ranks, is_time):
        shutil.rmtree(self.output, ignore_errors=True)
        return run_and_kill(self.program, self.case, self.output, ranks, is_time, "output.checkpoints=write")


RECORD_HEADER = struct.Struct("<Q16s16sqQ")  # of parallel::TaskStore: magic, key, content, bytes, check


def whole_records(path):
    """Of a file of tasks that may still be written."""
    if not path.exists():
        return 0
    content = path.read_bytes()
    count = at = 0
    while at + RECORD_HEADER.size <= len(content):
        at += RECORD_HEADER.size + RECORD_HEADER.unpack_from(content, at)[3]
        count += at <= len(content)
    return count


def check_killed(runs, wanted):
    """Killed as soon as tasks of a stage are on disk: they are found again."""
    folder = runs.output / "checkpoint"
    caught = 0
    for stage, ranks, again in (("surface", 1, 3), ("volume", 2, 1), ("improve", 3, 2)):
        tasks = [folder / f"{stage}.0.{rank}.tasks" for rank in range(ranks)]
        if runs.kill(ranks, lambda _: any(whole_records(t) for t in tasks)) is None:
            continue  # it was quicker than the eye
        caught += 1
        code, text, report = runs.run(again, "output.checkpoints=resume")
        assert code == 0 and report["mesh"]["hash"] == wanted, f"{stage}: {text}"
        found_whole = "stage {} from".format(stage) in text
        assert found_whole or f"stage {stage}: " in text and "had been finished before" in text, text
        assert not (folder / "volume.checkpoint").exists() and not list(folder.glob("*.tasks")) and not list(folder.glob("*.unfinished")), list(folder.iterdir())
    assert caught > 0, "no run was caught in time"


def check_full_disk(runs, wanted):
    """A message, nothing that looks finished, exit code 7 where the mesh itself does not fit; afterwards the run goes on
    from what did fit. Left out where file systems cannot be mounted."""
    shutil.rmtree(runs.output)
    runs.output.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=700k", "tmpfs", str(runs.output)]
    if subprocess.run(mount, capture_output=True).returncode != 0:
        print("not tested: a full disk (mount is not permitted)")
        return
    try:
        code, text, _ = runs.run(2, "output.checkpoints=write")
        assert code == 7 and "No space left" in text and "nothing is kept" in text, f"{code}: {text}"
        for path in runs.output.rglob("*"):
            assert path.suffix not in {".pvtu", ".vtu", ".unfinished", ".new"}, path
        subprocess.run(["mount", "-o", "remount,size=100M", str(runs.output)], check=True)
        code, text, report = runs.run(1, "output.checkpoints=resume")
        assert code == 0 and report["mesh"]["hash"] == wanted and "geometry" in report["resumed"], text
    finally:
        subprocess.run(["umount", str(runs.output)], check=True)


def main():
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
    runs = Runs(sys.argv[1], folder)
    code, text, report = runs.run(2)
    assert code == 0, text
    wanted = report["mesh"]["hash"]
    check_killed(runs, wanted)
    check_full_disk(runs, wanted)
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
