#!/usr/bin/env bash
# Sets everything up and runs a full training session: simulator, policy and trainer node.
#
# Usage: scripts/train.sh [name:=value ...]
#   A name is an argument of train.launch (`roslaunch --ros-args early_fusion train.launch` lists them) or a parameter of
#   trainer_node (`rosrun early_fusion trainer_node --help`). Other names are errors.
#   Example: scripts/train.sh task:=medium channels:=32 learning_rate:=1e-3
set -euo pipefail
case "${1:-}" in
  -h | --help)
    sed -n '2,7s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
esac
# Paths are relative to the caller's folder, but nodes run in another folder, so paths are made absolute.
arguments=()
for argument in "$@"; do
  case "$argument" in
    output:=* | *:=*.yaml | from:=?*) argument="${argument%%:=*}:=$(realpath -m "${argument#*:=}")" ;;
  esac
  arguments+=("$argument")
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."

SANITIZE= scripts/setup.sh
. scripts/ros_environment.sh

output="$PWD/runs/$(date +%Y%m%d-%H%M%S)"
task=simple
world=""
# Names that are not arguments of train.launch are passed to the trainer in `options`. roslaunch would ignore an unknown
# name; the trainer refuses it.
known=$(sed -n 's/.*<arg name="\([a-z_]*\)".*/\1/p' launch/train.launch)
passed=()
options=""
for argument in "${arguments[@]}"; do
  name="${argument%%:=*}"
  value="${argument#*:=}"
  case "$argument" in
    output:=*) output="$value" ;;
    task:=*) task="$value" ;;
    world:=*) world="$value" ;;
  esac
  case "$argument" in
    options:=\{\}) ;;
    options:=\{*\}) options+="${value:1:-1}, " ;;
    __*:=*) passed+=("$argument") ;;
    *:=*)
      if grep -qxF -- "$name" <<<"$known"; then
        passed+=("$argument")
      else
        options+="$name: '${value//\'/\'\'}', "
      fi
      ;;
    *) passed+=("$argument") ;;
  esac
done
[ -z "$options" ] || passed+=("options:={$options}")
port_option=()
if [ -z "${ROS_MASTER_URI:-}" ] || [ "$ROS_MASTER_URI" = http://localhost:11311 ]; then
  # Start a separate master on a free port.
  port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
  export ROS_MASTER_URI="http://127.0.0.1:$port"
  port_option=(-p "$port")
fi
cat <<TEXT
Training session in $output.
The simulator plays episodes and the policy acts in them. The trainer labels every step with an expert's action and
trains the policy in rounds. It prints one line for each round. F1 is that of the rollouts, which explore. At the end,
the policy is scored on held-out episodes. To watch the session, use another terminal:
  export ROS_MASTER_URI=$ROS_MASTER_URI ROS_IP=$ROS_IP; . $PWD/devel/setup.sh; rostopic echo /progress
TEXT
roslaunch "${port_option[@]}" early_fusion train.launch "output:=$output" "${passed[@]}"

# roslaunch exits with 0 even if its nodes failed. A result file exists only after a complete session.
[ -f "$output/result.json" ] || { echo "train.sh: the session ended without a result; see the messages above" >&2; exit 1; }
echo
echo "Trained weights: $output/weights.safetensors"
score() {
  /usr/bin/python3 - "$@" <<'PYTHON'
import json, sys
result = json.load(open(sys.argv[1]))
print("%s on %d held-out episodes of %s: F1 %.3f, precision %.3f, recall %.3f, agreement %.3f" % (sys.argv[2], *(
    result[key] for key in ("episodes", "task", "f1", "precision", "recall", "agreement"))))
PYTHON
}
score "$output/result.json" "Its score"

# For comparison: the score of the shipped policy for the same task in the same world.
episodes=$(/usr/bin/python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["episodes"])' "$output/result.json")
shipped="models/$task.safetensors"
[ -f "$shipped" ] || shipped=models/medium.safetensors  # which also does the other tasks
if [ -z "$world" ] && [ "$episodes" -gt 0 ]; then
  comparison=$(mktemp)
  trap 'rm -f "$comparison"' EXIT
  devel/lib/early_fusion/early_fusion evaluate --policy "$shipped" --task "$task" --episodes "$episodes" \
    --json "$comparison" >/dev/null
  score "$comparison" "The shipped $shipped"
fi
