# Sourced by the other scripts: the built package's environment, with ROS listening on this machine alone unless the user
# says otherwise (ROS_MASTER_URI, ROS_IP or ROS_HOSTNAME).
set +u
. "$(dirname "${BASH_SOURCE[0]}")/../devel/setup.sh"
set -u
if [ -z "${ROS_IP:-}" ] && [ -z "${ROS_HOSTNAME:-}" ]; then
  export ROS_IP=127.0.0.1
fi
