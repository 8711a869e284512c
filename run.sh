#!/usr/bin/env bash
# Builds symcell and runs it:  ./run.sh                      the service on http://localhost:8080
#                              ./run.sh mesh MODEL --cell -  any other command
# On Debian 12 missing packages are installed first (as root or with sudo). All that is not the
# program's own output goes to standard error.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
source "$here/.ci/debian_packages.sh"

ensure_packages "${build_packages[@]}"
(cd "$here" && build_release symcell)
(($#)) || set -- serve
exec "$here/build/release/symcell" "$@"
