#!/usr/bin/env bash
# Sets everything up and runs a full training session: simulator, policy and trainer node.
#
# Usage: scripts/train.sh [name:=value ...]
#   Every argument goes to roslaunch: scripts/train.sh task:=medium channels:=32 trajectories:=4000
#   `roslaunch --ros-args early_fusion train.launch` lists them all.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case "${1:-}" in
  -h | --help)
    sed -n '2,6s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
esac

scripts/setup.sh
. scripts/ros_environment.sh

output="$PWD/runs/$(date +%Y%m%d-%H%M%S)"
for argument in "$@"; do
  case "$argument" in output:=*) output="${argument#output:=}" ;; esac
done
port_option=()
if [ -z "${ROS_MASTER_URI:-}" ] || [ "$ROS_MASTER_URI" = http://localhost:11311 ]; then
  # A master of its own, on a port that nobody listens on.
  port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
  export ROS_MASTER_URI="http://127.0.0.1:$port"
  port_option=(-p "$port")
fi
echo "Training session in $output; watch it from another terminal with"
echo "  export ROS_MASTER_URI=$ROS_MASTER_URI ROS_IP=$ROS_IP; . $PWD/devel/setup.sh; rostopic echo /progress"
roslaunch "${port_option[@]}" early_fusion train.launch "output:=$output" "$@"

# roslaunch exits with 0 whatever its nodes did: the result file tells.
[ -f "$output/result.json" ] || { echo "train.sh: the session ended without a result; see the messages above" >&2; exit 1; }
echo
echo "Trained weights: $output/weights.safetensors"
/usr/bin/python3 - "$output/result.json" <<'PYTHON'
import json, sys
result = json.load(open(sys.argv[1]))
print("Score on %d held-out episodes of %s (actions: %s): F1 %.3f, precision %.3f, recall %.3f, agreement %.3f" % tuple(
    result[key] for key in ("episodes", "task", "mode", "f1", "precision", "recall", "agreement")))
PYTHON
