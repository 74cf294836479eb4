# Third-party libraries, each linked by the one folder that may see it (docs/architecture.md).
find_package(MPI REQUIRED COMPONENTS CXX)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(OpenCASCADE REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PNG REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
if(AEROLOOM_TESTS)
  find_package(GTest REQUIRED)
endif()
if(AEROLOOM_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()
find_package(CGAL REQUIRED)
find_package(VTK REQUIRED COMPONENTS CommonCore CommonDataModel IOLegacy IOXML IOXMLParser)

# HDF5 as the MPI programs of a machine have it: a process holds one build only, and other libraries of a host
# program bring that one.
set(HDF5_PREFER_PARALLEL ON)
find_package(HDF5 REQUIRED COMPONENTS C)
if(NOT HDF5_IS_PARALLEL)
  message(FATAL_ERROR "The HDF5 found is not built with MPI: install libhdf5-openmpi-dev, or set HDF5_ROOT")
endif()

find_path(TETGEN_INCLUDE_DIR tetgen.h REQUIRED)
find_library(TETGEN_LIBRARY tet REQUIRED)
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
find_library(XXHASH_LIBRARY xxhash REQUIRED)
find_path(METIS_INCLUDE_DIR metis.h REQUIRED)
find_library(METIS_LIBRARY metis REQUIRED)

# mpirun as tests use it: more ranks than cores, also as root in a container.
set(AEROLOOM_MPIRUN ${CMAKE_SOURCE_DIR}/scripts/mpirun_local.sh)
