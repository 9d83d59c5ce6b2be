#!/bin/bash
# The real system on two hosts: simulator and bridge on one, behaviors, intentions and the asker on
# the other. The robot drives; then the link is cut: it must stand within half a second, and drive
# on by itself to its goal when the link is back.
#
#   system.sh BIN_DIR CONFIG_DIR lan|wan
set -u
here=$(cd "$(dirname "$0")" && pwd)
if [ "${4:-}" = robot ]; then
  bin=$1 config=$2 run=$3
  "$bin/saphira-sim" --world "$config/worlds/office.wld" --robot-file "$config/robots/pioneer.p" \
    --socket "$run/robot" --trace "$run/trace.csv" --seed 1 --check "$run/check" &
  exec "$bin/saphira-bridge" --link "$run/robot" --robots "$config/robots" --state "$run/state"
fi
if [ "${4:-}" = services ]; then
  bin=$1 run=$3
  still() { tail -n 1 "$run/trace.csv" | awk -F, '{ok = $1 > 0 && $5 < 0.005 && $5 > -0.005 && $6 < 0.01 && $6 > -0.01} END {exit !ok}'; }
  moving() { [ -f "$run/trace.csv" ] && tail -n 1 "$run/trace.csv" | awk -F, '{ok = $1 + 0 > 0 && $5 + 0 > 0.15} END {exit !ok}'; }
  wait_for() {  # CONDITION TENTHS
    for _ in $(seq "$2"); do
      "$1" && return 0
      sleep 0.1
    done
    echo "waited in vain for the robot to be $1"
    return 1
  }
  "$bin/saphira-behaviors" &
  "$bin/saphira-intentions" --memory "$run/goals" &
  "$bin/saphira" goal go 2.5 0 --deadline 90 &
  goal=$!
  wait_for moving 300 || exit 1
  ip link set vb down || exit 1
  echo "link down"
  # Half a second to stand, a tenth for the trace's next line, a tenth for this loop.
  sleep 0.7
  still || { echo "the robot drives on without its services"; tail -n 8 "$run/trace.csv"; exit 1; }
  sleep 3.5  # longer than the lease: each side takes the other for dead
  still || { echo "the robot did not stay"; exit 1; }
  ip link set vb up
  echo "link up"
  wait_for moving 150 || exit 1
  wait "$goal"
  exit $?
fi

bin=$1 config=$2 profile=$3
run=$(mktemp -d) || exit 1
trap 'rm -rf "$run"' EXIT
"$here/two_hosts.sh" --profile "$profile" \
  --a "'$here/system.sh' '$bin' '$config' '$run' robot" \
  --b "'$here/system.sh' '$bin' '$config' '$run' services"
code=$?
if grep ': violation: ' "$run/check"; then
  echo "against the robots' protocol"
  exit 1
fi
exit $code
