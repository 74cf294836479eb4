#!/usr/bin/env bash
# host.sh FOLDER NAME: the first process of a host that cluster.py makes, in namespaces of its own. Nothing that it mounts
# is seen outside. The machine's files can be read, not written; what a host writes is in memory and its own, but for /mnt.
set -euo pipefail
folder=$1
name=$2

hostname "$name"
mount --bind "$folder/shared" /mnt
mount --bind "$folder/etc/hosts" /etc/hosts
for place in slurm munge; do
  if [ -d "/etc/$place" ]; then
    mount --bind "$folder/etc/$place" "/etc/$place"
  fi
done
for place in /tmp /dev/shm /run; do
  mount -t tmpfs "$name" "$place"
done
chmod 1777 /tmp /dev/shm
mount -o remount,bind,ro /
cd /tmp

echo ready
exec > /dev/null 2>&1
# All that daemons and jobs leave behind is this process's to collect, as it is of any first process.
while :; do
  sleep infinity &
  wait $!
done
