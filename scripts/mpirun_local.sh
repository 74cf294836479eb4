#!/usr/bin/env bash
# mpirun_local.sh RANKS COMMAND...: runs COMMAND on this machine, on more ranks than cores if need be.
set -euo pipefail
ranks=$1
shift
options=(--oversubscribe --bind-to none -n "$ranks")
if [ "$(id -u)" -eq 0 ]; then
  options+=(--allow-run-as-root)
fi
# Waiting ranks give their core to working ones where ranks share cores.
export OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_btl_vader_single_copy_mechanism=none
exec mpirun "${options[@]}" "$@"
