#!/usr/bin/env bash
# test.sh: installs what is missing, builds everything and runs the tests on 1, 2, 3 and more ranks.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh --tests
cmake --preset release > /dev/null
cmake --build --preset release
passed=0
ctest --preset release --output-junit tests.xml || passed=$?
scripts/dearest_tests.py build/release
exit "$passed"
