#!/usr/bin/env python3
"""Laplace's equation on an MSH file by dolfinx: values on named patches.

usage: laplace.py MESH.msh [--hot PATCH] [--cold PATCH]
"""
import argparse
import sys

import meshio
import numpy
import ufl
from dolfinx import fem
from dolfinx.io.utils import distribute_entity_data
from dolfinx.graph import create_adjacencylist
from dolfinx.mesh import create_mesh, meshtags_from_entities
from mpi4py import MPI
from petsc4py import PETSc


def read(path):
    """The tetrahedra, their boundary triangles with tags of patches, and the tags by name."""
    file = meshio.read(path)
    tags = {name: int(tag) for name, (tag, dimension) in file.field_data.items() if dimension == 2}
    cells, triangles, patches = [], [], []
    for block, physical in zip(file.cells, file.cell_data["gmsh:physical"]):
        if block.type == "tetra":
            cells.append(block.data)
        elif block.type == "triangle":
            triangles.append(block.data)
            patches.append(physical)
        else:
            sys.exit(f"{path}: the elements here are for tetrahedra, not for {block.type}")
    element = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell("tetrahedron", geometric_dimension=3), 1))
    mesh = create_mesh(MPI.COMM_WORLD, numpy.vstack(cells).astype(numpy.int64), file.points, element)
    entities, values = distribute_entity_data(mesh, 2, numpy.vstack(triangles).astype(numpy.int64),
                                              numpy.concatenate(patches).astype(numpy.int32))
    mesh.topology.create_connectivity(2, 0)
    mesh.topology.create_connectivity(2, 3)
    return mesh, meshtags_from_entities(mesh, 2, create_adjacencylist(entities), values), tags


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("mesh")
    parser.add_argument("--hot", default="fuselage")
    parser.add_argument("--cold", default="farfield")
    options = parser.parse_args()
    mesh, facets, tags = read(options.mesh)
    space = fem.FunctionSpace(mesh, ("CG", 1))
    conditions, counts = [], []
    for name, value in ((options.hot, 1.0), (options.cold, 0.0)):
        found = facets.find(tags[name])
        counts.append(len(found))
        dofs = fem.locate_dofs_topological(space, 2, found)
        conditions.append(fem.dirichletbc(PETSc.ScalarType(value), dofs, space))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    measure = ufl.Measure("ds", domain=mesh, subdomain_data=facets)
    problem = fem.petsc.LinearProblem(
        ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx,
        ufl.inner(fem.Constant(mesh, PETSc.ScalarType(0)), v) * ufl.dx, bcs=conditions,
        petsc_options={"ksp_type": "cg", "pc_type": "jacobi", "ksp_rtol": 1e-10})
    solution = problem.solve()
    values = solution.x.array.real
    volume = fem.assemble_scalar(fem.form(fem.Constant(mesh, PETSc.ScalarType(1)) * ufl.dx)).real
    area = fem.assemble_scalar(fem.form(fem.Constant(mesh, PETSc.ScalarType(1)) * measure(tags[options.hot]))).real
    cells = mesh.topology.index_map(3).size_global
    bounded = values.min() > -0.05 and values.max() < 1.05
    print(f"RESULT cells={cells} patches={len(tags)} hot_facets={counts[0]} cold_facets={counts[1]} "
          f"volume={volume:.8g} hot_area={area:.8g} least={values.min():.4g} largest={values.max():.4g} "
          f"mean={values.mean():.4g}")
    sys.exit(0 if bounded and min(counts) > 0 and numpy.ptp(values) > 0.99 else 1)


if __name__ == "__main__":
    main()
