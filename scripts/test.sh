#!/usr/bin/env bash
# Sets everything up and runs all tests. Arguments are passed to ctest: scripts/test.sh -R nn
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/setup.sh --tests
. scripts/ros_environment.sh
ctest --test-dir build --output-on-failure "$@"
