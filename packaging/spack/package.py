"""Spack recipe of Aeroloom. Not in Spack's own repository; see docs/installing.md."""

from spack.package import *


class Aeroloom(CMakePackage):
    """From aircraft CAD to a distributed tetrahedral mesh, in parallel over MPI, the same mesh bit for bit whatever
    the number of ranks."""

    # There is no archive to fetch: `spack dev-build aeroloom@0.2.0` builds the working tree.
    license("AGPL-3.0-or-later")

    version("0.2.0")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    # Manual pages are made while installing.
    depends_on("python@3.9:", type="build")

    depends_on("mpi")
    depends_on("eigen@3.4:3")
    # From 7.8 on the libraries of data exchange have other names.
    depends_on("opencascade@7.6:7.7")
    depends_on("fmt@9:")
    depends_on("spdlog@1.10: +fmt_external")
    depends_on("nlohmann-json@3.11:")
    depends_on("libpng")
    depends_on("yaml-cpp@0.7:")
    depends_on("cli11@2.1:")
    depends_on("cgal@5.5:5")
    depends_on("vtk@9.1:9")
    depends_on("hdf5@1.10: +mpi")
    # The tetrahedra are those of this TetGen.
    depends_on("tetgen@1.5")
    depends_on("xxhash@0.8:")
    depends_on("muparser@2.3:")
    depends_on("metis@5.1:")
    # One tree has 18 levels there.
    depends_on("p4est@2.2: +mpi")
    depends_on("googletest", type="test")
    depends_on("benchmark", type="test")

    generator("ninja")

    def cmake_args(self):
        return [
            self.define("AEROLOOM_TESTS", self.run_tests),
            self.define("AEROLOOM_BENCHMARKS", self.run_tests),
        ]
