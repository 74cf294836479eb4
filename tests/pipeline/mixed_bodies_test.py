#!/usr/bin/env python3
"""A body of CAD and bodies of triangles in one case: beside it, one mesh whatever the rank count; across it, a union.
usage: mixed_bodies_test.py PROGRAM"""
import math
import pathlib
import sys
import tempfile

from program import COARSE_WING, Run

ROWS = 12
SIZES = ("sizing.minimum=0.25", "sizing.curvature_angle=25")


def ball(center, radius):
    """Triangles of a ball, as three points each, normals outwards."""
    def at(k, i):
        around, down = math.pi * (i % (2 * ROWS)) / ROWS, math.pi * k / ROWS
        return (center[0] + radius * math.sin(down) * math.cos(around),
                center[1] + radius * math.sin(down) * math.sin(around), center[2] - radius * math.cos(down))
    for k in range(ROWS):
        for i in range(2 * ROWS):
            if k > 0:
                yield at(k, i), at(k, i + 1), at(k + 1, i + 1)
            if k < ROWS - 1:
                yield at(k, i), at(k + 1, i + 1), at(k + 1, i)


def write_stl(file, triangles):
    lines = ["solid ball"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x:.9e} {y:.9e} {z:.9e}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    file.write_text("\n".join(lines + ["endsolid ball", ""]))


def enclosed(triangles):
    def triple(a, b, c):
        return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
    return sum(triple(*triangle) for triangle in triangles) / 6


def run(program, name, folder, triangles, ranks=1, extra=""):
    """The case lies beside the triangles, which it names without their folder."""
    place = folder / f"{name}_{ranks}"
    place.mkdir()
    if triangles:
        write_stl(place / "store.stl", triangles)
    case = COARSE_WING
    if triangles:
        case = case.replace("sharpen}", "sharpen, parts: {store: {file: store.stl, scale: 0.5}}}")
    case = case.replace("shape: box, extent: 3", "shape: box, extent: 20, unit: length")
    done = Run(program, case + extra + "output: {pictures: false}\n", ranks, SIZES, folder=place)
    assert done.code == 0, f"{name} on {ranks} ranks ended with {done.code}:\n{done.text}"
    return done


def check_beside(program, folder):
    """The store stands under the wing."""
    triangles = list(ball((7, 4, -4), 1.6))
    extra = "groups: {hung: {part: store, type: slip}}\n"
    runs = {ranks: run(program, "beside", folder, triangles, ranks, extra) for ranks in (1, 3)}
    hashes = {ranks: each.report["mesh"]["hash"] for ranks, each in runs.items()}
    assert len(set(hashes.values())) == 1, hashes
    report = runs[1].report
    assert report["quality"]["min_dihedral_deg"] > 8, report["quality"]["min_dihedral_deg"]
    assert "was closed to a curve" in " ".join(change["what"] for change in report["geometry"]["changes"])
    assert "hung" in {p["name"] for p in report["patches"]} and len(report["patches"]) > 2, report["patches"]
    alone = run(program, "alone", folder, None).report["mesh"]["volume"]
    missing, store = alone - report["mesh"]["volume"], enclosed(triangles) / 8
    print("hash", hashes[1], "the store takes", missing, "of", store)
    # Chords of elements cut corners of the store; the wing's elements differ a little.
    assert abs(missing - store) < 0.1 * store, (missing, store)


def check_across(program, folder):
    """The store sits in the wing: what both enclose is one body of triangles, and said to be."""
    done = run(program, "across", folder, list(ball((7.8, 4.4, 0), 1)))
    assert "warning: geometry: body" in done.text and "triangles, at most" in done.text, done.text
    assert "are united" in done.text and "'store'" in done.text, done.text
    names = {p["name"] for p in done.report["patches"]}
    assert "store" in names and len(names) > 2, names
    changes = " ".join(change["what"] for change in done.report["geometry"]["changes"])
    assert "triangles, at most" in changes, changes


def main():
    with tempfile.TemporaryDirectory(prefix="aeroloom_test_") as name:
        check_beside(sys.argv[1], pathlib.Path(name))
        check_across(sys.argv[1], pathlib.Path(name))


if __name__ == "__main__":
    main()
