#!/usr/bin/env bash
# with_sim_time.sh COMMAND...: runs a command that publishes /clock, such as `rosbag play --clock`. When it ends, it
# sets /use_sim_time to false: on a master that goes on, time would stand still for every node that is started later.
"$@" &
child=$!
trap 'kill -TERM "$child" 2>/dev/null' INT TERM
status=0
wait "$child" || status=$?
trap '' INT TERM
wait "$child" 2>/dev/null  # a signal ends the first wait before the command has ended
timeout 5 rosparam set /use_sim_time false >/dev/null 2>&1
exit "$status"
