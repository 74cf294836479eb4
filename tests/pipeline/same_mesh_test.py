#!/usr/bin/env python3
"""The first law: one mesh, whatever the rank count. usage: same_mesh_test.py PROGRAM"""
import csv
import filecmp
import sys

from program import SHARED_CASE, SHARED_RANKS, Run, shared_run


def check_tasks(runs):
    """The same tasks on any number of ranks, and all of their work on a clock."""
    tables = {}
    for ranks, run in runs.items():
        with open(run.output / "tasks.csv", encoding="utf-8") as file:
            tables[ranks] = list(csv.DictReader(file))
        assert {int(row["rank"]) for row in tables[ranks]} == set(range(ranks))
    # What a face counts for is what it took.
    tasks = {ranks: sorted((r["stage"], r["kind"], r["number"], r["predicted"], r["round"], r["kind"] == "face" or r["burden"])
                           for r in rows) for ranks, rows in tables.items()}
    assert tasks[1] == tasks[2] == tasks[3], "tasks depend on the number of ranks"
    kinds = {kind for _, kind, *_ in tasks[1]}
    assert kinds == {"sampled face", "curve", "face", "surface piece", "zone", "core piece",
                     "improved piece", "cavity", "file"}, kinds
    zones = [row for row in tables[1] if row["kind"] == "zone"]
    assert len(zones) >= runs[1].report["volume"]["zones"]
    assert all(int(row["bytes"]) > 0 and int(row["child_bytes"]) > 0 for row in zones), zones
    volume = next(s for s in runs[1].report["stages"] if s["name"] == "volume")
    filling = sum(float(row["cpu_seconds"]) for row in zones)
    assert 0.5 * volume["cpu_seconds_mean"] < filling < 1.01 * volume["cpu_seconds_mean"] + 0.1, (filling, volume)


def main():
    runs = {ranks: shared_run(sys.argv[1]) if ranks == SHARED_RANKS else Run(sys.argv[1], SHARED_CASE, ranks)
            for ranks in (1, 2, 3)}
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
    assert report["volume"]["zones"] >= 3, report["volume"]
    for key in ("zones", "blocks", "lattice_points", "shell_points", "core_tetrahedra", "steiner_points", "retries", "disagreements"):
        values = [runs[ranks].report["volume"][key] for ranks in runs]
        assert values.count(values[0]) == len(values), f"volume.{key} depends on the number of ranks: {values}"
    check_tasks(runs)
    walls = sum(s["wall_seconds"] for s in report["stages"])
    assert abs(walls - report["wall_seconds"]) < 0.02 * report["wall_seconds"] + 0.25, "stages do not add up to the run"
    names = [s["name"] for s in report["stages"]]
    assert names == ["start", "geometry", "sizing", "surface", "decompose", "volume", "improve", "inspect",
                         "output"], names


if __name__ == "__main__":
    main()
