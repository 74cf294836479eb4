#!/usr/bin/env python3
"""aeroloom quality FILE and the limits on cells, as a user meets them. usage: quality_file_test.py PROGRAM"""
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

from program import SOURCE

GATE_KEYS = ("smallest_angle", "largest_angle", "percentile_01", "percentile_1", "percentile_5", "min_mean_ratio",
             "mean_mean_ratio", "largest_volume_ratio", "largest_edge_ratio", "min_scaled_jacobian")


def quality(program, *arguments, ranks=1):
    command = [SOURCE / "scripts" / "mpirun_local.sh", str(ranks), program, "quality", *arguments]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=60)
    return done.returncode, done.stdout, done.stderr


def medit_mesh():
    """Layers of prisms, 1, 2 and 4 high, over a unit square; elsewhere a cube of six tetrahedra."""
    points = [(x, y, z) for z in (0, 1, 3, 7) for y in (0, 1) for x in (0, 1)]
    prisms = [(4 * k + a, 4 * k + b, 4 * k + c, 4 * k + 4 + a, 4 * k + 4 + b, 4 * k + 4 + c)
              for k in range(3) for a, b, c in ((1, 2, 4), (1, 4, 3))]
    first = len(points) + 1
    points += [(5 + x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    tetrahedra = []
    for steps in itertools.permutations((1, 2, 4)):
        corners = [first, first + steps[0], first + steps[0] + steps[1], first + 7]
        tetrahedra.append(corners)  # every other one is turned over
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points))]
    lines += [f"{x} {y} {z} 0" for x, y, z in points]
    lines += ["Quadrilaterals", "1", "1 2 6 5 4", "Triangles", "2", "1 2 4 3", "1 4 3 3"]
    lines += ["Prisms", str(len(prisms))] + [" ".join(map(str, p)) + " 1" for p in prisms]
    lines += ["Tetrahedra", "6"] + [" ".join(map(str, t)) + " 2" for t in tetrahedra]
    return "\n".join([*lines, "End", ""])


def check_numbers(report):
    assert report["mesh"]["prisms"] == 6 and report["mesh"]["tetrahedra"] == 6 and report["mesh"]["pyramids"] == 0
    assert abs(report["mesh"]["volume"] - 8) < 1e-12
    assert [(r["name"], round(r["volume"], 12)) for r in report["regions"]] == [("layers", 7), ("cube", 1)]
    patches = {p["name"]: p for p in report["patches"]}
    assert patches["the wall"]["triangles"] == 2 and abs(patches["the wall"]["area"] - 1) < 1e-12
    assert patches["plane / y = 0"]["type"] == "symmetry" and patches["plane / y = 0"]["quadrilaterals"] == 1
    assert report["reading"]["turned_cells"] == 3 and report["reading"]["unnamed_faces"] > 0
    assert set(report["defects"].values()) == {0}
    prisms, tetrahedra = report["quality"]["prisms"], report["quality"]["tetrahedra"]
    assert abs(prisms["volume_ratio"]["maximum"] - 2) < 1e-12, prisms["volume_ratio"]
    assert abs(prisms["volume_ratio"]["minimum"] - 2) < 1e-12  # the larger of all neighbours
    assert abs(prisms["edge_ratio"]["maximum"] - 4) < 1e-12
    assert abs(prisms["scaled_jacobian"]["minimum"] - (2 / 3) ** 0.5) < 1e-12
    assert abs(prisms["min_dihedral_deg"]["minimum"] - 45) < 1e-9 and "mean_ratio" not in prisms
    assert abs(tetrahedra["max_dihedral_deg"]["maximum"] - 90) < 1e-9 and "scaled_jacobian" not in tetrahedra
    assert abs(tetrahedra["volume_ratio"]["maximum"] - 1) < 1e-12
    assert sum(prisms["volume"]["histogram"]["counts"]) == 6 and prisms["volume"]["percentile_50"] <= 1
    worst = report["quality"]["worst"]["edge_ratio"][0]
    assert worst["shape"] == "prisms" and worst["center"][2] == 5 and worst["value"] == prisms["edge_ratio"]["maximum"]


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        mesh = folder / "stack.mesh"
        mesh.write_text(medit_mesh())
        (folder / "stack.names").write_text("prisms 1 layers\ntetrahedra 2 cube\ntriangles 3 the wall wall\n"
                                            "quadrilaterals 4 plane / y = 0 symmetry\n")
        texts = set()
        for ranks in (1, 2, 3):
            code, text, error = quality(program, mesh, "--json", ranks=ranks)
            assert code == 0, error
            texts.add(text)
        assert len(texts) == 1, "the report depends on the number of ranks"
        check_numbers(json.loads(texts.pop()))

        code, text, error = quality(program, mesh, "--output", folder / "new" / "quality.json", ranks=2)
        assert code == 0, error
        for word in ("the wall", "scaled Jacobian of prisms", "#####", "defects: none", "worst cells", "3 cells turned"):
            assert word in text, f"{word}\n{text}"
        check_numbers(json.loads((folder / "new" / "quality.json").read_text()))

        # Limits: each key is known, each is missed by a limit beyond what the mesh has.
        loose, tight = [], []
        for key in GATE_KEYS:
            bounds = ("0", "90") if "angle" in key or "percentile" in key else ("0", "1")
            if key.startswith("largest"):
                bounds = ("180", "1") if "angle" in key else ("1e3", "1")
            loose.append(f"--gate.{key}={bounds[0]}")
            tight += ["--gate." + key, bounds[1]]
        assert quality(program, mesh, *loose)[0] == 0
        code, text, error = quality(program, mesh, *tight, "--json", ranks=2)
        assert code == 6 and not json.loads(text)["gate"]["passed"], error
        for key in GATE_KEYS:
            assert f"improve.gate.{key} is" in error, f"{key}\n{error}"
        code, _, error = quality(program, mesh, "--gate.largest_edge_ratio=3")
        assert code == 6 and "(cell " in error and "5)" in error, error

        for arguments, expected, word in ((("--gate.smallest_angel=3",), 2, "smallest_angel"),
                                          (("--gate.largest_edge_ratio=0.5",), 2, "largest_edge_ratio"),
                                          (("--gate.min_mean_ratio=much",), 2, "min_mean_ratio")):
            code, text, error = quality(program, mesh, *arguments)
            assert code == expected and word in text + error, f"{arguments}: {code}\n{text}{error}"
        (folder / "torn.mesh").write_text(medit_mesh()[:300])
        (folder / "mesh.stl").write_text("solid")
        for file in ("torn.mesh", "absent.meshb", "mesh.stl"):
            code, _, error = quality(program, folder / file, ranks=2)
            assert code == 7 and file in error, f"{file}: {code}\n{error}"
        code, _, error = quality(program, mesh, "--output", mesh / "no.json")
        assert code == 7 and "no.json" in error, error


main()
