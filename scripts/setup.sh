#!/usr/bin/env bash
# Installs the missing Debian packages, then configures and builds the package in place. It can be run again: it
# installs and builds only what is missing.
#
# Usage: scripts/setup.sh [--tests | --target NAME]
#   --tests         also installs what the tests and benchmarks need, and builds them
#   --target NAME   installs the same, and builds only this target
#
# SANITIZE=address,undefined scripts/setup.sh --tests   builds with these sanitizers, in build-address-undefined/
set -euo pipefail

targets=(all)
case "${1:-}" in
  "") with_tests=OFF ;;
  --tests) with_tests=ON targets=(all tests) ;;
  --target) with_tests=ON targets=("${2:?setup.sh: --target needs a name}") ;;
  *)
    sed -n '2,10s/^# \{0,1\}//p' "$0"
    [ "$1" = --help ] || { echo "setup.sh: unknown argument '$1'" >&2; exit 2; }
    exit 0
    ;;
esac
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/build_folder.sh

libraries=(cmake g++ make pkg-config libassimp-dev libbullet-dev libdnnl-dev libeigen3-dev
  libmeshoptimizer-dev libopencv-dev libstb-dev liburdfdom-dev libxxhash-dev libyaml-cpp-dev nlohmann-json3-dev)
debian_ros=(catkin libactionlib-dev libdiagnostic-updater-dev libimage-transport-dev
  libmessage-filters-dev libnodeletlib-dev libroscpp-dev librosbag-dev librosbag-storage-dev librostest-dev libstd-srvs-dev
  libtf2-dev libtf2-msgs-dev libtf2-ros-dev libtrajectory-msgs-dev libvisualization-msgs-dev
  python3-actionlib python3-diagnostic-msgs python3-rosbag python3-sensor-msgs python3-std-srvs ros-actionlib-msgs ros-core
  ros-diagnostic-msgs ros-geometry-msgs ros-message-generation ros-robot-state-publisher ros-sensor-msgs ros-std-msgs
  ros-trajectory-msgs ros-visualization-msgs rosbash)
for_tests=(libbenchmark-dev libgtest-dev python3-matplotlib python3-pil python3-rostest)
# Debian 11 and Ubuntu 20.04 have no package of CLI11, so CMake downloads it. CMake cannot use Debian 11's libtorch, and
# its onnx was not tried.
case "$(. /etc/os-release && echo "${VERSION_CODENAME:-}")" in
  bullseye | focal) ;;
  *) libraries+=(libcli11-dev) for_tests+=(libtorch-dev python3-onnx) ;;
esac
# libFuzzer, names in the reports, and an OpenMP whose synchronisation the thread sanitizer knows.
for_sanitizers=(clang libclang-rt-dev libomp-dev llvm)

# Installs the missing ones of the given Debian packages and prints their names.
install_missing() {
  local missing=()
  for package in "$@"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ "${#missing[@]}" -gt 0 ] || return 0
  echo "Installing ${#missing[@]} packages and their dependencies: ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "setup.sh: not root, and no sudo; install these packages first" >&2; exit 1; }
    as_root=(sudo)
    echo "(with sudo, which may ask for your password)"
  fi
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" \
    >/dev/null
}

packages=("${libraries[@]}")
[ "$with_tests" = OFF ] || packages+=("${for_tests[@]}")
[ -z "${SANITIZE:-}" ] || packages+=("${for_sanitizers[@]}")
if [ -f /opt/ros/noetic/setup.sh ]; then
  echo "Using ROS from /opt/ros/noetic"
  set +u
  . /opt/ros/noetic/setup.sh
  set -u
else
  packages+=("${debian_ros[@]}")
fi
install_missing "${packages[@]}"

settings=(-DCATKIN_ENABLE_TESTING=$with_tests -DEARLY_FUSION_BENCH=$with_tests)
if [ -n "${SANITIZE:-}" ]; then
  settings=(-DCATKIN_ENABLE_TESTING=$with_tests -DCMAKE_CXX_COMPILER=clang++ "-DCATKIN_DEVEL_PREFIX=$PWD/$devel"
    "-DEARLY_FUSION_SANITIZE=$SANITIZE")
fi
# train.sh and test.sh share one build folder, so train.sh keeps the tests configured.
if [ "$with_tests" = ON ] || ! grep -qs 'CATKIN_ENABLE_TESTING:[A-Z]*=ON' "$build/CMakeCache.txt"; then
  cmake -S . -B "$build" "${settings[@]}" >"$build.log" 2>&1 || { cat "$build.log"; exit 1; }
  sed -n '/^CMake Warning/,/^$/p' "$build.log"
  rm -f "$build.log"
fi
echo "Building with $(nproc) jobs"
cmake --build "$build" -j"$(nproc)" --target "${targets[@]}" -- --no-print-directory | grep -vE '^(\[ *[0-9]+%\] Built|Consolidate|Scanning)' || true
cmake --build "$build" --target "${targets[@]}" -- --no-print-directory >/dev/null
