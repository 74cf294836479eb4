#!/usr/bin/env python3
"""A body of triangles in a far field: one mesh, whatever the rank count. usage: faceted_test.py PROGRAM"""
import math
import pathlib
import sys
import tempfile

from program import Run

CORNERS, LAYERS, HEIGHT = 32, 8, 3.0

CASE = """
geometry: {{file: "{file}"}}
farfield: {{shape: box, extent: 3}}
sizing: {{minimum: 0.1, maximum: 3, surface_maximum: 0.4, curvature_angle: 25, growth: 1.8, proximity: 0}}
output: {{pictures: false}}
"""


def prism():
    """Triangles of a prism over a regular polygon, as three points each, normals outwards."""
    def at(layer, i):
        angle = 2 * math.pi * (i % CORNERS) / CORNERS
        return (math.cos(angle), math.sin(angle), HEIGHT * layer / LAYERS)
    for i in range(CORNERS):
        for k in range(LAYERS):
            yield at(k, i), at(k, i + 1), at(k + 1, i + 1)
            yield at(k, i), at(k + 1, i + 1), at(k + 1, i)
        yield (0, 0, 0), at(0, i + 1), at(0, i)
        yield (0, 0, HEIGHT), at(LAYERS, i), at(LAYERS, i + 1)


def write_stl(file):
    lines = ["solid drum"]
    for triangle in prism():
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x:.9e} {y:.9e} {z:.9e}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    file.write_text("\n".join(lines + ["endsolid drum", ""]))


def main():
    with tempfile.TemporaryDirectory(prefix="aeroloom_test_") as name:
        file = pathlib.Path(name) / "drum.stl"
        write_stl(file)
        runs = {}
        for ranks in (1, 3):
            folder = pathlib.Path(name) / str(ranks)
            folder.mkdir()
            runs[ranks] = Run(sys.argv[1], CASE.format(file=file), ranks, folder=folder)
            assert runs[ranks].code == 0, f"{ranks} ranks ended with {runs[ranks].code}:\n{runs[ranks].text}"
        hashes = {ranks: run.report["mesh"]["hash"] for ranks, run in runs.items()}
        assert len(set(hashes.values())) == 1, hashes
        report = runs[1].report
        assert {p["name"] for p in report["patches"]} == {"farfield", "drum"}, report["patches"]
        # The volume that the triangles enclose is missing from the box.
        body = HEIGHT * CORNERS / 2 * math.sin(2 * math.pi / CORNERS)
        box = (2 * 3 * HEIGHT) ** 3
        volume = report["mesh"]["volume"]
        print("hash", hashes[1], "tetrahedra", report["mesh"]["tetrahedra"], "volume", volume, "of", box - body)
        assert abs(volume - (box - body)) < 0.03 * body, "chords of elements take more than a thirtieth of the body"
        assert report["quality"]["min_dihedral_deg"] > 10, report["quality"]


if __name__ == "__main__":
    main()
