#!/usr/bin/env bash
# setup.sh [--tests] [--cluster]: installs the Debian 12 packages that Aeroloom is built and run with, only where they are
# missing; with --tests those of the tests and checks too, with --cluster those of the tests on several hosts.
# Works as root, or as a user who may use sudo.
set -euo pipefail

packages=(
  build-essential cmake ninja-build ccache git
  libopenmpi-dev openmpi-bin
  libmetis-dev libp4est-dev libtet1.5-dev libcgal-dev libeigen3-dev
  libocct-foundation-dev libocct-modeling-data-dev libocct-modeling-algorithms-dev
  libocct-data-exchange-dev libocct-ocaf-dev libocct-visualization-dev
  libvtk9-dev libhdf5-openmpi-dev libpng-dev
  libyaml-cpp-dev libcli11-dev libfmt-dev libspdlog-dev nlohmann-json3-dev libxxhash-dev libmuparser-dev
  # the build is configured with its tests
  libgtest-dev libbenchmark-dev python3
  # what cpack asks which files are programs; the rest it needs comes with build-essential
  file
)
test_packages=(
  clang-format clang-tidy
  python3-numpy python3-vtk9
  # readers of our files that others wrote: tests compare with them
  cgns-convert gmsh openfoam python3-h5py python3-meshio
  # what checks cases by our schema
  python3-jsonschema python3-yaml
)
cluster_packages=(
  # hosts as network namespaces, and a queue on them
  iproute2 munge slurm-wlm
)
for option in "$@"; do
  case "$option" in
    --tests) packages+=("${test_packages[@]}") ;;
    --cluster) packages+=("${cluster_packages[@]}") ;;
    *)
      echo "usage: $0 [--tests] [--cluster]" >&2
      exit 2
      ;;
  esac
done

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
