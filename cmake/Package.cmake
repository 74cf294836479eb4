# cpack: one Debian package of what cmake --install installs, cpack --preset release.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "Aeroloom developers")
set(CPACK_PACKAGE_CONTACT "Aeroloom developers")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGE_DESCRIPTION [[
One command meshes STEP, IGES and BREP files, in parallel over MPI, with the
same mesh bit for bit whatever the number of ranks, and writes it for VTK,
CGNS, SU2, UGRID, Gmsh, Medit and OpenFOAM.

The package holds the program, the stages as static libraries with headers
and a CMake package, manual pages, completion for bash, cases and the
documentation.]])

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
# Shared libraries are found by dpkg-shlibdeps; the launcher is not linked.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS openmpi-bin)
# What find_package(Aeroloom) looks for and what the static libraries are linked with (cmake/AeroloomConfig.cmake.in).
set(suggested
  g++ cmake libopenmpi-dev libeigen3-dev libcgal-dev libfmt-dev libspdlog-dev libpng-dev libhdf5-openmpi-dev libvtk9-dev
  libmetis-dev libp4est-dev libtet1.5-dev libxxhash-dev libmuparser-dev nlohmann-json3-dev libyaml-cpp-dev
  libocct-foundation-dev libocct-modeling-data-dev libocct-modeling-algorithms-dev
  libocct-data-exchange-dev libocct-ocaf-dev libocct-visualization-dev)
list(JOIN suggested ", " CPACK_DEBIAN_PACKAGE_SUGGESTS)
include(CPack)
