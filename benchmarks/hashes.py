#!/usr/bin/env python3
"""Hashes of surface and mesh of a list of cases on 1, 2 and 3 ranks: what no change of the code's shape may change.

usage: hashes.py PROGRAM [--ranks 1,2,3] [--only PART ...] (--write FILE | --compare FILE)

Run from the repository's root. Writes a row for each case and number of ranks, or compares with the rows of a file and
exits with 1 where one differs. Cases whose geometry is absent are left out, and said to be. The hash of the mesh is that of report.json;
that of the surface is SHA-256 over the points and triangles of surface.pvtp in the order of their numbers, so it does not depend
on how many files there are. A run that is killed and resumed, and the prediction from a recorded study, stand among the cases.
"""
import argparse
import csv
import hashlib
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPPolyDataReader

SOURCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "tests" / "pipeline"))
from killed_run import command, run_and_kill  # noqa: E402

ACCEPTANCE = ["whole_transport", "spine_dlr_f6", "improve_oneram6", "real_d150_half", "spine_wing_fuselage", "layers_transport",
              "layers_oneram6", "layers_capsule", "layers_d150_half", "layers_d150_wing", "layers_dlr_f6"]
CONFIGS = {"sources": [], "half_model": [], "wake_and_tips": [],
           "level_A": ["sizing.level=F", "sizing.budget=2e7"]}
FACETED = ["netgen_hinge.stl", "ftetwild_bunny.off", "tetgen_example.poly"]
RECORDED = SOURCE / "benchmarks" / "data" / "recorded_run"
COLUMNS = ["case", "ranks", "surface", "mesh", "tetrahedra"]


def write_ball(file, center, radius, rows=12):
    """Triangles of a ball as STL, normals outwards."""
    def at(k, i):
        around, down = math.pi * (i % (2 * rows)) / rows, math.pi * k / rows
        return (center[0] + radius * math.sin(down) * math.cos(around),
                center[1] + radius * math.sin(down) * math.sin(around), center[2] - radius * math.cos(down))
    lines = ["solid ball"]
    for k in range(rows):
        for i in range(2 * rows):
            corners = [(at(k, i), at(k, i + 1), at(k + 1, i + 1))] if k > 0 else []
            corners += [(at(k, i), at(k + 1, i + 1), at(k + 1, i))] if k < rows - 1 else []
            for triangle in corners:
                lines += ["facet normal 0 0 0", "outer loop", *(f"vertex {x:.9e} {y:.9e} {z:.9e}" for x, y, z in triangle),
                          "endloop", "endfacet"]
    file.write_text("\n".join([*lines, "endsolid ball", ""]))


def surface_hash(file):
    """SHA-256 over points and triangles in the order of their numbers; each triangle from its lowest number."""
    reader = vtkXMLPPolyDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    surface = reader.GetOutput()
    numbers = vtk_to_numpy(surface.GetPointData().GetArray("global_id")).astype(numpy.int64)
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(numpy.float64)
    _, first = numpy.unique(numbers, return_index=True)
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    starts = vtk_to_numpy(surface.GetPolys().GetOffsetsArray())
    triangles = numbers[corners[starts[:-1][numpy.diff(starts) == 3][:, None] + numpy.arange(3)]]
    turns = triangles.argmin(axis=1)[:, None]
    triangles = numpy.take_along_axis(triangles, (turns + numpy.arange(3)) % 3, axis=1)
    triangles = triangles[numpy.lexsort(triangles.T[::-1])]
    digest = hashlib.sha256()
    for array in (numbers[first], points[first], triangles):
        digest.update(numpy.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:32]


def finished(output, done):
    if done.returncode:
        return {"surface": f"exit code {done.returncode}", "mesh": "", "tetrahedra": ""}
    mesh = json.loads((output / "report.json").read_text())["mesh"]
    return {"surface": surface_hash(output / "surface.pvtp"), "mesh": mesh["hash"], "tetrahedra": mesh["tetrahedra"]}


def run(program, case, output, ranks, *overrides):
    shutil.rmtree(output, ignore_errors=True)
    words = command(program, case, output, ranks, "output.pictures=false", *overrides)
    return finished(output, subprocess.run(words, capture_output=True, cwd=SOURCE, check=False))


def resumed(program, case, output, ranks):
    """Killed when its surface is on disk, resumed on another number of ranks."""
    shutil.rmtree(output, ignore_errors=True)
    settings = ("sizing.target_tetrahedra=300000", "output.pictures=false")
    checkpoint = output / "checkpoint"
    run_and_kill(program, case, output, ranks, lambda _: any(checkpoint.glob("surface*")), "output.checkpoints=write", *settings)
    words = command(program, case, output, ranks % 3 + 1, "output.checkpoints=resume", *settings)
    return finished(output, subprocess.run(words, capture_output=True, cwd=SOURCE, check=False))


def predicted(program, work):
    """The prediction from a recorded run, which is a function of its files alone."""
    folder = work / "recorded"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(RECORDED, folder)
    done = subprocess.run([program, "scaling", "--predict", str(folder), "--ranks", "1,2,4,8,64,1024", "--latency", "2e-6",
                           "--bandwidth", "5e9"], capture_output=True, check=False)
    files = [(folder / name).read_bytes() for name in ("prediction.csv",)] if done.returncode == 0 else []
    return {"surface": "", "mesh": hashlib.sha256(b"".join(files)).hexdigest()[:32] if files else f"exit code {done.returncode}",
            "tetrahedra": ""}


def cases(program, work):
    """Name and a function of the number of ranks for each case whose geometry is there."""
    def plain(case, *overrides):
        return lambda ranks: run(program, case, work / "out", ranks, *overrides)
    for name in ACCEPTANCE:
        file = SOURCE / "configs" / "acceptance" / f"{name}.yaml"
        named = [SOURCE / word.rstrip("}") for word in file.read_text().split() if word.startswith("../")]
        yield name, plain(file) if all(path.exists() for path in named) else None
    for name, overrides in CONFIGS.items():
        yield name, plain(SOURCE / "configs" / f"{name}.yaml", *overrides)
    for name in FACETED:
        file = SOURCE.parent / "shared" / "geometry" / "faceted" / name
        case = work / f"{name}.yaml"
        case.write_text(json.dumps({"geometry": {"file": str(file)}}))
        yield name, plain(case) if file.exists() else None
    write_ball(work / "ball.stl", (30, 40, 3), 2)
    case = work / "parts.yaml"
    case.write_text(json.dumps({"geometry": {"builtin": "transport", "parts": {"ball": {"file": str(work / "ball.stl")}}},
                                "farfield": {"shape": "box", "extent": 5}, "sizing": {"target_tetrahedra": 300000}}))
    yield "parts", plain(case)
    yield "resumed", lambda ranks: resumed(program, SOURCE / "configs" / "transport.yaml", work / "out", ranks)
    yield "predicted", lambda ranks: predicted(program, work) if ranks == 1 else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--ranks", default="1,2,3")
    parser.add_argument("--only", nargs="*", default=[])
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--write", type=pathlib.Path)
    what.add_argument("--compare", type=pathlib.Path)
    options = parser.parse_args()
    program, different, rows = options.program.resolve(), 0, []
    wanted = {}
    if options.compare:
        wanted = {(row["case"], row["ranks"]): row for row in csv.DictReader(options.compare.open(encoding="utf-8"))}
    with tempfile.TemporaryDirectory(prefix="aeroloom_hashes_") as name:
        for case, run_on in cases(program, pathlib.Path(name)):
            if options.only and not any(part in case for part in options.only):
                continue
            if run_on is None:
                print(f"{case}: left out, its geometry is absent", flush=True)
                continue
            for ranks in map(int, options.ranks.split(",")):
                result = run_on(ranks)
                if result is None:
                    continue
                row = {"case": case, "ranks": str(ranks), **{key: str(value) for key, value in result.items()}}
                rows.append(row)
                same = not options.compare or wanted.get((case, str(ranks))) == row
                different += not same
                print(*row.values(), "" if same else f"DIFFERENT from {wanted.get((case, str(ranks)))}", flush=True)
    if options.write:
        with options.write.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    print(f"{len(rows)} rows" + (f", {different} different" if options.compare else ""))
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
