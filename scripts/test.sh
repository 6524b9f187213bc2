#!/usr/bin/env bash
# Sets everything up and runs all tests, then lists those that were skipped, with reasons. Arguments go to ctest:
# scripts/test.sh -R nn
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/setup.sh --tests
. scripts/ros_environment.sh
status=0
(cd build && ctest --output-on-failure "$@") || status=$?
/usr/bin/python3 test/skipped_tests.py build/test_results/early_fusion || true
exit "$status"
