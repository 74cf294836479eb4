#!/usr/bin/env python3
"""All formats of solvers from one run of the built-in aircraft: the same bytes on any number of ranks, what readers
nobody here wrote make of them, and round trips. usage: formats_test.py PROGRAM"""
import hashlib
import pathlib
import subprocess
import sys

from program import SOURCE, Run
from solver_files import CHECKS

AIRCRAFT = """
geometry: {builtin: transport, trailing_edges: sharpen}
farfield: {shape: box, extent: 3}
sizing: {target_tetrahedra: 20000, feature_budget: 1, proximity: 0, curvature_angle: 30, growth: 1.5}
volume: {piece_tets: 20000}
patches:
  wing: {faces: ['wing_*'], type: slip}
  fins: {faces: ['horizontal_*', 'vertical_*']}
"""
READ_BACK = ["mesh.pvtu", "mesh.vtkhdf", "mesh.lb8.ugrid", "mesh.lb8l.ugrid", "mesh.su2", "mesh.su2b", "mesh.msh",
             "mesh.meshb"]
KEEP_TYPES = {"mesh.pvtu", "mesh.vtkhdf", "mesh.msh", "mesh.meshb"}


def digests(folder):
    """Of all that a run leaves but what it says of itself."""
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file() and path.stem not in ("report", "tasks")}


def convert(program, source, target, ranks=1, *options):
    command = [SOURCE / "scripts" / "mpirun_local.sh", ranks, program, "convert", source, target, *options]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout + done.stderr


def check_round_trips(program, folder):
    """Each format that is read gives the mesh of every other: the same points, cells and faces under the same ids."""
    wanted = (folder / "mesh.su2b").read_bytes()
    for i, name in enumerate(READ_BACK):
        back = folder / "back" / f"{name}.su2b"
        code, text = convert(program, folder / name, back, 1 + i % 3)
        assert code == 0 and "nothing to mend" in text, f"{name}: {text}"
        assert back.read_bytes() == wanted, f"{name} comes back as another mesh"
        if name not in KEEP_TYPES:
            continue
        markers = back.with_name(back.name[:-5] + "_markers.cfg").read_text()
        assert markers.replace(back.name, "mesh.su2b") == (folder / "mesh_markers.cfg").read_text(), f"{name}: {markers}"


def main():
    program = sys.argv[1]
    formats = "output.formats=[" + ",".join(CHECKS) + "]"
    first = None
    for ranks in (1, 2, 3):
        run = Run(program, AIRCRAFT, ranks, (formats, "output.parts=2"))
        assert run.code == 0, run.text
        made = digests(run.output)
        first = first or made
        assert made == first, [name for name in first if made.get(name) != first[name]]
    types = {patch["name"]: patch["type"] for patch in run.report["patches"]}
    assert types == {"farfield": "farfield", "fuselage": "wall", "wing": "slip", "fins": "wall"}, types
    for name, check in CHECKS.items():
        try:
            print(f"{name}: {check(run.output, run.report)}")
        except AssertionError as error:
            raise AssertionError(f"{name}: {error}") from error

    whole = Run(program, AIRCRAFT, 2, (formats, "volume.piece_tets=1000000"))
    assert whole.code == 0, whole.text
    check_round_trips(program, whole.output)
    code, text = convert(program, run.output / "mesh_1.msh", run.output / "parts.vtkhdf", 3, "--parts", 5)
    assert code == 0 and "nothing to mend" in text, text

    for arguments, words in ((("absent.su2", "x.cgns"), ("absent.su2", "No such file")),
                             ((run.output / "mesh.su2", "x.stl"), ("x.stl", ".cgns")),
                             ((run.output / "report.json", "x.cgns"), ("report.json", ".meshb")),
                             ((run.output / "mesh.su2", "/proc/x.cgns"), ("/proc/x.cgns",))):
        code, text = convert(program, *arguments, 2)
        assert code in (2, 7) and all(word in text for word in words), f"{arguments}: {code} {text}"
    lost = Run(program, AIRCRAFT, 2, ("patches.wing.faces=winglet_*",))
    assert lost.code == 2 and "'winglet_*'" in lost.text and "'wing_left_upper'" in lost.text, lost.text


if __name__ == "__main__":
    main()
