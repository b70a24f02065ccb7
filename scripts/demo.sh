#!/usr/bin/env bash
# Renders the main example without display or GPU: the mirror as PVRR shows it, the exact picture, their difference, the numbers; then
# the same mirror by every mode on one sheet, and two scenes with glass and shadows.
set -euo pipefail
cd "$(dirname "$0")/.."

scene=build/examples/door_mirror.toml
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

build/catoptra compare "$scene" -o "$work" --modes pvrr,hybrid,exact,auto,cubemap >"$work/table.txt"
mkdir -p out
cp "$work/pvrr.png" out/picture.png
cp "$work/raytrace.png" out/reference.png
cp "$work/error_pvrr.png" out/error.png
cp "$work/report.json" out/report.json

# The mirror's part of each picture, with the mode's name in the font that the build has found for the signs.
font=$(sed -n 's/^CATOPTRA_SIGN_FONT:[^=]*=//p' build/CMakeCache.txt)
tiles=()
for mode in raytrace pvrr exact auto hybrid cubemap; do
  tiles+=("$work/$mode.png" --cut 820x640+300+40 --resize:filter=triangle 615x480 --fill:color=0,0,0 140x34+0+446
    --text:x=12:y=471:size=24:font="$font" "$mode")
done
oiiotool "${tiles[@]}" --mosaic:pad=6 3x2 -o out/modes.png

build/catoptra render build/examples/car_interior.toml --samples 4 -o out/car_interior.png --resolution 960,540 --log-level error
build/catoptra render build/examples/figure2.toml --samples 4 -o out/figure2.png --resolution 960,540

echo
cat "$work/table.txt"
echo
echo "The pictures and numbers of $scene:"
echo "  out/picture.png    the street in the door mirror, by per-vertex reflection"
echo "  out/reference.png  the same by exact rays"
echo "  out/error.png      the angle between the two, per pixel of the mirror"
echo "  out/report.json    the error table and times for programs"
echo "  out/modes.png      the mirror by every mode: raytrace, pvrr, exact; auto, hybrid, cubemap"
echo "Planar glass, shadows and refracted light (docs/examples.md says what is to be seen):"
echo "  out/car_interior.png  windows, a plane and a curved mirror, by build/examples/car_interior.toml"
echo "  out/figure2.png       sunlight through a refracting face, by build/examples/figure2.toml"
