#!/bin/bash
# Two hosts in one: two network namespaces that are joined by a veth pair, 10.77.0.1 (a) and
# 10.77.0.2 (b), with nothing else between them. Runs one command on each. With --c a third one,
# 10.77.0.3 (c), is joined to the same wire.
#
#   two_hosts.sh --profile lan|wan --a COMMAND --b COMMAND [--c COMMAND] [--cut AFTER,SECONDS]
#
# COMMAND a and c run in the background and are ended with SIGTERM when COMMAND b has ended, whose
# exit code is the script's. All find SAPHIRA_PROFILE, SAPHIRA_INTERFACE and SAPHIRA_PEERS set; in the
# wan profile b and c know the address of a alone, which is enough. --cut takes the link down AFTER
# seconds from the start of b, for so many SECONDS.
#
# Needs root (or CAP_NET_ADMIN and CAP_SYS_ADMIN) for the namespaces; exits 77 without.
set -u

profile=lan a= b= c= cut=
while [ $# -gt 0 ]; do
  case "$1" in
    --profile) profile=$2 ;;
    --a) a=$2 ;;
    --b) b=$2 ;;
    --c) c=$2 ;;
    --cut) cut=$2 ;;
    *) echo "two_hosts.sh: unknown option $1" >&2; exit 2 ;;
  esac
  shift 2 || { echo "two_hosts.sh: $1 needs a value" >&2; exit 2; }
done
if [ -z "$a" ] || [ -z "$b" ]; then
  echo "two_hosts.sh: --a and --b are needed" >&2
  exit 2
fi

others=b
[ -n "$c" ] && others="b c"
inside() {  # HOST COMMAND...: nsenter, since "ip netns exec" remounts /, which a chroot does not allow
  local host=$1
  shift
  nsenter --net=/run/netns/"saphira-$host-$$" "$@"
}
pids=()
clean_up() {
  trap - EXIT
  # Only processes that were started here: the groups of the two commands and the cutter.
  set +m
  for pid in "${pids[@]}"; do kill -TERM -- "-$pid" 2>/dev/null; done
  for pid in "${pids[@]}"; do
    for _ in $(seq 50); do kill -0 -- "-$pid" 2>/dev/null || break; sleep 0.1; done
    kill -KILL -- "-$pid" 2>/dev/null
  done
  wait 2>/dev/null
  for host in a $others; do ip netns del "saphira-$host-$$" 2>/dev/null; done
}
trap clean_up EXIT
trap 'exit 130' INT TERM

if ! command -v ip >/dev/null; then
  echo "two_hosts.sh: skipped, ip (package iproute2) is not here"
  exit 77
fi
for host in a $others; do
  if ! ip netns add "saphira-$host-$$" 2>/dev/null; then
    echo "two_hosts.sh: skipped, network namespaces need root"
    exit 77
  fi
  inside "$host" ip link set lo up
done
for host in $others; do
  [ "$host" = b ] && end=va || end=va$host
  if ! ip link add "$end" netns "saphira-a-$$" type veth peer name "v$host" netns "saphira-$host-$$" 2>/dev/null; then
    echo "two_hosts.sh: skipped, this kernel has no veth"
    exit 77
  fi
done
if [ -n "$c" ]; then
  # The wire of three: a bridge on a, whose address is the bridge's.
  if ! inside a ip link add wire type bridge 2>/dev/null; then
    echo "two_hosts.sh: skipped, this kernel has no bridge"
    exit 77
  fi
  inside a ip link set va master wire
  inside a ip link set vac master wire
  inside a ip addr add 10.77.0.1/24 dev wire
  inside a ip link set vac up
  inside a ip link set wire up
  inside c ip addr add 10.77.0.3/24 dev vc
  inside c ip link set vc up
else
  inside a ip addr add 10.77.0.1/24 dev va
fi
inside b ip addr add 10.77.0.2/24 dev vb
inside a ip link set va up
inside b ip link set vb up
# A link has a carrier a moment later; until then its address is not available.
for host in a $others; do
  for _ in $(seq 100); do
    [ "$host" = a ] && end=va || end=v$host
    inside "$host" ip link show "$end" | grep -q "state UP" && break
    sleep 0.05
  done
done

export SAPHIRA_PROFILE=$profile
set -m  # each background command is a process group of its own
peer=
[ "$profile" = wan ] && peer=10.77.0.1
begin() {  # HOST NUMBER PEERS COMMAND
  SAPHIRA_INTERFACE=10.77.0.$2 SAPHIRA_PEERS=$3 inside "$1" bash -c "$4" &
  pids+=($!)
}
begin a 1 "" "$a"
[ -n "$c" ] && begin c 3 "$peer" "$c"
begin b 2 "$peer" "$b"
b_pid=$!
if [ -n "$cut" ]; then
  (
    sleep "${cut%,*}"
    inside a ip link set va down
    echo "link down"
    sleep "${cut#*,}"
    inside a ip link set va up
    echo "link up"
  ) &
  pids+=($!)
fi
wait "$b_pid"
exit $?
