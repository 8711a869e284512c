#!/usr/bin/env bash
# Fails for every source file above 700 lines: it would do with two files of one purpose each.
set -euo pipefail
cd "$1"
most=700
find core api server tests \( -name '*.[ch]pp' -o -name '*.py' -o -name '*.html' \) -print0 |
  xargs -0 wc -l | awk -v most="$most" '
    $2 != "total" && $1 > most { print $2 ": " $1 " lines"; long = 1 }
    END { exit long }'
