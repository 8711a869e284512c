#!/usr/bin/env bash
# Writes the README's pictures, docs/cell.svg, full.svg and solid.svg, and prints the rows of its table of
# counts and angles.  docs/figures.sh [PROGRAM], by default build/release/symcell.
set -euo pipefail
program=$(readlink -f "${1-$(dirname "${BASH_SOURCE[0]}")/../build/release/symcell}")
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
"$program" mesh examples/motor.json --min-angle 33 --cell cell.svg --full full.svg --quiet
solid=$(mktemp -d)
trap 'rm -r "$solid"' EXIT
"$program" mesh examples/gear.stl --cell "$solid/cell.vtu" --full "$solid/full.vtu" --quiet
./solid_picture.py picture "$solid/cell.vtu" solid.svg --full "$solid/full.vtu"

# row TEXT PART MODEL OPTIONS...: one row of the table; PART is cell or full.
row() {
  local text=$1 part=$2 model=$3 stats
  shift 3
  if stats=$("$program" mesh "examples/$model.json" "$@" --stats - --quiet 2> /dev/null); then
    /usr/bin/python3 - "$text" "$part" "$stats" << 'PYTHON'
import json, sys
text, part, stats = sys.argv[1], sys.argv[2], json.loads(sys.argv[3])
cell, full = stats["cell"], stats["full"]
count = f"{full['elements']:,}" if part == "full" else f"{cell['elements']:,} (× {stats['symmetry']['fold']} = {full['elements']:,})"
print(f"| {text} | {count} | {cell['min_angle_deg']:.1f}° | {cell['max_angle_deg']:.1f}° |")
PYTHON
  else
    echo "| $text | bound not reached | | |"
  fi
}
for job in "motor 33" "motor 35" "swirl 35"; do
  read -r model angle <<< "$job"
  row "$model, $angle°: full mesh, plain refinement" full "$model" --min-angle "$angle" --fold 1 --plain
  row "$model, $angle°: symmetry cell" cell "$model" --min-angle "$angle"
done
