#!/usr/bin/env bash
# clang-tidy on the sources that the last commit changed; needs a configured build/release. Of a
# change to more files than MOST only the first are looked at, and the rest is said to be left out.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

most=${MOST:-24}
if ! git rev-parse --quiet --verify HEAD~1 >/dev/null; then
  echo "clang-tidy: SKIPPED, the commit before the last one is not here" >&2
  exit 0
fi
mapfile -t changed < <(git diff --name-only --diff-filter=d HEAD~1 -- core api server | grep '\.cpp$' || true)
if ((${#changed[@]} > most)); then
  echo "clang-tidy: ${#changed[@]} files changed, the first $most are looked at" >&2
  changed=("${changed[@]:0:most}")
fi
((${#changed[@]})) || exit 0
# g++'s warnings and parameters that clang does not know are no errors here.
printf '%s\0' "${changed[@]}" | xargs -0 -n1 -P"$(nproc)" \
  clang-tidy-14 -p build/release --quiet --extra-arg=-Wno-unknown-warning-option \
  --extra-arg=-Wno-unused-command-line-argument
