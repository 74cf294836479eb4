#!/usr/bin/env python3
"""Nothing is lost, and nothing is silently other than asked: other runs, ends from outside, odd files, absurd sizes.
usage: surprises_test.py PROGRAM"""
import json
import os
import signal
import subprocess
import sys
import time

from program import COARSE_WING, SOURCE
from shell import Shell

CASE = COARSE_WING + "output: {pictures: false}\n"


def start(shell, ranks, *words):
    command = [SOURCE / "scripts" / "mpirun_local.sh", str(ranks), shell.program, *words]
    # mpirun waits a second before it passes a signal on, and another before it kills: little on a busy machine.
    patient = os.environ | {"OMPI_MCA_odls_base_sigkill_timeout": "2"}
    return subprocess.Popen(command, cwd=shell.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=patient)


def report(shell, folder="out"):
    return json.loads((shell.folder / folder / "report.json").read_text())


def wait_for(path, process):
    while not path.exists():
        assert process.poll() is None, process.stdout.read()
        time.sleep(0.01)


def check_one_run_at_a_time(shell):
    """The second is told of the first; what a killed run leaves is no hindrance."""
    lock = shell.folder / "out" / ".lock"
    first = start(shell, 1, "run", "case.yaml", "--set", "sizing.surface_maximum=0.5")
    wait_for(lock, first)
    code, _, error = shell.run("run case.yaml")
    assert code == 7 and "another run writes there (process" in error and "Remedy" in error, error
    for process in lock.read_text().split()[1:2]:
        os.kill(int(process), signal.SIGKILL)
    first.wait()
    assert lock.exists()
    code, _, error = shell.run("run case.yaml")
    assert code == 0 and not lock.exists(), error


def check_end_from_outside(shell):
    """A message, the code of shells, and a report that says so."""
    for ranks, sent in ((1, signal.SIGTERM), (1, signal.SIGUSR1), (2, signal.SIGTERM)):
        run = start(shell, ranks, "run", "case.yaml", "--set", "sizing.minimum=0.02",
                    "--set", f"sizing.surface_maximum={0.04 / ranks}")
        wait_for(shell.folder / "out" / ".lock", run)
        time.sleep(1)
        if ranks == 1:
            os.kill(int((shell.folder / "out" / ".lock").read_text().split()[1]), sent)
        else:
            run.terminate()
        text = run.communicate(timeout=60)[0]
        # mpirun may end before it has passed on what it was told.
        if ranks == 1:
            assert f"ended by {sent.name}" in text and run.returncode == 128 + sent, (run.returncode, text)
        told = report(shell)
        assert (told["status"], told["exit_code"]) == ("failed", 128 + sent), told
        assert sent.name in told["failure"]["message"] and told["failure"]["stage"], told["failure"]


def check_older_files(shell):
    code, _, error = shell.run("run case.yaml --set output.formats=[vtu,su2]")
    assert code == 0, error
    # Of the same mesh, which was made again without it.
    code, _, error = shell.run("run case.yaml")
    assert code == 0 and "not of this run" not in error, error
    code, _, error = shell.run("run case.yaml --set sizing.minimum=0.45")
    assert code == 0 and "not of this run: mesh.su2" in error, error
    assert report(shell)["older_files"] == ["mesh.su2"], report(shell)["older_files"]
    before = (shell.folder / "out" / "mesh.pvtu").read_bytes()
    code, _, error = shell.run("run case.yaml", fault="zone=aborts")
    assert code == 5, error
    assert (shell.folder / "out" / "mesh.pvtu").read_bytes() == before
    assert "mesh.pvtu" in report(shell)["older_files"], report(shell)["older_files"]
    (shell.folder / "out" / "mesh.su2").unlink()
    assert shell.run("run case.yaml")[0] == 0


def check_input_is_kept(shell):
    code, _, error = shell.run("improve out/mesh.pvtu")
    assert code == 2 and "is not overwritten" in error and "output.directory" in error, error
    assert report(shell)["status"] == "ok"


def check_links(shell):
    """What an unfinished file's name points to is nobody's business."""
    precious = shell.folder / "precious"
    names = ["report.json", "report.html", "mesh.pvtu", "mesh.su2", "mesh.cgns", "mesh.meshb", "mesh.msh", "mesh.vtkhdf"]
    for name in names:
        precious.write_text("precious")
        (shell.folder / "out" / f"{name}.unfinished").symlink_to(precious)
    code, _, error = shell.run("run case.yaml --set output.formats=[vtu,su2,cgns,meshb,msh,vtkhdf]")
    assert code == 0, error
    assert precious.read_text() == "precious"


def check_closed_streams(shell):
    for closed in (">&-", "2>&-", "<&- >&- 2>&-"):
        done = subprocess.run(["bash", "-c", f'"{shell.program}" run case.yaml --set output.directory=closed {closed}'],
                              cwd=shell.folder, capture_output=True, text=True, timeout=200)
        assert done.returncode == 0, (closed, done.returncode, done.stderr)
    assert report(shell, "closed")["mesh"]["hash"] == report(shell)["mesh"]["hash"]


def check_odd_geometry(shell):
    os.mkfifo(shell.folder / "pipe.step")
    for file in ("pipe.step", "/dev/zero"):
        for command in ("check", "run"):
            code, _, error = shell.run(f"{command} case.yaml --set geometry.file={file}")
            assert code == 7 and "a device or a pipe" in error, f"{command} {file}: {code} {error}"
    code, _, error = shell.run("init new.yaml --geometry plane.vtp")
    assert code == 2 and "are not read" in error and not (shell.folder / "new.yaml").exists(), error
    code, _, error = shell.run("init new.yaml --geometry plane.STL")
    assert code == 0 and "is not there yet" in error and "plane.STL" in (shell.folder / "new.yaml").read_text(), error


def check_absurd_sizes(shell):
    for command in ("check", "run"):
        code, _, error = shell.run(f"{command} case.yaml --set sizing.minimum=1e-6 --set sizing.maximum=1e-6 "
                                   "--set sizing.surface_maximum=1e-6 --set sizing.feature_minimum=1e-6")
        assert code == 2 and "triangles" in error and "Remedy" in error, f"{command}: {code} {error}"
        code, _, error = shell.run(f"{command} case.yaml --set sizing.minimum=50 --set sizing.maximum=100 "
                                   "--set sizing.surface_maximum=60")
        assert code == 2 and "but the body is only" in error, f"{command}: {code} {error}"
    code, _, error = shell.run("run case.yaml --set sizing.growth=1.0000000001")
    assert code == 2 and "sizing.growth" in error, error
    code, _, error = shell.run("check case.yaml --max-memory 1M")
    assert code == 8 and "--max-memory" in error, error
    start_of_dots = time.monotonic()
    code, _, error = shell.run("run case.yaml --set " + "a." * 10000 + "b=1")
    assert code == 2 and time.monotonic() - start_of_dots < 10 and len(error) < 300, error


def check_bounds_are_told(shell):
    code, text, error = shell.run("run case.yaml --set sizing.curvature_angle=2")
    assert code == 0 and "wins over 2 degrees per element: on " in text + error, text + error
    bounded = report(shell)["sizing"]["bounded_by_minimum"]
    assert bounded and all(0 < face["fraction"] <= 1 and face["degrees"] > 2 for face in bounded), bounded
    assert sum(face["share_of_body"] for face in bounded) > 0.1 and "% of the body. Remedy" in error, error


def check_openfoam_is_warned_of(shell):
    """A case in metres and seconds made of lengths that are not, over results of another mesh."""
    words = (f'run /dev/null --set geometry.file={SOURCE}/tests/data/bracket.igs --set output.directory=foam '
             "--set output.formats=[openfoam] --set output.parts=1 --set farfield.extent=3 --set output.pictures=false "
             "--set sizing.target_tetrahedra=")
    code, _, error = shell.run(words + "20000")
    assert code == 0 and "are in mm" in error and "transformPoints -scale '(0.001 0.001 0.001)'" in error, error
    assert "fields of another mesh" not in error, error
    results = shell.folder / "foam" / "openfoam" / "50"
    results.mkdir()
    (results / "U").write_text("results\n")
    code, _, error = shell.run(words + "25000")
    assert code == 0 and "50' holds fields of another mesh" in error, error
    assert (results / "U").exists()


def check_names_stay(shell):
    """A face is called by its number in the file, whatever is cut off before it is meshed; info and check say where it is."""
    file = SOURCE / "tests" / "data" / "bracket.igs"
    facts = json.loads(shell.run(f"info --json {file}")[1])
    by_name = {face["name"]: face for face in facts["face_table"]}
    assert len(by_name) == facts["faces"] and "face_0" in by_name, sorted(by_name)
    text = shell.run(f"info {file}")[1]
    assert "centre" in text and "face_0" in text, text
    low, high = facts["bounds"]
    middle = 0.5 * (low[1] + high[1])
    seen = {}
    for symmetry in ("none", "y"):
        (shell.folder / "cut.yaml").write_text(
            f'geometry: {{file: "{file}"}}\nfarfield: {{shape: box, extent: 3, symmetry: {symmetry}'
            + (f", symmetry_position: {middle}}}\n" if symmetry == "y" else "}\n"))
        code, _, error = shell.run("check cut.yaml")
        assert code == 0, error
        rows = json.loads((shell.folder / "out" / "check.json").read_text())["domain"]["faces"]
        seen[symmetry] = {row["name"]: row for row in rows if row["name"].startswith("face_")}
    assert len(seen["none"]) == facts["faces"] and len(seen["y"]) >= 3, seen
    whole = 0
    for name, row in seen["y"].items():
        box, uncut = row["box"], by_name[name]["box"]
        slack = 1e-6 * max(abs(high[k] - low[k]) for k in range(3))
        assert all(uncut[0][k] - slack <= box[0][k] and box[1][k] <= uncut[1][k] + slack for k in range(3)), (row, uncut)
        whole += abs(row["area"] / by_name[name]["area"] - 1) < 1e-3
    assert whole >= 1, "no face lies on one side"


def check_small_ones(shell):
    """Settings without effect, a folder that takes no check.json, a text that would be cut."""
    code, _, error = shell.run("improve out/mesh.pvtu --set output.directory=better --set sizing.minimum=0.1")
    assert code == 2 and "'sizing.minimum' says nothing to improve" in error, error
    code, text, error = shell.run("check case.yaml --set output.directory=/proc/nowhere")
    assert code == 0 and "a volume can be meshed" in text and "check.json is not written" in error, (code, error)
    (shell.folder / "nul.yaml").write_text('geometry: {file: "wing.step\\0.igs"}\n')
    code, _, error = shell.run("run nul.yaml")
    assert code == 2 and "without NUL" in error, error
    (shell.folder / "many.yaml").write_text("geometry: {builtin: transport}\npatches:\n" + "".join(
        f"  p{i}: {{faces: [fuselage]}}\n" for i in range(30000)))
    began = time.monotonic()
    code, _, error = shell.run("info many.yaml")
    assert code == 0 and time.monotonic() - began < 30, (error, time.monotonic() - began)


def main():
    shell = Shell(sys.argv[1])
    (shell.folder / "case.yaml").write_text(CASE)
    assert shell.run("run case.yaml")[0] == 0
    for check in (check_closed_streams, check_one_run_at_a_time, check_older_files, check_input_is_kept, check_links,
                  check_odd_geometry, check_absurd_sizes, check_bounds_are_told, check_openfoam_is_warned_of, check_names_stay,
                  check_small_ones, check_end_from_outside):
        check(shell)
        print(check.__name__, "good", flush=True)


if __name__ == "__main__":
    main()
