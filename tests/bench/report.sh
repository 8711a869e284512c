#!/usr/bin/env bash
# Builds and runs the benchmarks and writes their table to docs/benchmarks.md (or to the file given).
# Takes some minutes; the figures are worth something on a machine that does nothing else.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.."
out=${1-docs/benchmarks.md}
build=${SYMCELL_BENCH_BUILD-build/bench}
cmake --preset bench -B "$build" > /dev/null
cmake --build "$build" --target symcell symcell_bench
results=$(mktemp)
trap 'rm -f "$results"' EXIT
"$build/tests/bench/symcell_bench" --benchmark_out="$results" --benchmark_out_format=json
/usr/bin/python3 tests/bench/report.py "$results" > "$out"
echo "$out"
