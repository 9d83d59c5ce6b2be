#!/usr/bin/env bash
# Network addresses that come, go and change under a running robot and a laptop, which are two
# network namespaces. Measures for each case the time until each machine hears the other's programs
# again, without a manual restart, and the time of an emergency stop on the robot itself meanwhile.
#
#   saphira bench network [--profile lan|wan] [--json]
#
# Needs root for the namespaces; exits 77 without. Exit code 1: a machine was not back within 10 s, or a
# stop was not confirmed.
set -u
profiles="lan wan" json=
while [ $# -gt 0 ]; do
  case $1 in
    --profile) profiles=$2; shift ;;
    --json) json=1 ;;
    *) echo "saphira-bench-network: unknown option $1: --profile lan|wan, --json" >&2; exit 2 ;;
  esac
  shift
done
bin=$(dirname -- "$(readlink -f -- "$0")")
config=${SAPHIRA_CONFIG:-$bin/../../../config}
limit=10
command -v ip >/dev/null || { echo "skipped: ip (package iproute2) is not here"; exit 77; }
run=$(mktemp -d) || exit 3
export SAPHIRA_DOMAIN=7 SAPHIRA_SECURITY=none SAPHIRA_ROBOT=net$$
unset SAPHIRA_INTERFACE

robot=saphira-r-$$ laptop=saphira-l-$$
on() { local host=$1; shift; nsenter --net=/run/netns/"$host" "$@"; }
end_all() {
  for host in $robot $laptop; do
    pids=$(ip netns pids "$host" 2>/dev/null) && [ -n "$pids" ] && kill -KILL $pids 2>/dev/null
    ip netns del "$host" 2>/dev/null
  done
  wait 2>/dev/null
}
trap 'end_all; rm -rf "$run"' EXIT
trap 'exit 130' INT TERM
now() { date +%s.%N; }
since() { awk -v a="$1" -v b="$(now)" 'BEGIN {printf "%.2f", b - a}'; }

# until SECONDS COMMAND...: waits until the command succeeds.
until_true() {
  local begun deadline=$1
  begun=$(now)
  shift
  until "$@"; do
    awk -v s="$(since "$begun")" -v d="$deadline" 'BEGIN {exit !(s > d)}' && return 1
    sleep 0.05
  done
}
grows() { local size; size=$(stat -c %s "$1") && [ "$size" -gt "$2" ]; }

# make PROFILE [no-address]: two machines, the robot's programs, and a listener on the laptop.
make() {
  end_all
  ip netns add $robot 2>/dev/null && ip netns add $laptop || { echo "skipped: network namespaces need root"; exit 77; }
  ip link add r0 netns $robot type veth peer name l0 netns $laptop || { echo "skipped: no veth here"; exit 77; }
  for host in $robot $laptop; do on $host ip link set lo up; done
  on $laptop ip addr add 10.78.0.2/24 dev l0
  [ "${2:-}" = no-address ] || on $robot ip addr add 10.78.0.1/24 dev r0
  on $robot ip link set r0 up
  on $laptop ip link set l0 up
  export SAPHIRA_PROFILE=$1
  rm -f "$run"/*
  start_robot
  laptop_peers=
  [ "$1" = wan ] && laptop_peers=10.78.0.1
  SAPHIRA_PEERS=$laptop_peers on $laptop "$bin/saphira" echo robot/state >"$run/heard" 2>"$run/heard.log" &
}
robot_peers() { [ "$SAPHIRA_PROFILE" = wan ] && echo 10.78.0.2; }
start_bridge() {  # not by on(): $! would be the shell between, and a kill would miss the bridge
  SAPHIRA_PEERS=$(robot_peers) nsenter --net=/run/netns/$robot "$bin/saphira-bridge" --link "$run/robot" --robots "$config/robots" \
    --state "$run/state" >>"$run/bridge.log" 2>&1 &
  bridge=$!
}
start_robot() {
  on $robot "$bin/saphira-sim" --world "$config/worlds/office.wld" --robot-file "$config/robots/pioneer.p" \
    --socket "$run/robot" --seed 1 >"$run/sim.log" 2>&1 &
  start_bridge
  for service in behaviors intentions; do
    SAPHIRA_PEERS=$(robot_peers) on $robot "$bin/saphira-$service" >"$run/$service.log" 2>&1 &
  done
}

failed=0 cases=0 back_max=0 stop_max=0
larger() { awk -v a="$1" -v b="$2" 'BEGIN {print (a > b) ? a : b}'; }
say() { if [ -n "$json" ]; then echo "$*" >&2; else echo "$*"; fi; }

# back NAME: the laptop hears the robot again.
back() {
  local begun size took
  begun=$(now)
  size=$(stat -c %s "$run/heard")
  cases=$((cases + 1))
  if until_true $limit grows "$run/heard" "$size"; then
    took=$(since "$begun")
    back_max=$(larger "$back_max" "$took")
    say "$SAPHIRA_PROFILE, $1: heard again after $took s"
  else
    failed=1 back_max=$(larger "$back_max" "$limit")
    say "$SAPHIRA_PROFILE, $1: NOT heard within $limit s"
  fi
  # A program that begins on the laptop now hears it too.
  SAPHIRA_PEERS=$laptop_peers on $laptop "$bin/saphira" echo robot/state --once --timeout $limit >/dev/null 2>&1 ||
    { failed=1; say "$SAPHIRA_PROFILE, $1: a new program of the laptop does NOT hear the robot"; }
}
# stop NAME: an emergency stop from the robot's own shell, and its release.
stop() {
  local begun took
  begun=$(now)
  if SAPHIRA_PEERS=$(robot_peers) on $robot "$bin/saphira" estop >"$run/estop.log" 2>&1; then
    took=$(since "$begun")
    stop_max=$(larger "$stop_max" "$took")
    say "$SAPHIRA_PROFILE, $1: stop confirmed after $took s"
  else
    failed=1
    say "$SAPHIRA_PROFILE, $1: stop NOT confirmed: $(cat "$run/estop.log")"
  fi
  SAPHIRA_PEERS=$(robot_peers) on $robot "$bin/saphira" estop reset >/dev/null 2>&1
}
silent() { local size; size=$(stat -c %s "$run/heard"); sleep 0.5; ! grows "$run/heard" "$size"; }

for profile in $profiles; do
  make "$profile"
  back "start"
  stop "start"

  on $robot ip addr flush dev r0
  stop "address of the robot gone"
  kill -KILL $bridge && wait $bridge 2>/dev/null
  start_bridge
  until_true $limit on $robot "$bin/saphira" echo robot/state --once --timeout 1 >/dev/null 2>&1 || failed=1
  stop "address gone, bridge killed and restarted"
  on $robot ip addr add 10.78.0.1/24 dev r0
  back "same address back, bridge restarted meanwhile"

  on $robot ip addr flush dev r0
  until_true $limit silent
  on $robot ip addr add 10.78.0.7/24 dev r0
  back "robot has another address"
  stop "robot has another address"

  on $laptop ip addr flush dev l0
  until_true $limit silent
  on $laptop ip addr add 10.78.0.9/24 dev l0
  back "laptop has another address"

  on $robot ip link set r0 down
  until_true $limit silent
  stop "cable out"
  on $robot ip link set r0 up
  back "cable in"

  make "$profile" no-address
  until_true $limit on $robot "$bin/saphira" echo robot/state --once --timeout 1 >/dev/null 2>&1 || failed=1
  stop "robot started without an address"
  on $robot ip addr add 10.78.0.1/24 dev r0
  back "address came after the start"
done
[ -z "$json" ] || printf '{"cases": %d, "failed": %s, "back_s_max": %s, "estop_s_max": %s}\n' \
  "$cases" "$([ $failed -eq 0 ] && echo false || echo true)" "$back_max" "$stop_max"
exit $failed
