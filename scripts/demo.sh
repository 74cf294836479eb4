#!/usr/bin/env bash
# demo.sh: installs what is missing, builds, and meshes the built-in aircraft on all cores.
# Ends with the path of the file to open in ParaView.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
cmake --preset release > /dev/null
cmake --build --preset release --target aeroloom
ranks=$(nproc)
scripts/mpirun_local.sh "$ranks" build/release/bin/aeroloom run configs/transport.yaml
