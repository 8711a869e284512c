#!/usr/bin/env bash
# Builds everything, warnings being errors, and runs all tests. Arguments go to ctest:
#   ./test.sh -L 'unit|property|golden|replay|style'    those that take a minute
# On Debian 12 missing packages are installed first (as root or with sudo).
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
source .ci/debian_packages.sh

ensure_packages "${build_packages[@]}" "${test_packages[@]}"
build_release
exec ctest --preset release --no-tests=error --parallel "$(nproc)" "$@"
