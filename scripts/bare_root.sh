#!/usr/bin/env bash
# bare_root.sh [FOLDER]: installs the Debian package in a bare Debian 12 without a compiler, meshes the built-in
# aircraft there on two ranks, checks that the mesh is that of the build tree, and makes a container image of the root.
# Needs root, mmdebstrap and a few minutes; reads what apt's sources of this machine name. FOLDER, build/bare_root
# without: keeps root/ and aeroloom.oci.tar, an OCI image for podman, docker and apptainer.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(realpath -m "${1:-build/bare_root}")
root=$folder/root
case=/usr/share/aeroloom/configs/transport.yaml

if [ "$(id -u)" -ne 0 ] || ! command -v mmdebstrap > /dev/null; then
  echo "bare_root: run as root, with mmdebstrap installed" >&2
  exit 2
fi
if [ -e "$folder" ] && [ -n "$(ls -A "$folder")" ]; then
  echo "bare_root: '$folder' is not empty" >&2
  exit 2
fi

# How this machine gets packages, for the time of the installation.
sources=()
for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
  if [ -s "$file" ]; then sources+=("$file"); fi
done

step() {
  echo "bare_root: $* (${SECONDS} s)"
}

hash_of() {
  grep '^hash: ' "$1" || { cat "$1" >&2; exit 1; }
}

# total FILE: of the sizes that dpkg knows.
total() {
  awk '{sum += $1} END {print NR " packages, " sum " KiB"}' "$1"
}

# in_root COMMAND...: as a user without rights, with the file systems that a running system has.
in_root() {
  unshare --mount --pid --fork bash -c '
    mount -t proc proc "$0/proc"
    mount -t sysfs -o ro sysfs "$0/sys"
    mount -t tmpfs tmpfs "$0/tmp"
    mkdir -p "$0/dev/shm"
    mount -t tmpfs tmpfs "$0/dev/shm"
    exec chroot --userspec=65534:65534 "$0" env -i HOME=/tmp PATH=/usr/bin:/bin "$@"' "$root" "$@"
}

# blob FILE: moves a file to where images keep it by its digest; says its size and digest.
blob() {
  local digest
  digest=$(sha256sum < "$1" | cut -d ' ' -f 1)
  mv "$1" "$image/blobs/sha256/$digest"
  echo "$(stat -c %s "$image/blobs/sha256/$digest") $digest"
}

install_package() {
  step "package"
  cmake --build --preset release --target aeroloom > /dev/null
  rm -f build/release/aeroloom_*.deb
  cpack --preset release > /dev/null
  package=$(ls build/release/aeroloom_*.deb)

  step "bare Debian 12, and the package in it"
  mkdir -p "$folder"
  apt-config dump Acquire > "$folder/apt.conf"
  cp "$package" "$folder/aeroloom.deb"
  # The apt of this machine installs into the root, so that the root needs no certificates or names of servers.
  cat > "$folder/install.sh" << 'END'
set -eu
folder=$(dirname "$0")
dpkg-query --admindir="$1/var/lib/dpkg" -W -f '${Installed-Size}\n' > "$folder/bare_sizes"
cp "$folder/aeroloom.deb" "$1/tmp/aeroloom.deb"
APT_CONFIG=$MMDEBSTRAP_APT_CONFIG apt-get install --yes -qq --no-install-recommends -o DPkg::Chroot-Directory="$1" \
  "$1/tmp/aeroloom.deb"
rm "$1/tmp/aeroloom.deb"
dpkg-query --admindir="$1/var/lib/dpkg" -W -f '${Installed-Size}\n' > "$folder/sizes"
END
  mmdebstrap --mode=root --variant=minbase --aptopt="$folder/apt.conf" --customize-hook="sh $folder/install.sh \"\$1\"" \
    bookworm "$root" "${sources[@]}" > "$folder/install.log" 2>&1 || { tail -n 20 "$folder/install.log" >&2; exit 1; }
  echo "package: $(stat -c %s "$package") bytes; a bare root has $(total "$folder/bare_sizes") installed," \
    "with the package $(total "$folder/sizes")"
  # Nothing of this machine stays.
  rm -rf "$root"/etc/apt/sources.list* "$root/etc/apt/apt.conf.d/99mmdebstrap" "$root"/var/log/*.log "$root"/var/log/apt \
    "$root/var/cache/ldconfig/aux-cache" "$folder"/{apt.conf,aeroloom.deb,install.sh,bare_sizes,sizes}
  : > "$root/etc/resolv.conf"
  if in_root sh -c 'command -v cc c++ gcc g++ cpp'; then
    echo "bare_root: there is a compiler in the root" >&2
    exit 1
  fi
}

compare_meshes() {
  step "mesh outside"
  scripts/mpirun_local.sh 2 build/release/bin/aeroloom run "configs/${case##*/}" \
    --set output.directory="$folder/outside" > "$folder/outside.log" 2>&1 || true
  step "mesh inside"
  in_root mpirun --oversubscribe -n 2 aeroloom run "$case" --set output.directory=/tmp/out > "$folder/inside.log" 2>&1 || true
  local outside inside
  outside=$(hash_of "$folder/outside.log")
  inside=$(hash_of "$folder/inside.log")
  echo "outside: $outside; inside: $inside"
  [ "$outside" = "$inside" ] || { echo "bare_root: another mesh inside" >&2; exit 1; }
}

write_image() {
  step "image"
  image=$folder/image
  mkdir -p "$image/blobs/sha256"
  local created difference size digest
  created=$(date -u -d "@${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}" +%Y-%m-%dT%H:%M:%SZ)
  tar -C "$root" --sort=name --mtime="$created" --numeric-owner --exclude='./dev/*' --exclude='./proc/*' --exclude='./sys/*' \
    -cf - . | gzip -n > "$folder/layer"
  difference=$(gzip -dc "$folder/layer" | sha256sum | cut -d ' ' -f 1)
  local version architecture
  version=$(dpkg-deb -f "$package" Version)
  architecture=$(dpkg-deb -f "$package" Architecture)
  local layer config manifest kind=application/vnd.oci.image
  read -r size digest < <(blob "$folder/layer")
  layer="{\"mediaType\": \"$kind.layer.v1.tar+gzip\", \"size\": $size, \"digest\": \"sha256:$digest\"}"

  # Open MPI refuses root without the two variables; in a container there is often nobody else.
  cat > "$folder/config" << END
{
  "created": "$created", "architecture": "$architecture", "os": "linux",
  "config": {
    "Env": ["PATH=/usr/local/bin:/usr/bin:/bin", "OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"],
    "Entrypoint": ["aeroloom"], "Cmd": ["--help"], "WorkingDir": "/work",
    "Labels": {"org.opencontainers.image.title": "aeroloom", "org.opencontainers.image.version": "$version",
      "org.opencontainers.image.licenses": "AGPL-3.0-or-later"}
  },
  "rootfs": {"type": "layers", "diff_ids": ["sha256:$difference"]},
  "history": [{"created": "$created", "created_by": "scripts/bare_root.sh"}]
}
END
  read -r size digest < <(blob "$folder/config")
  config="{\"mediaType\": \"$kind.config.v1+json\", \"size\": $size, \"digest\": \"sha256:$digest\"}"

  echo "{\"schemaVersion\": 2, \"mediaType\": \"$kind.manifest.v1+json\", \"config\": $config, \"layers\": [$layer]}" \
    > "$folder/manifest"
  read -r size digest < <(blob "$folder/manifest")
  manifest="{\"mediaType\": \"$kind.manifest.v1+json\", \"size\": $size, \"digest\": \"sha256:$digest\",
  \"annotations\": {\"org.opencontainers.image.ref.name\": \"aeroloom:$version\"}}"

  echo "{\"schemaVersion\": 2, \"mediaType\": \"$kind.index.v1+json\", \"manifests\": [$manifest]}" > "$image/index.json"
  echo '{"imageLayoutVersion": "1.0.0"}' > "$image/oci-layout"
  tar -C "$image" --sort=name --mtime="$created" --owner=0 --group=0 --numeric-owner -cf "$folder/aeroloom.oci.tar" \
    blobs index.json oci-layout
  rm -r "$image"
  step "done"
  echo "image: $folder/aeroloom.oci.tar, $(stat -c %s "$folder/aeroloom.oci.tar") bytes"
}

install_package
compare_meshes
write_image
