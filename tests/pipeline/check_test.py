#!/usr/bin/env python3
"""The command check: what it says and how it ends. usage: check_test.py PROGRAM"""
import json
import pathlib
import subprocess
import sys
import tempfile

from program import GEOMETRY, SOURCE


def check(program, case, ranks=1):
    """Exit code, output and check.json."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
    (folder / "case.yaml").write_text(case)
    command = [SOURCE / "scripts" / "mpirun_local.sh", str(ranks), program, "check", folder / "case.yaml",
               "--set", f"output.directory={folder / 'out'}"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, cwd=folder)
    record = folder / "out" / "check.json"
    return done.returncode, done.stdout + done.stderr, json.loads(record.read_text()) if record.exists() else None


def check_sound(program):
    case = "geometry: {builtin: transport}\nfarfield: {shape: cylinder, extent: 3}\nsizing: {target_tetrahedra: 200000}\n"
    records = {}
    for ranks in (1, 2):
        code, text, record = check(program, case, ranks)
        assert code == 0, text
        assert "a volume can be meshed" in text and record["meshable"], text
        assert record["read"]["solids"] == 1 and record["read"]["open_edges"] == 0
        assert {"fuselage", "farfield"} <= {patch["name"] for patch in record["domain"]["patches"]}
        forecast = record["forecast"]
        assert 0.5 < forecast["tetrahedra"] / forecast["features"]["share"] / 200000 < 2
        records[ranks] = record
    one, two = records[1]["forecast"], records[2]["forecast"]
    assert one["tetrahedra"] == two["tetrahedra"] and one["piece_tets"] >= two["piece_tets"]


def check_open(program):
    file = GEOMETRY / "parts" / "gmsh_capot.brep"
    if not file.exists():
        print("no real geometry here: skipped the open shell")
        return
    code, text, record = check(program, f"geometry: {{file: {file}}}\n", 2)
    assert code == 3, text
    assert "no volume can be meshed" in text and "an open edge of length" in text, text
    assert not record["meshable"] and record["read"]["open_edges"] == 22 and record["read"]["faces"] == 18
    assert all(len(finding["where"]) == 3 for finding in record["findings"])
    assert "forecast" not in record and file.name in record["failure"]


def check_unreadable(program):
    code, text, record = check(program, "geometry: {file: nowhere.step}\n")
    assert code == 7 and "nowhere.step" in text and record is None, text


def check_sharpened(program):
    case = "geometry: {{builtin: transport, trailing_edges: sharpen, sharpen_faces: [{}]}}\nsizing: {{target_tetrahedra: 50000}}\n"
    code, text, record = check(program, case.format("'wing*'"))
    assert code == 0, text
    closed = [change for change in record["domain"]["changes"] if "was closed to a curve" in change["what"]]
    assert len(closed) == 2 and all(0.03 < change["how_much"] < 0.06 for change in closed), text
    assert all(change["what"] in text for change in closed), text
    patches = {patch["name"] for patch in record["domain"]["patches"]}
    assert "wing_left_trailing_edge" not in patches and "vertical_tail_trailing_edge" in patches, patches
    code, text, record = check(program, case.format("wings"))
    assert code == 3 and "no face and no patch of this model is called 'wings'" in text, text


def check_edges(program):
    """What becomes of thin trailing edges is the same in `check` and in a run."""
    case = ("geometry:\n  builtin: transport\n"
            "  dimensions: {wing: {trailing_edge: 0.0003}, horizontal_tail: {trailing_edge: 0.003}}\n"
            "farfield: {shape: cylinder, extent: 2}\nsizing: {target_tetrahedra: 20000}\n")
    code, text, record = check(program, case)
    assert code == 0, text
    edges = record["forecast"]["trailing_edges"]
    fates = {edge["face"]: edge["fate"] for edge in edges}
    assert fates["wing_left_trailing_edge"] == fates["wing_right_trailing_edge"] == "closed", fates
    assert fates["horizontal_tail_left_trailing_edge"] == "graded", fates
    assert all(edge["what"] in text for edge in edges if edge["fate"] != "kept"), text
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
    (folder / "case.yaml").write_text(case)
    command = [SOURCE / "scripts" / "mpirun_local.sh", "2", program, "run", folder / "case.yaml",
               "--set", f"output.directory={folder / 'out'}"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=200, cwd=folder)
    assert done.returncode == 0, done.stdout + done.stderr
    report = json.loads((folder / "out" / "report.json").read_text())
    assert report["sizing"]["trailing_edges"] == edges, report["sizing"]["trailing_edges"]
    assert report["sizing"]["features"]["aspect"] == record["forecast"]["features"]["aspect"]
    assert not any(patch["name"] == "wing_left_trailing_edge" for patch in report["patches"]), report["patches"]


def check_layers(program):
    """What layers would be: y+ in both meanings, as many as sizes ask, and how much of them a duct has no room for."""
    case = (f"geometry: {{file: '{SOURCE}/configs/geometry/duct.step', domain: fluid}}\n"
            "patches: {inlet: {faces: ['#ff0000'], type: inlet}, outlet: {type: outlet}}\n"
            "sizing: {target_tetrahedra: 4000, solver: cell}\nlayers: {y_plus: 1.5, reynolds: 1e5, length: 1, growth: 1.2}\n")
    code, text, record = check(program, case)
    assert code == 0, text
    layers = record["forecast"]["layers"]
    assert layers["cells"] == sum(row["cells"] for row in layers["patches"]) > 1000
    for row in layers["patches"]:
        assert abs(row["y_plus_node"] - 3) < 1e-9 and abs(row["y_plus_centre"] - 1.5) < 1e-9 and row["growth"] == 1.2, row
        assert 1 < row["layers_min"] <= row["layers_max"] and row["first"] < row["total_min"] <= row["total_max"], row
    narrow = [row for row in layers["patches"] if row["squeezed"] + row["lacking"] > 0]
    assert narrow and all(row["narrowest_gap"] < 2.6 * row["total_max"] + record["forecast"]["maximum"] for row in narrow), layers
    assert "y+ 3 at its node, 1.5 at its centre" in text and "no room for that on" in text and "layers add: about" in text, text


def main():
    check_edges(sys.argv[1])
    check_sound(sys.argv[1])
    check_layers(sys.argv[1])
    check_sharpened(sys.argv[1])
    check_open(sys.argv[1])
    check_unreadable(sys.argv[1])


if __name__ == "__main__":
    main()
