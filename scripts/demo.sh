#!/usr/bin/env bash
# Renders the main example without display or GPU: the mirror as PVRR shows it, the exact picture, their difference, the numbers.
set -euo pipefail
cd "$(dirname "$0")/.."

scene=build/examples/door_mirror.toml
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

build/catoptra compare "$scene" -o "$work" --modes pvrr,hybrid,cubemap >"$work/table.txt"
mkdir -p out
cp "$work/pvrr.png" out/picture.png
cp "$work/raytrace.png" out/reference.png
cp "$work/error_pvrr.png" out/error.png
cp "$work/report.json" out/report.json

echo
cat "$work/table.txt"
echo
echo "The pictures and numbers of $scene:"
echo "  out/picture.png    the street in the door mirror, by per-vertex reflection"
echo "  out/reference.png  the same by exact rays"
echo "  out/error.png      the angle between the two, per pixel of the mirror"
echo "  out/report.json    the error table and times for programs"
