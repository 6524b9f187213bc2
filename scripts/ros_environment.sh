# Sourced by the other scripts. Sets the environment of the built package. ROS listens on this machine only, unless the
# user sets ROS_IP or ROS_HOSTNAME.
set +u
. "$(dirname "${BASH_SOURCE[0]}")/../devel/setup.sh"
set -u
if [ -z "${ROS_IP:-}" ] && [ -z "${ROS_HOSTNAME:-}" ]; then
  export ROS_IP=127.0.0.1
fi
