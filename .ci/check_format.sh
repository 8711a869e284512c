#!/usr/bin/env bash
# Fails where a C++ file is not as clang-format 14 would have it; `--fix` rewrites instead.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."
mode=(--dry-run -Werror --ferror-limit=1)
[[ ${1-} == --fix ]] && mode=(-i)
find core api server tests \( -name '*.cpp' -o -name '*.hpp' \) -print0 |
  xargs -0 --max-args=32 --max-procs="$(nproc)" clang-format-14 --style=file "${mode[@]}"
