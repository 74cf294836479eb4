#!/usr/bin/python3
"""Elements at former interfaces beside the others inside, as Markdown. usage: former_interfaces.py DIRECTORY

DIRECTORY is a run's output. The borders of pieces run through the layers that were refilled where interfaces had
been; a tetrahedron counts as one at a former interface when it has a vertex of such a border. Tetrahedra with a vertex
on the surface count in neither class. Needs the system's python3-vtk9.
"""
import pathlib
import sys

import vtk


def read(reader, file):
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def main():
    folder = pathlib.Path(sys.argv[1])
    surface = read(vtk.vtkXMLPPolyDataReader(), folder / "surface.pvtp")
    on_surface = {surface.GetPoint(i) for i in range(surface.GetNumberOfPoints())}
    mesh = read(vtk.vtkXMLPUnstructuredGridReader(), folder / "mesh.pvtu")
    ids, pieces = mesh.GetPointData().GetArray("global_id"), mesh.GetCellData().GetArray("piece")
    name = [int(ids.GetValue(i)) for i in range(mesh.GetNumberOfPoints())]
    outside = {name[i] for i in range(len(name)) if mesh.GetPoint(i) in on_surface}
    corners, first, border = vtk.vtkIdList(), {}, set()
    cells = []
    for c in range(mesh.GetNumberOfCells()):
        mesh.GetCellPoints(c, corners)
        cells.append([name[corners.GetId(k)] for k in range(4)])
        for v in cells[-1]:
            if first.setdefault(v, pieces.GetValue(c)) != pieces.GetValue(c):
                border.add(v)
    classes = {"former interface": [], "other inside": []}
    ratio, angle = (mesh.GetCellData().GetArray(n) for n in ("mean_ratio", "min_dihedral"))
    for c, vertices in enumerate(cells):
        if not outside.isdisjoint(vertices):
            continue
        kind = "other inside" if border.isdisjoint(vertices) else "former interface"
        classes[kind].append((angle.GetValue(c), ratio.GetValue(c)))
    print("| elements | number | smallest angle | mean of the mean ratio |")
    print("|---|---|---|---|")
    for kind, values in classes.items():
        count = max(1, len(values))
        print(f"| {kind} | {len(values):,} | {min((v[0] for v in values), default=0):.2f} | "
              f"{sum(v[1] for v in values) / count:.4f} |")
    for title, index, width, bins in (("smallest dihedral angle, degrees", 0, 5, 15), ("mean ratio", 1, 0.05, 20)):
        print(f"\n| {title} | " + " | ".join(f"{kind}, %" for kind in classes) + " |\n|---|---|---|")
        for k in range(bins):
            share = [100 * sum(k == min(bins - 1, int(v[index] / width)) for v in values) / max(1, len(values))
                     for values in classes.values()]
            if any(share):
                print(f"| {k * width:.3g} to {(k + 1) * width:.3g} | " + " | ".join(f"{s:.2f}" for s in share) + " |")


if __name__ == "__main__":
    main()
