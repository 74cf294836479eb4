#!/usr/bin/env bash
# mpirun_local.sh RANKS COMMAND...: runs COMMAND on this machine, on more ranks than cores if need be. A single rank
# needs no launcher, and no daemon for processes that it might start; without the daemon's folder, what Open MPI keeps of
# an open file lies beside that file.
set -euo pipefail
ranks=$1
shift
# Which cards are in the machine is asked of each, which takes a tenth of a start.
export HWLOC_COMPONENTS=${HWLOC_COMPONENTS:--pci}
if [ "$ranks" -eq 1 ]; then
  export OMPI_MCA_ess_singleton_isolated=true OMPI_MCA_orte_create_session_dirs=false OMPI_MCA_sharedfp=lockedfile
  exec "$@"
fi
options=(--oversubscribe --bind-to none -n "$ranks")
if [ "$(id -u)" -eq 0 ]; then
  options+=(--allow-run-as-root)
fi
# Waiting ranks give their core to working ones where ranks share cores.
export OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_btl_vader_single_copy_mechanism=none
exec mpirun "${options[@]}" "$@"
