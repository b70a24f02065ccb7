#!/usr/bin/env bash
# Measures the validation table with the release build (or the build folder named) and writes it into the README between its markers.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build}
"$build/tests/write_validation_table" "$build/examples" "$build/validation.md"
awk 'FNR == NR { table = table $0 "\n"; next }
     /<!-- validation table: end -->/ { inside = 0 }
     !inside { print }
     /<!-- validation table: begin/ { printf "%s", table; inside = 1 }' "$build/validation.md" README.md > README.md.new
mv README.md.new README.md
