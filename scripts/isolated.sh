#!/usr/bin/env bash
# Runs a command in a network namespace of its own, in which nothing outside can reach a ROS node.
set -euo pipefail

usage() {
  cat <<EOF
Usage: $(basename "$0") COMMAND...

Runs a command, such as roslaunch, in a network namespace of its own. It has only the loopback interface: nodes, master
and tools that are started inside reach each other, nothing outside reaches them, and they reach nothing outside.
docs/ros.md says what listens without it. Needs unshare (util-linux) and ip (iproute2); no root.

  scripts/isolated.sh bash   a shell, from which roslaunch, rostopic and rviz can be started
EOF
}

case "${1:-}" in
  "" | --help | -h)
    usage
    [[ $# -gt 0 ]] || exit 1
    exit
    ;;
esac
for tool in unshare ip; do
  command -v "$tool" >/dev/null || PATH="$PATH:/usr/sbin:/sbin" command -v "$tool" >/dev/null || {
    echo "isolated.sh: needs $tool: install util-linux and iproute2" >&2
    exit 1
  }
done
export PATH="$PATH:/usr/sbin:/sbin" ROS_IP=127.0.0.1
[[ "${ROS_MASTER_URI:-}" =~ ^http://(127\.0\.0\.1|localhost): ]] || export ROS_MASTER_URI=http://127.0.0.1:11311
unset ROS_HOSTNAME
exec unshare --user --map-root-user --net bash -c 'ip link set lo up && exec "$@"' isolated "$@"
