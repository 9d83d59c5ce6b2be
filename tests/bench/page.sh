#!/usr/bin/env bash
# Benchmarks of the console's page in Chromium, by the name of this script in the build.
#
#   saphira bench console [--json] [--artifacts N] [--seconds N]: the cost of three pages, and the delay from a packet to the pixels
#   saphira bench teleop [--json] [--runs N]: an operator drives over good and bad links, with the camera on
#   saphira bench soak [--json] [--minutes N]: the robot patrols before two viewers, of which one has a slow line, and a recorder
#
# Exits 77 where Node, its packages or Chromium are missing.
set -u
script=$(readlink -f -- "$0")
bin=$(dirname -- "$script") name=${script##*-}
export SAPHIRA_BIN_DIR=$bin
exec "${SAPHIRA_SOURCE_DIR:-$bin/../../..}/agents/console/page/test/run" "bench-$name" "$bin/../agents/console/bench" "$@"
