#!/usr/bin/env bash
# setup.sh: installs the Debian 12 packages Aeroloom needs, only where they are missing.
# Works as root, or as a user who may use sudo.
set -euo pipefail

packages=(
  build-essential cmake ninja-build ccache git
  libopenmpi-dev openmpi-bin
  libmetis-dev libtet1.5-dev libcgal-dev libeigen3-dev
  libocct-foundation-dev libocct-modeling-data-dev libocct-modeling-algorithms-dev
  libocct-data-exchange-dev libocct-ocaf-dev libocct-visualization-dev
  libvtk9-dev libhdf5-openmpi-dev libpng-dev
  libyaml-cpp-dev libcli11-dev libfmt-dev libspdlog-dev nlohmann-json3-dev
  libgtest-dev libbenchmark-dev clang-format clang-tidy
  python3 python3-numpy python3-vtk9 python3-jsonschema
  # readers of our files that others wrote: tests compare with them
  cgns-convert gmsh openfoam python3-h5py python3-meshio
)

missing=()
for package in "${packages[@]}"; do
  if ! dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$'; then
    missing+=("$package")
  fi
done
if [ "${#missing[@]}" -eq 0 ]; then
  echo "setup: all ${#packages[@]} packages are installed"
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  as_root=(sudo)
fi
echo "setup: installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
