#!/usr/bin/env python3
"""The first law: one mesh, whatever the rank count. usage: same_mesh_test.py PROGRAM"""
import filecmp
import sys

from program import COARSE_TRANSPORT, Run


def main():
    pieces = ("volume.piece_tets=30000", "surface.piece_triangles=1500")
    runs = {ranks: Run(sys.argv[1], COARSE_TRANSPORT, ranks, pieces) for ranks in (1, 2, 3)}
    for ranks, run in runs.items():
        assert run.code == 0, f"{ranks} ranks ended with {run.code}:\n{run.text}"
        assert run.report["status"] == "ok" and run.report["ranks"] == ranks
    hashes = {ranks: run.report["mesh"]["hash"] for ranks, run in runs.items()}
    print("hashes", hashes, "seconds", {r: round(run.seconds, 1) for r, run in runs.items()})
    assert len(hashes[1]) == 32 and len(set(hashes.values())) == 1, "the mesh depends on the number of ranks"
    for file in ("mesh.pvtu", "surface.pvtp"):
        for ranks in (2, 3):
            assert filecmp.cmp(runs[1].output / file, runs[ranks].output / file, shallow=False), f"{file} differs"
    report = runs[1].report
    assert report["mesh"]["tetrahedra"] > 20000
    assert all(p["name"] and p["triangles"] > 0 for p in report["patches"])
    assert {"farfield", "fuselage"} <= {p["name"] for p in report["patches"]}
    assert report["volume"]["zones"] >= 4, report["volume"]
    for key in ("zones", "blocks", "lattice_points", "steiner_points", "retries", "disagreements"):
        values = [runs[ranks].report["volume"][key] for ranks in runs]
        assert values.count(values[0]) == len(values), f"volume.{key} depends on the number of ranks: {values}"
    walls = sum(s["wall_seconds"] for s in report["stages"])
    assert abs(walls - report["wall_seconds"]) < 0.02 * report["wall_seconds"] + 0.05, "stages do not add up to the run"
    names = [s["name"] for s in report["stages"]]
    assert names == ["start", "geometry", "sizing", "surface", "decompose", "volume", "improve", "inspect",
                         "output"], names


if __name__ == "__main__":
    main()
