#!/usr/bin/env bash
# check.sh: what the tests do not see. Format of the whole tree, lengths of files, clang-tidy on the sources of the last commit, the
# fast tests under address and undefined behaviour sanitizers, the example outside the tree against what is
# installed, and whether the Debian package finds what it depends on. Needs the build of test.sh.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh --tests

echo "check: format"
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run --Werror

echo "check: no file above 400 lines"
long=$(git ls-files '*.cpp' '*.hpp' '*.py' | xargs wc -l | awk '$1 > 400 && $2 != "total"')
[ -z "$long" ] || { echo "$long"; exit 1; }

echo "check: clang-tidy"
last=$(git rev-parse --quiet --verify HEAD~1 || git hash-object -t tree /dev/null)
mapfile -t changed < <(git diff --name-only --diff-filter=d "$last" -- '*.cpp' ':!examples')
if [ "${#changed[@]}" -gt 0 ]; then
  # The commands of this preset are those of single sources; nothing is built.
  cmake --preset developer > /dev/null
  printf '%s\0' "${changed[@]}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build/developer --quiet --warnings-as-errors='*'
fi

echo "check: sanitizers"
cmake --preset sanitize > /dev/null
cmake --build --preset sanitize --target fast_tests
# Leaks of the message passing library are not ours.
ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=halt_on_error=1 ctest --preset sanitize -L fast

echo "check: the installed package"
rm -rf build/installed build/example
cmake --install build/release --prefix "$PWD/build/installed" > /dev/null
cmake -S examples/solver -B build/example -DCMAKE_PREFIX_PATH="$PWD/build/installed" -DCMAKE_BUILD_TYPE=Release > /dev/null
cmake --build build/example
for ranks in 1 3; do
  scripts/mpirun_local.sh "$ranks" build/example/solver examples/solver/case.yaml | tee "build/example/on_$ranks"
done
# One mesh, whatever the number of ranks.
diff <(grep hash build/example/on_1) <(grep hash build/example/on_3)

echo "check: the Debian package"
rm -f build/release/aeroloom_*.deb
cpack --preset release -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip > /dev/null  # seconds, where xz takes half a minute
apt-get install --simulate --no-install-recommends -qq ./build/release/aeroloom_*.deb
