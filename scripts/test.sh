#!/usr/bin/env bash
# Sets everything up and runs all tests, one more at a time than there are cores, because the tests of nodes often wait.
# Then it lists those that were skipped, with reasons. Arguments go to ctest:
#
#   scripts/test.sh -R nn
#
# With SANITIZE=address,undefined, it runs them under these sanitizers. It leaves out those that need an ordinary build,
# such as the tests of whole ROS nodes. With SANITIZE=thread, it runs the tests of what has threads. Each has a build
# folder of its own.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/build_folder.sh
case "${SANITIZE:-}" in
  "") wanted=() ;;
  thread)
    wanted=(-L threads)
    scripts/setup.sh --target thread_tests
    ;;
  *) wanted=(-LE ordinary) ;;
esac
[ "${SANITIZE:-}" = thread ] || scripts/setup.sh --tests
. scripts/ros_environment.sh
status=0
(cd "$build" && ctest -j"$(($(nproc) + 1))" --output-on-failure "${wanted[@]}" "$@") || status=$?
/usr/bin/python3 test/skipped_tests.py "$build/test_results/early_fusion" || true
exit "$status"
