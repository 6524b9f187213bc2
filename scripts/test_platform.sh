#!/usr/bin/env bash
# Sets the package up on another platform, in a chroot, and runs its tests there. usage() says more.
set -euo pipefail

usage() {
  cat <<END
Usage: scripts/test_platform.sh PLATFORM [ARGUMENT...]

Runs scripts/test.sh on another platform, in a chroot: it installs what is missing, builds, and runs the tests.

  debian13   Debian 13, amd64
  debian11   Debian 11, amd64
  noetic     the nearest to ROS Noetic on Ubuntu 20.04: Debian 11 with GCC 9, and checks that nothing newer is used
  arm64      Debian 12 on arm64, emulated by qemu: the tests of nn, sim, expert and model, and an evaluation of shipped
             weights. amd64's cross compiler compiles.

Arguments go to ctest: scripts/test_platform.sh debian13 -R nn. What is tested is a copy of the working tree: the files
that git tracks and those that it does not ignore. Needs root, debootstrap, and a mirror of Debian, which is taken from
apt's sources; arm64 also needs qemu-user-static and binfmt-support.

The environment variable EARLY_FUSION_PLATFORMS names the folder of the chroots, which the next run uses again. The
default is ~/.cache/early_fusion/platforms. The chroots have mounts only while the script runs, and only the script sees
them.
END
}

fail() {
  echo "test_platform.sh: $1" >&2
  exit 2
}

# The nearest mirror of Debian's packages that apt knows.
mirror() {
  local found
  found=$(apt-get indextargets --format '$(REPO_URI)' 'LABEL: Debian' 2>/dev/null | sort -u | head -n 1)
  echo "${found:-http://deb.debian.org/debian}"
}

# make_chroot FOLDER SUITE ARCHITECTURE: runs debootstrap unless the chroot is there. It is this run's until the end.
make_chroot() {
  local folder=$1 suite=$2 architecture=$3 unfinished lock
  exec {lock}>"$folder.lock"
  flock --nonblock "$lock" || fail "another run uses $folder"
  [ ! -e "$folder" ] || return 0
  unfinished=$(mktemp -d "$folder.unfinished.XXXXXX")
  chmod 755 "$unfinished"
  echo "Making a chroot of $suite, $architecture: $folder"
  debootstrap --variant=minbase --arch="$architecture" "$suite" "$unfinished" "$(mirror)" >"$folder.log" 2>&1 ||
    fail "debootstrap failed; see $folder.log; $unfinished can be deleted"
  echo force-unsafe-io >"$unfinished/etc/dpkg/dpkg.cfg.d/chroot"
  mv "$unfinished" "$folder"
}

# enter FOLDER COMMAND...: runs a command in a chroot, with the variables of `environment` and no others.
enter() {
  local folder=$1
  shift
  env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive \
    CCACHE_DIR=/var/cache/ccache "${environment[@]}" chroot "$folder" "$@"
}

mount_system() {
  mount -t proc proc "$1/proc"
  mount --rbind /dev "$1/dev"
  cp --remove-destination /etc/resolv.conf "$1/etc/resolv.conf"
}

# install FOLDER PACKAGE...: unless they are installed.
install() {
  local folder=$1
  shift
  enter "$folder" dpkg -s "$@" >/dev/null 2>&1 && return
  enter "$folder" apt-get update -qq
  enter "$folder" apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

# copy_source FOLDER: the working tree -> FOLDER. The build of an earlier run stays there. Files keep their times, so
# only what changed is built again.
copy_source() {
  local folder=$1 built
  rm -rf --one-file-system "$folder.new"
  mkdir "$folder.new"
  git -C "$repository" -c safe.directory="$repository" ls-files -z --cached --others --exclude-standard |
    tar -C "$repository" --null --files-from=- --ignore-failed-read -c |
    tar -C "$folder.new" --no-same-owner -x
  for built in build devel; do
    [ ! -e "$folder/$built" ] || mv "$folder/$built" "$folder.new/"
  done
  rm -rf --one-file-system "$folder"
  mv "$folder.new" "$folder"
}

# test_amd64 SUITE ARGUMENT...: all tests. $tree is the package's folder in the chroot.
test_amd64() {
  local folder=$platforms/$1
  shift
  make_chroot "$folder" "$(basename "$folder")" amd64
  mount_system "$folder"
  environment+=(CMAKE_CXX_COMPILER_LAUNCHER=ccache)
  install "$folder" ccache "${compiler[@]}"
  copy_source "$folder/$tree"
  enter "$folder" nice "/$tree/scripts/test.sh" "$@"
}

# forbid WHAT PATTERN FILE...: fails if a file has a line that matches.
forbid() {
  local what=$1 pattern=$2
  shift 2
  if (cd "$repository" && git -c safe.directory="$repository" grep -nE "$pattern" -- "$@"); then
    fail "the lines above need $what"
  fi
}

check_noetic() {
  local headers='barrier|bit|compare|concepts|coroutine|format|latch|numbers|ranges|semaphore|source_location|span'
  forbid "a newer standard library than GCC 9's" "#include <($headers|stop_token|syncstream|version)>" '*.h' '*.cpp'
  forbid "a newer CMake than 3.16" \
    '^ *(cmake_path|cmake_language|block)\(|find_(path|library|program|file)\(.* REQUIRED' '*CMakeLists.txt' '*.cmake'
  forbid "a newer ctest than 3.16's" 'ctest.* --(test-dir|output-junit)' '*.sh' ':!scripts/test_platform.sh'
}

test_noetic() {
  check_noetic
  tree=early_fusion_noetic
  compiler=(g++-9)
  environment+=(CXX=g++-9)
  test_amd64 bullseye "$@"
}

# Mounts amd64's cross compiler and dpkg-deb in an arm64 chroot. They are much faster than emulated ones.
mount_native_programs() {
  local folder=$1 native=$2 path
  mount --bind -o ro "$native/usr/bin/dpkg-deb" "$folder/usr/bin/dpkg-deb"
  for path in lib64 usr/lib/x86_64-linux-gnu usr/lib/gcc-cross usr/aarch64-linux-gnu; do
    mkdir -p "$folder/$path"
    mount --bind -o ro "$native/$path" "$folder/$path"
  done
  mkdir -p "$folder/native"
  mount --bind -o ro "$native" "$folder/native"
}

test_arm64() {
  local folder=$platforms/bookworm-arm64 native=$platforms/bookworm
  make_chroot "$native" bookworm amd64
  make_chroot "$folder" bookworm arm64
  install "$native" g++-aarch64-linux-gnu ccache
  mount_system "$folder"
  mount_native_programs "$folder" "$native"
  environment+=(CXX=/native/usr/bin/aarch64-linux-gnu-g++ CMAKE_CXX_COMPILER_LAUNCHER=/native/usr/bin/ccache)
  copy_source "$folder/$tree"
  [ $# -gt 0 ] || set -- -R '(nn|sim|expert|model)_.*_test'
  enter "$folder" nice "/$tree/scripts/test.sh" "$@"
  enter "$folder" nice "/$tree/devel/lib/early_fusion/early_fusion" evaluate --task simple --episodes 20 \
    --policy "/$tree/models/simple.safetensors"
}

case "${1:-}" in
  --help | -h)
    usage
    exit
    ;;
  debian13 | debian11 | noetic | arm64) ;;
  "") fail "which platform? debian13, debian11, noetic or arm64; --help says more" ;;
  *) fail "unknown platform '$1'; use debian13, debian11, noetic or arm64" ;;
esac
[ "$(id -u)" -eq 0 ] || fail "needs root, for chroots and mounts"
command -v debootstrap >/dev/null || fail "needs debootstrap: apt-get install debootstrap"
if [ -z "${EARLY_FUSION_NAMESPACE:-}" ]; then
  [ "$1" != arm64 ] || [ -e /proc/sys/fs/binfmt_misc/qemu-aarch64 ] || fail "arm64 programs do not run here:
install qemu-user-static and binfmt-support, then update-binfmts --enable qemu-aarch64"
  # Mounts and processes end with the namespace, however the script ends.
  EARLY_FUSION_NAMESPACE=1 exec unshare --mount --pid --fork --kill-child --mount-proc "${BASH_SOURCE[0]}" "$@"
fi

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
platforms=${EARLY_FUSION_PLATFORMS:-$HOME/.cache/early_fusion/platforms}
mkdir -p "$platforms"
tree=early_fusion compiler=() environment=()
platform=$1
shift
case "$platform" in
  debian13) test_amd64 trixie "$@" ;;
  debian11) test_amd64 bullseye "$@" ;;
  noetic) test_noetic "$@" ;;
  arm64) test_arm64 "$@" ;;
esac
