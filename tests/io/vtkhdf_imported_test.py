#!/usr/bin/env python3
"""VTKHDF files as other programs may write them, and what the reader makes of them.

usage: vtkhdf_imported_test.py WRITER MPIRUN
"""
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import h5py
    import numpy as np
except ImportError as missing:
    print("skipped:", missing)
    sys.exit(77)

GRID = ["NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds", "Points", "Connectivity", "Offsets", "Types"]
NAMES = h5py.string_dtype("ascii")


class Tester:
    def __init__(self, writer, mpirun, folder):
        self.writer, self.mpirun, self.folder = writer, mpirun, folder
        self.run(1, "vtkhdf", folder)
        with h5py.File(folder / "mesh.vtkhdf") as file:
            self.grid = {name: file["VTKHDF"][name][:] for name in GRID}
            self.ids = file["VTKHDF/PointData/global_id"][:]
            self.region = file["VTKHDF/CellData/region"][:]
            self.boundary = {name: file["Boundary"][name][:] for name in
                             ["Connectivity", "Offsets", "Types", "Patch", "PatchNames", "PatchTypes"]}
        self.expected = []
        self.good = self.read([folder / "mesh.vtkhdf"])[0]
        self.sizes = [line for line in self.good if line.startswith(("vertices", "cells"))]
        assert len(self.sizes) == 2, self.good

    def run(self, ranks, *arguments):
        return subprocess.run([self.mpirun, str(ranks), self.writer, *map(str, arguments)], check=True,
                              capture_output=True, text=True).stdout

    def read(self, paths):
        """What the reader tells of each file, in lines; the same from any number of ranks."""
        told = {ranks: re.split(r"^file .*\n", self.run(ranks, "read", *paths), flags=re.M)[1:] for ranks in (1, 3)}
        for ranks in (1, 3):
            assert len(told[ranks]) == len(paths), told[ranks]
            for one, other in zip(told[1], told[ranks]):
                assert one.split(" (")[0] == other.split(" (")[0], (one, other)
        return [text.splitlines() for text in told[1]]

    def expect(self, path, fulfilled):
        """What check() holds against what is told of the file: a predicate of the lines."""
        self.expected.append((path, fulfilled))

    def check(self):
        for (path, fulfilled), told in zip(self.expected, self.read([path for path, _ in self.expected]), strict=True):
            assert fulfilled(told), (path.name, told)
        return len(self.expected)

    def make(self, name, grid=None, points=None, cells=None, fields=None, kind="UnstructuredGrid", boundary=False,
             **options):
        path = self.folder / f"{name}.vtkhdf"
        with h5py.File(path, "w") as file:
            top = file.create_group("VTKHDF")
            top.attrs["Version"] = (2, 2)
            top.attrs["Type"] = kind
            for name, items in (grid or self.grid).items():
                top.create_dataset(name, data=items, **options)
            for group, arrays in (("PointData", points), ("CellData", cells), ("FieldData", fields)):
                for name, items in (arrays or {}).items():
                    top.create_dataset(f"{group}/{name}", data=items)
            if boundary:
                for name, items in self.boundary.items():
                    file.create_dataset(f"Boundary/{name}", data=items)
        return path

    def is_good(self, told):
        return told == self.good

    def has_sizes(self, told):
        return told[:2] == self.sizes

    def refused(self, path, *words):
        self.expect(path, lambda told: len(told) == 1 and told[0].startswith("error ") and path.name in told[0]
                    and all(word in told[0] for word in words))

    def merged(self):
        """The grid as one partition, without ids; boundary faces follow the cells."""
        places = np.zeros((self.ids.max() + 1, 3))
        places[self.ids] = self.grid["Points"]
        corners, offsets, types = [], [0], list(self.grid["Types"])
        first_point = first_corner = first_offset = 0
        for p in range(len(self.grid["NumberOfCells"])):
            n = self.grid["NumberOfCells"][p]
            local = self.grid["Offsets"][first_offset:first_offset + n + 1]
            for c in range(n):
                cell = self.grid["Connectivity"][first_corner + local[c]:first_corner + local[c + 1]]
                corners += list(self.ids[first_point + cell])
                offsets.append(len(corners))
            first_point += self.grid["NumberOfPoints"][p]
            first_corner += self.grid["NumberOfConnectivityIds"][p]
            first_offset += n + 1
        corners += list(self.boundary["Connectivity"])
        offsets += [offsets[-1] + o for o in self.boundary["Offsets"][1:]]
        types += list(self.boundary["Types"])
        return self.single(places, corners, offsets, types)

    @staticmethod
    def single(places, corners, offsets, types):
        return {"NumberOfPoints": [len(places)], "NumberOfCells": [len(types)], "NumberOfConnectivityIds": [len(corners)],
                "Points": places, "Connectivity": np.array(corners, dtype=np.int64),
                "Offsets": np.array(offsets, dtype=np.int64), "Types": np.array(types, dtype=np.uint8)}


def other_layouts(t):
    fields = {"region_names": np.array(["lower layer", "upper"], dtype=NAMES)}
    cells = {"region": t.region}
    for name, options in (("chunked", {"chunks": True}), ("packed", {"compression": "gzip", "shuffle": True}),
                          ("checked", {"fletcher32": True})):
        path = t.make(name, points={"global_id": t.ids}, cells=cells, fields=fields, boundary=True, **options)
        t.expect(path, t.is_good)
    swapped = {name: items.astype(items.dtype.newbyteorder(">")) for name, items in t.grid.items()}
    swapped["Types"] = t.grid["Types"].astype(">i4")
    path = t.make("swapped", swapped, points={"global_id": t.ids.astype(">u4")}, cells=cells, fields=fields, boundary=True)
    t.expect(path, t.is_good)


def ids_of_points(t):
    t.refused(t.make("no_ids"), "3 partitions without global ids", "Generate Global Ids")
    path = t.make("paraview", points={"GlobalPointIds": t.ids})
    t.expect(path, lambda told: t.has_sizes(told) and "region fluid" in told[2])
    path = t.make("marked", points={"some name": t.ids + 5})
    with h5py.File(path, "r+") as file:
        file["VTKHDF/PointData/some name"].attrs["Attribute"] = np.bytes_("GlobalIds")
    t.expect(path, t.has_sizes)
    bad = t.ids.copy()
    bad[3] = -4
    t.refused(t.make("negative", points={"global_id": bad}), "point 3 has the id -4")


def faces_among_cells(t):
    grid = t.merged()
    volume_cells = len(t.grid["Types"])
    patch = np.concatenate([np.full(volume_cells, -1), t.boundary["Patch"]])
    names = np.array([n.decode() for n in t.boundary["PatchNames"]], dtype=NAMES)
    kinds = np.array([n.decode() for n in t.boundary["PatchTypes"]], dtype=NAMES)
    region = np.concatenate([t.region, np.zeros(len(t.boundary["Types"]), dtype=t.region.dtype)])
    t.expect(t.make("faces", grid, cells={"patch": patch, "region": region},
                    fields={"patch_names": names, "patch_types": kinds, "region_names": t_names()}), t.is_good)
    numbered = np.where(patch >= 0, 10 * patch + 7, patch)
    t.expect(t.make("numbers", grid, cells={"patch": numbered, "region": 5 * region + 7}),
             lambda told: t.has_sizes(told) and [line.split()[:2] for line in told[2:5]] == [
                 ["region", "region_7"], ["region", "region_12"], ["patch", "patch_7"]])
    # Faces without a patch say nothing.
    t.expect(t.make("no_patch", grid),
             lambda told: t.has_sizes(told) and "patch boundary_of_fluid" in told[3] and len(told) == 4)


def equal_names(t):
    """Conditions go by the places of patches: two of one name may have different ones. The file has one region, so that
    faces between the two regions of the sample lie inside of it."""
    grid = t.merged()
    volume_cells = len(t.grid["Types"])
    patch = np.concatenate([np.full(volume_cells, -1), 2 - np.arange(len(t.boundary["Types"])) % 3])
    names = np.array(["same", "same", "other"], dtype=NAMES)
    kinds = np.array(["wall", "farfield", "symmetry"], dtype=NAMES)
    t.expect(t.make("equal", grid, cells={"patch": patch}, fields={"patch_names": names, "patch_types": kinds}),
             lambda told: sorted(line.split()[1:3] for line in told if line.startswith("patch ")) ==
             [["other", "symmetry"], ["other_interior", "interior"], ["same", "farfield"], ["same", "wall"],
              ["same_interior", "interior"], ["same_interior_", "interior"]])


def boundary_of_others(t):
    path = t.make("others", points={"global_id": t.ids}, cells={"region": t.region})
    with h5py.File(path, "r+") as file:
        file["Boundary/Inlet/Types"] = np.arange(3)
        file["Boundary/Types"] = np.zeros(4)
    t.expect(path, lambda told: t.has_sizes(told) and any("boundary_of" in line for line in told))


def corners_without_cells(t):
    """Refused by any number of ranks, wherever their shares end."""
    grid = {name: items.copy() for name, items in t.grid.items()}
    grid["Connectivity"] = np.insert(grid["Connectivity"], grid["NumberOfConnectivityIds"][0], [0, 0])
    grid["NumberOfConnectivityIds"][0] += 2
    t.refused(t.make("behind", grid, points={"global_id": t.ids}), "the last of partition 0, end at")
    last = {name: items.copy() for name, items in t.grid.items()}
    last["Connectivity"] = np.append(last["Connectivity"], [0, 0])
    last["NumberOfConnectivityIds"][-1] += 2
    t.refused(t.make("at_end", last, points={"global_id": t.ids}), "the last of partition 2, end at")
    alone = {name: np.append(items, [0] if items.ndim == 1 else np.zeros((0, 3)), axis=0) for name, items in t.grid.items()}
    alone["NumberOfConnectivityIds"][-1] = 1
    alone["Types"] = t.grid["Types"]
    t.refused(t.make("alone", alone, points={"global_id": t.ids}), "partition 3 has 1 corners, but no cells")


def too_many_regions(t):
    count = 2**20 + 1
    grid = t.single(np.eye(4, 3), np.tile([0, 1, 2, 3], count), 4 * np.arange(count + 1), np.full(count, 10))
    t.refused(t.make("regions", grid, cells={"region": np.arange(count)}), "more than 1048576 different values")


def t_names():
    return np.array(["lower layer", "upper"], dtype=NAMES)


def cells_of_other_kinds(t):
    grid = t.merged()
    corners, offsets, types = list(grid["Connectivity"]), list(grid["Offsets"]), list(grid["Types"])
    for kind, cell in ((3, [0, 1]), (1, [5]), (4, [0, 1, 2, 3]), (2, [7, 8, 9])):
        types.insert(0, kind)
        corners = cell + corners
        offsets = [0] + [o + len(cell) for o in offsets]
    t.expect(t.make("lines", t.single(grid["Points"], corners, offsets, types)), t.has_sizes)
    for kind, count, word in ((11, 8, "a voxel"), (24, 10, "higher order"), (42, 4, "a polyhedron")):
        other = t.single(grid["Points"], corners + list(range(count)), offsets + [offsets[-1] + count], types + [kind])
        t.refused(t.make(f"kind_{kind}", other), f"cell {len(types)} is", word)
    short = t.single(grid["Points"], corners + [0, 1, 2], offsets + [offsets[-1] + 3], types + [10])
    t.refused(t.make("short", short), "has 3 corners, not 4")


def ghosts(t):
    grid = {name: items.copy() for name, items in t.grid.items()}
    n, m = grid["NumberOfCells"][0], grid["Offsets"][1]
    # The first cell of the first partition once more, at its end.
    k = grid["NumberOfConnectivityIds"][0]
    grid["Connectivity"] = np.insert(grid["Connectivity"], k, grid["Connectivity"][:m])
    grid["Offsets"] = np.insert(grid["Offsets"], n + 1, k + m)
    grid["Types"] = np.insert(grid["Types"], n, grid["Types"][0])
    grid["NumberOfCells"][0] += 1
    grid["NumberOfConnectivityIds"][0] += m
    marks = np.zeros(len(grid["Types"]), dtype=np.uint8)
    marks[n] = 1
    t.expect(t.make("ghosts", grid, points={"global_id": t.ids}, cells={"vtkGhostType": marks}), t.has_sizes)


def what_is_no_mesh(t):
    t.refused(t.make("polydata", kind="PolyData"), "type PolyData; only UnstructuredGrid")
    path = t.make("steps", points={"global_id": t.ids})
    with h5py.File(path, "r+") as file:
        file.create_group("VTKHDF/Steps").attrs["NSteps"] = 3
    t.refused(path, "3 time steps")
    grid = dict(t.grid)
    del grid["Offsets"]
    t.refused(t.make("no_offsets", grid, points={"global_id": t.ids}), "no array /VTKHDF/Offsets")
    t.refused(t.make("flat", dict(t.grid, Points=t.grid["Points"].ravel()), points={"global_id": t.ids}), "/VTKHDF/Points")
    path = t.make("absurd", dict(t.grid, NumberOfCells=np.array([2**62, 2**61, 1])))
    t.refused(path, "rows")
    path = t.make("unwritten", {name: t.grid[name] for name in GRID if name != "Connectivity"})
    with h5py.File(path, "r+") as file:
        file["VTKHDF"].create_dataset("Connectivity", shape=(2**60,), dtype="i8", chunks=(1024,))
    t.refused(path, "/VTKHDF/Connectivity claims", "never written")
    path = t.make("elsewhere", {name: t.grid[name] for name in GRID if name != "Types"})
    with h5py.File(path, "r+") as file:
        file["VTKHDF"].create_dataset("Types", shape=t.grid["Types"].shape, dtype="u1",
                                      external=[(str(t.folder / "mesh.vtkhdf"), 0, len(t.grid["Types"]))])
    t.refused(path, "/VTKHDF/Types lies in other files")


def main():
    with tempfile.TemporaryDirectory() as name:
        tester = Tester(sys.argv[1], sys.argv[2], pathlib.Path(name))
        for test in (other_layouts, ids_of_points, faces_among_cells, cells_of_other_kinds, ghosts, equal_names,
                     boundary_of_others, corners_without_cells, too_many_regions, what_is_no_mesh):
            test(tester)
        print(tester.check(), "files good")


if __name__ == "__main__":
    main()
