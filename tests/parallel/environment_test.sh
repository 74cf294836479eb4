#!/usr/bin/env bash
# environment_test.sh MPIRUN RANKS VICTIM: however a rank ends, all ranks end, with the right exit code and message, and
# no worker server or contained run stays behind.
set -uo pipefail
mpirun=$1 ranks=$2 victim=$3
failures=0

# expect WAY CODE TEXT: CODE "failure" is any but 0.
expect() {
  local way=$1 code=$2 text=$3 output actual
  output=$(timeout 60 "$mpirun" "$ranks" "$victim" "$way" 2>&1)
  actual=$?
  if [ "$code" = failure ]; then
    [ "$actual" -ne 0 ] && [ "$actual" -ne 124 ] && actual=failure
  fi
  if [ "$actual" != "$code" ] || ! grep -q "$text" <<<"$output"; then
    echo "FAILED: $way: exit code $actual instead of $code, or no '$text' in:"
    echo "$output"
    failures=$((failures + 1))
  fi
  for _ in 1 2 3 4 5 6 7 8 9 10; do
    left=$(pgrep -f "^$victim $way\$")
    [ -z "$left" ] && return
    sleep 0.5
  done
  echo "FAILED: $way: processes stay behind:" $left
  failures=$((failures + 1))
}

expect none 0 ""
expect before 0 ""
expect throws 70 "\[rank $((ranks - 1))\] uncaught exception: an exception that throws"
expect leaves 70 "\[rank $((ranks - 1))\] an exception leaves the parallel environment"
expect aborts 5 ""
expect dies failure ""
exit $((failures > 0))
