#!/usr/bin/env bash
# An operator at the console's page drives over good and bad links, with the camera on, in Chromium.
#
#   saphira bench teleop [--json] [--runs N]
#
# Exits 77 where Node, its packages or Chromium are missing.
set -u
bin=$(dirname -- "$(readlink -f -- "$0")")
export SAPHIRA_BIN_DIR=$bin
exec "${SAPHIRA_SOURCE_DIR:-$bin/../../..}/agents/console/page/test/run" bench "$bin/../agents/console/bench" "$@"
