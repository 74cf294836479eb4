#!/usr/bin/env python3
"""Compares what CMake looks for with what scripts/setup.sh, the Debian package, the Apptainer definition and the Spack
recipe name: a dependency that one of them lacks, or that CMake no longer looks for, is an error.
usage: packaging_test.py SOURCE_DIR | packaging_test.py --self-test"""
import pathlib
import re
import runpy
import shutil
import sys
import tempfile
import types

OPENCASCADE = {f"libocct-{part}-dev" for part in
               ("foundation", "modeling-data", "modeling-algorithms", "data-exchange", "ocaf", "visualization")}
# What CMake looks for: the Debian packages that have it, and the package of Spack.
DEPENDENCIES = {
    "MPI": ({"libopenmpi-dev"}, "mpi"),
    "Eigen3": ({"libeigen3-dev"}, "eigen"),
    "OpenCASCADE": (OPENCASCADE, "opencascade"),
    "fmt": ({"libfmt-dev"}, "fmt"),
    "spdlog": ({"libspdlog-dev"}, "spdlog"),
    "nlohmann_json": ({"nlohmann-json3-dev"}, "nlohmann-json"),
    "PNG": ({"libpng-dev"}, "libpng"),
    "yaml-cpp": ({"libyaml-cpp-dev"}, "yaml-cpp"),
    "CLI11": ({"libcli11-dev"}, "cli11"),
    "Python3": ({"python3"}, "python"),
    "GTest": ({"libgtest-dev"}, "googletest"),
    "benchmark": ({"libbenchmark-dev"}, "benchmark"),
    "CGAL": ({"libcgal-dev"}, "cgal"),
    "VTK": ({"libvtk9-dev"}, "vtk"),
    "HDF5": ({"libhdf5-openmpi-dev"}, "hdf5"),
    "TETGEN": ({"libtet1.5-dev"}, "tetgen"),
    "XXHASH": ({"libxxhash-dev"}, "xxhash"),
    "MUPARSER": ({"libmuparser-dev"}, "muparser"),
    "METIS": ({"libmetis-dev"}, "metis"),
    "P4EST": ({"libp4est-dev"}, "p4est"),
    "SC": ({"libp4est-dev"}, "p4est"),
}
# What is no dependency of the code.
TOOLS = {"build-essential", "cmake", "ninja-build", "ccache", "git", "file"}
SPACK_TOOLS = {"c", "cxx", "cmake", "ninja"}
# Started, not linked.
LAUNCHER = "openmpi-bin"
# What the program alone, the tests or the benchmarks are built with: others who link the stages do without.
NOT_FOR_OTHERS = {"CLI11", "Python3", "GTest", "benchmark"}


def packages_of(text):
    """The names of find_package and find_dependency in CMake's text, comments left out."""
    return set(re.findall(r"find_(?:package|dependency)\((\S+?)[\s)]", re.sub(r"#.*", "", text)))


def libraries_of(text):
    """X of find_library(X_LIBRARY ...)."""
    return set(re.findall(r"find_library\((\w+)_LIBRARY", text))


def words(text, start, end):
    """The words between two marks, comments left out."""
    inner = text.split(start, 1)[1].split(end, 1)[0]
    return set(re.sub(r"#.*", "", inner).split())


def spack_dependencies(recipe):
    """The names of depends_on in a recipe, which is run with what it uses of Spack."""
    names = set()

    def depends_on(spec, **_):
        names.add(re.match(r"[\w-]+", spec).group())

    stand_in = types.ModuleType("spack.package")
    stand_in.CMakePackage = object
    stand_in.depends_on = depends_on
    for directive in ("license", "version", "generator"):
        setattr(stand_in, directive, lambda *_, **__: None)
    sys.modules["spack"], sys.modules["spack.package"] = types.ModuleType("spack"), stand_in
    runpy.run_path(str(recipe))
    return names


def differences(where, named, wanted):
    return ([f"{where}: lacks {name}" for name in sorted(wanted - named)]
            + [f"{where}: names {name}, which nothing needs" for name in sorted(named - wanted)])


def violations(root):
    def read(name):
        return (root / name).read_text()

    searches = "\n".join(map(read, ("cmake/Dependencies.cmake", "tests/CMakeLists.txt", "benchmarks/CMakeLists.txt")))
    found = packages_of(searches) | libraries_of(searches)
    wrong = differences("this test's table", set(DEPENDENCIES), found)
    known = {name: DEPENDENCIES[name] for name in found & set(DEPENDENCIES)}

    def debian(names):
        return set().union(*(known[name][0] for name in names if name in known))

    wrong += differences("scripts/setup.sh", words(read("scripts/setup.sh"), "\npackages=(", "\n)"),
                         debian(known) | TOOLS | {LAUNCHER})
    for_others = set(known) - NOT_FOR_OTHERS
    package = read("cmake/Package.cmake")
    wrong += differences("suggestions of cmake/Package.cmake", words(package, "set(suggested", ")"),
                         debian(for_others) | {"g++", "cmake"})
    wrong += differences("cmake/Package.cmake", words(package, "set(CPACK_DEBIAN_PACKAGE_DEPENDS", ")"), {LAUNCHER})
    if "set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)" not in package:
        wrong.append("cmake/Package.cmake: linked libraries are not looked for")
    # Libraries found by find_library are linked by path, so that others need not look for them.
    wrong += differences("cmake/AeroloomConfig.cmake.in", packages_of(read("cmake/AeroloomConfig.cmake.in")),
                         for_others - libraries_of(searches))
    wrong += differences("packaging/spack/package.py", spack_dependencies(root / "packaging/spack/package.py"),
                         {spack for _, spack in known.values()} | SPACK_TOOLS)
    # The image has both lists from where they stand; a list of its own would be another to keep.
    definition = read("packaging/aeroloom.def")
    if not re.search(r"^ *scripts/setup.sh$", definition, re.MULTILINE):
        wrong.append("packaging/aeroloom.def: does not install what scripts/setup.sh names")
    installed = re.findall(r"apt-get install((?: -\S+)*) (.*)", definition)
    if [what for _, what in installed] != ["/aeroloom.deb"]:
        wrong.append("packaging/aeroloom.def: is to install the package and nothing else")
    return wrong


def self_test(root):
    """Each planted difference must be found."""
    planted = [
        ("cmake/Dependencies.cmake", "find_package(fmt", "find_package(Zstd REQUIRED)\nfind_package(fmt", "table: lacks"),
        ("cmake/Dependencies.cmake", "find_package(fmt REQUIRED)", "", "table: names fmt"),
        ("cmake/AeroloomConfig.cmake.in", "find_dependency(CGAL)", "", "AeroloomConfig.cmake.in: lacks CGAL"),
        ("cmake/Package.cmake", " libmetis-dev", "", "suggestions of cmake/Package.cmake: lacks libmetis-dev"),
        ("cmake/Package.cmake", "DEPENDS openmpi-bin", "DEPENDS", "Package.cmake: lacks openmpi-bin"),
        ("scripts/setup.sh", " libpng-dev", "", "setup.sh: lacks libpng-dev"),
        ("scripts/setup.sh", " libpng-dev", " libpng-dev libzstd-dev", "setup.sh: names libzstd-dev"),
        ("packaging/spack/package.py", 'depends_on("metis@5.1:")', "", "package.py: lacks metis"),
        ("packaging/aeroloom.def", "scripts/setup.sh\n", "true\n", "aeroloom.def: does not install"),
        ("packaging/aeroloom.def", " /aeroloom.deb\n    rm", " /aeroloom.deb libpng16-16\n    rm", "nothing else"),
    ]
    files = {name for name, *_ in planted} | {"tests/CMakeLists.txt", "benchmarks/CMakeLists.txt"}
    for name, old, new, message in planted:
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder)
            for file in files:
                (copy / file).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(root / file, copy / file)
            text = (copy / name).read_text()
            assert old in text, f"{name}: no '{old}'"
            (copy / name).write_text(text.replace(old, new, 1))
            found = violations(copy)
            assert any(message in violation for violation in found), f"missed '{message}' in {found}"


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test(pathlib.Path(__file__).resolve().parent.parent)
        return 0
    found = violations(pathlib.Path(sys.argv[1]))
    print("\n".join(found) if found else "packaging: the same dependencies everywhere")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
