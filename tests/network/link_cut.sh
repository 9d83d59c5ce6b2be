#!/bin/bash
# The link between two hosts is cut for longer than the lease (3 s) and restored: both sides have
# lost each other and must find each other again by themselves.
#
#   link_cut.sh BIN_DIR [PROFILE]
#
# The writer sends 20 states a second. Without a recovery the reader would have some 60 of them;
# only with an early one it has 130.
set -u
bin=$1
profile=${2:-lan}
here=$(dirname "$0")
exec "$here/two_hosts.sh" --profile "$profile" --cut 3,5 \
  --a "$bin/saphira-bus-peer --role writer --hz 20" \
  --b "$bin/saphira-bus-peer --role watch --seconds 13 --count 130"
