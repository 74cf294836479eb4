#!/usr/bin/env bash
# host_test.sh MPIRUN RANKS PROGRAM: a program that uses p4est beside our forest is not disturbed; where p4est aborts, all
# ranks end with one message of ours and the right exit code.
set -uo pipefail
mpirun=$1 ranks=$2 program=$3
failures=0

# expect WAY CODE TEXT
expect() {
  local output actual
  output=$(timeout 60 "$mpirun" "$ranks" "$program" "$1" 2>&1)
  actual=$?
  if [ "$actual" != "$2" ] || ! grep -q "$3" <<<"$output"; then
    echo "FAILED: $1: exit code $actual instead of $2, or no '$3' in:"
    echo "$output"
    failures=$((failures + 1))
  fi
}

expect before 0 ""
expect after 0 ""
expect only_sc 0 ""
expect aborts 70 "error (rank $((ranks - 1))): refining an octree: p4est has ended (Abort: a failing assertion"
expect memory 8 "error (rank $((ranks - 1))): refining an octree: out of memory"
# Nothing is said by p4est where all is well.
output=$("$mpirun" "$ranks" "$program" after 2>&1)
if [ -n "$output" ]; then
  echo "FAILED: it speaks: $output"
  failures=$((failures + 1))
fi
exit $((failures > 0))
