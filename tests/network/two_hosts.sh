#!/bin/bash
# Two hosts in one: two network namespaces that are joined by a veth pair, 10.77.0.1 (a) and
# 10.77.0.2 (b), with nothing else between them. Runs one command on each.
#
#   two_hosts.sh --profile lan|wan --a COMMAND --b COMMAND [--cut AFTER,SECONDS]
#
# COMMAND a runs in the background and is ended with SIGTERM when COMMAND b has ended, whose exit
# code is the script's. Both find SAPHIRA_PROFILE, SAPHIRA_INTERFACE and SAPHIRA_PEERS set; in the
# wan profile only b knows the other's address, which is enough. --cut takes the link down AFTER
# seconds from the start of b, for so many SECONDS.
#
# Needs root (or CAP_NET_ADMIN and CAP_SYS_ADMIN) for the namespaces; exits 77 without.
set -u

profile=lan a= b= cut=
while [ $# -gt 0 ]; do
  case "$1" in
    --profile) profile=$2 ;;
    --a) a=$2 ;;
    --b) b=$2 ;;
    --cut) cut=$2 ;;
    *) echo "two_hosts.sh: unknown option $1" >&2; exit 2 ;;
  esac
  shift 2 || { echo "two_hosts.sh: $1 needs a value" >&2; exit 2; }
done
if [ -z "$a" ] || [ -z "$b" ]; then
  echo "two_hosts.sh: --a and --b are needed" >&2
  exit 2
fi

ns_a=saphira-a-$$
ns_b=saphira-b-$$
pids=()
clean_up() {
  trap - EXIT
  # Only what was started here: the groups of the two commands and the cutter.
  set +m
  for pid in "${pids[@]}"; do kill -TERM -- "-$pid" 2>/dev/null; done
  for pid in "${pids[@]}"; do
    for _ in $(seq 50); do kill -0 -- "-$pid" 2>/dev/null || break; sleep 0.1; done
    kill -KILL -- "-$pid" 2>/dev/null
  done
  wait 2>/dev/null
  ip netns del "$ns_a" 2>/dev/null
  ip netns del "$ns_b" 2>/dev/null
}
trap clean_up EXIT
trap 'exit 130' INT TERM

if ! command -v ip >/dev/null; then
  echo "two_hosts.sh: skipped, ip (package iproute2) is not here"
  exit 77
fi
if ! { ip netns add "$ns_a" && ip netns add "$ns_b"; } 2>/dev/null; then
  echo "two_hosts.sh: skipped, network namespaces need root"
  exit 77
fi
if ! ip link add va netns "$ns_a" type veth peer name vb netns "$ns_b" 2>/dev/null; then
  echo "two_hosts.sh: skipped, this kernel has no veth"
  exit 77
fi
# nsenter, since "ip -n" and "ip netns exec" remount /, which a chroot does not allow.
nsenter --net=/run/netns/"$ns_a" ip addr add 10.77.0.1/24 dev va
nsenter --net=/run/netns/"$ns_b" ip addr add 10.77.0.2/24 dev vb
for side in a b; do
  nsenter --net=/run/netns/"saphira-$side-$$" ip link set lo up
  nsenter --net=/run/netns/"saphira-$side-$$" ip link set "v$side" up
done
# The link has a carrier a moment later; until then its address is not to be had.
for side in a b; do
  for _ in $(seq 100); do
    nsenter --net=/run/netns/"saphira-$side-$$" ip link show "v$side" | grep -q "state UP" && break
    sleep 0.05
  done
done

export SAPHIRA_PROFILE=$profile
set -m  # each background command is a process group of its own
SAPHIRA_INTERFACE=10.77.0.1 SAPHIRA_PEERS= nsenter --net="/run/netns/$ns_a" bash -c "$a" &
pids+=($!)
peer=
[ "$profile" = wan ] && peer=10.77.0.1
SAPHIRA_INTERFACE=10.77.0.2 SAPHIRA_PEERS=$peer nsenter --net="/run/netns/$ns_b" bash -c "$b" &
b_pid=$!
pids+=("$b_pid")
if [ -n "$cut" ]; then
  (
    sleep "${cut%,*}"
    nsenter --net=/run/netns/"$ns_a" ip link set va down
    echo "link down"
    sleep "${cut#*,}"
    nsenter --net=/run/netns/"$ns_a" ip link set va up
    echo "link up"
  ) &
  pids+=($!)
fi
wait "$b_pid"
exit $?
