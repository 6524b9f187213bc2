# Sourced by the other scripts. Sets the environment of the package that is built in $devel, or in devel. Topics and
# services are for this machine only, unless the user sets ROS_IP or ROS_HOSTNAME; docs/ros.md, "Who reaches a node",
# says what listens all the same.
set +u
. "$(dirname "${BASH_SOURCE[0]}")/../${devel:-devel}/setup.sh"
set -u
if [ -z "${ROS_IP:-}" ] && [ -z "${ROS_HOSTNAME:-}" ]; then
  export ROS_IP=127.0.0.1
fi
