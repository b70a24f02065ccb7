#!/usr/bin/env python3
"""What a picture costs against optic vertices, patches, scene triangles and depth: docs/costs.md and docs/images/costs.svg.

Makes its scenes in a temporary folder, times them with `catoptra bench`, and writes the table and the picture. Every figure of a row is
of one run. Needs python3-matplotlib. Let nothing else run meanwhile.
"""

import argparse
import json
import pathlib
import random
import subprocess
import tempfile

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

MODES = ["pvrr", "exact", "hybrid", "raytrace"]


def write_boxes(path, triangles, seed=1):
    """Boxes on the ground of a street behind the eye, 3 to 60 m away: 12 triangles each."""
    draw = random.Random(seed)
    lines = []
    for box in range(max(1, triangles // 12)):
        x, z = draw.uniform(-30000, 30000), draw.uniform(3000, 60000)
        half, height = draw.uniform(20, 400), draw.uniform(50, 3000)
        for corner in range(8):
            lines.append(
                f"v {x + (half if corner & 1 else -half):.1f} {-1000 + (height if corner & 2 else 0):.1f}"
                f" {z + (half if corner & 4 else -half):.1f}"
            )
        for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
            first = 8 * box + 1
            lines.append(f"f {first + a} {first + b} {first + c}")
            lines.append(f"f {first + a} {first + c} {first + d}")
    path.write_text("\n".join(lines) + "\n")


SCENE = """units = "mm"
[camera]
eye = [250, 60, 700]
target = [0, 0, 0]
up = [0, 1, 0]
fov_deg = 16
resolution = [{width}, {height}]
[[light]]
kind = "directional"
direction = [-0.4, -0.8, -0.3]
[[surrounding]]
file = "boxes.obj"
unit = "mm"
[[mirror]]
name = "door"
file = "convex.step"
{more}
[render]
{settings}
"""

# A plane mirror behind the eye, so that each shows the other.
FACING = """[[mirror]]
name = "facing"
file = "plane.step"
translate = [-40, 0, 1400]
rotate_deg = [0, 180, 0]
"""


class Bench:
    def __init__(self, catoptra, folder, arguments):
        self.catoptra, self.folder, self.arguments = catoptra, folder, arguments
        self.boxes = None
        self.run("mirror", "make", "--radius", "1200", "--width", "170", "--height", "110", "-o", folder / "convex.step")
        self.run("mirror", "make", "--radius", "0", "--width", "500", "--height", "300", "-o", folder / "plane.step")

    def run(self, *command):
        done = subprocess.run([self.catoptra, *map(str, command)], capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"catoptra {' '.join(map(str, command))}: {done.stderr.strip()}")
        return done.stdout

    def row(self, triangles=10000, more="", **settings):
        """Medians in ms by mode, and what the scene has."""
        if self.boxes != triangles:
            write_boxes(self.folder / "boxes.obj", triangles)
            self.boxes = triangles
        lines = "\n".join(f"{key} = {value}" for key, value in settings.items())
        width, height = self.arguments.resolution.split(",")
        scene = self.folder / "scene.toml"
        scene.write_text(SCENE.format(width=width, height=height, more=more, settings=lines))
        bench = json.loads(
            self.run("bench", scene, "--modes", ",".join(MODES), "--frames", self.arguments.frames, "--json", "--no-progress")
        )
        report = self.folder / "report.json"
        self.run("render", scene, "-o", self.folder / "x.png", "--mode", "pvrr", "--report", report)
        optics = json.loads(report.read_text())["optics"]
        return {
            "ms": {mode: bench["modes"][mode]["frame_ms"]["median"] for mode in MODES},
            "triangles": bench["triangles"],
            "vertices": sum(optic["vertices"] for optic in optics),
            "patches": sum(len(optic["patches"]) for optic in optics),
            "maps": json.loads(report.read_text()).get("maps", len(optics)),
            "rays": bench["modes"]["pvrr"]["rays_per_frame"],
        }


def measure(bench):
    meshes = [(3, 30), (0.3, 10), (0.03, 5), (0.01, 2), (0.003, 1), (0.001, 0.7)]
    return {
        "optic vertices": [
            ("vertices", bench.row(max_error_px=0, chord_mm=chord, angle_deg=angle, patch_fov_deg=170)) for chord, angle in meshes
        ],
        "patches": [("patches", bench.row(patch_fov_deg=degrees)) for degrees in (170, 30, 20, 14, 10)],
        "scene triangles": [("triangles", bench.row(triangles=count)) for count in (10000, 100000, 1000000)],
        "depth": [("depth", {**bench.row(more=FACING, depth=depth), "depth": depth}) for depth in (1, 2, 3, 4)],
    }


def table(rows):
    key = rows[0][0]
    lines = [f"| {key} | " + " | ".join(f"`{mode}`" for mode in MODES) + " | rays of `pvrr` | best |"]
    lines.append("|" + "---|" * (len(MODES) + 3))
    for _, row in rows:
        base = row["ms"]["raytrace"]
        best = min(MODES, key=lambda mode: row["ms"][mode])
        ratios = " | ".join(f"{row['ms'][mode] / base:.2f}" for mode in MODES)
        lines.append(f"| {row[key]} | {ratios} | {row['rays']} | `{best}` |")
    growth = " | ".join(f"{rows[-1][1]['ms'][mode] / rows[0][1]['ms'][mode]:.2f}" for mode in MODES)
    lines.append(f"| last / first | {growth} | | |")
    return "\n".join(lines)


def write_picture(series, path):
    figure, plots = pyplot.subplots(1, len(series), figsize=(14, 3.4), sharey=True)
    for plot, (name, rows) in zip(plots, series.items()):
        unit = series[name][0][1]["ms"]["raytrace"]
        for mode, marker in zip(MODES, "os^d"):
            plot.plot([row[key] for key, row in rows], [row["ms"][mode] / unit for _, row in rows], marker=marker, label=mode)
        plot.set_xlabel(name)
        plot.set_yscale("log")
        plot.grid(True, which="both", alpha=0.3)
        if name in ("optic vertices", "scene triangles"):
            plot.set_xscale("log")
    plots[0].set_ylabel("frame / first raytrace frame")
    plots[0].legend()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


TEXT = """# What a picture costs

Written by `scripts/measure_costs.py`, which makes its scenes: a door mirror of R 1200 (170 x 110 mm) that fills most of the picture, {resolution} pixels, before a street of boxes; two
cores, no GPU. Every figure is a median over {frames} frames with everything anew, divided by that of `raytrace` in the same row's run, so 0.5 is twice as fast as tracing every pixel; the last row of each table is the
growth of the mode's own time from the first row to the last. On a GPU the raster modes gain: run `catoptra bench` on yours, or let `--mode auto` find out.

![cost against vertices, patches, triangles and depth](images/costs.svg)
"""

NOTES = {
    "optic vertices": "By `chord_mm` and `angle_deg`, with `max_error_px = 0` and one patch: rays of `pvrr` are one for each vertex.",
    "patches": "By `patch_fov_deg`, with refinement to 0.5 px.",
    "scene triangles": "Of boxes 3 to 60 m behind the eye.",
    "depth": "By `render.depth`, with a plane mirror that faces the first.",
}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--catoptra", default="build/catoptra")
    parser.add_argument("--resolution", default="1280,720")
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--docs", type=pathlib.Path, default=pathlib.Path("docs"))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        series = measure(Bench(arguments.catoptra, pathlib.Path(folder), arguments))
    text = TEXT.format(resolution=arguments.resolution.replace(",", " x "), frames=arguments.frames)
    for name, rows in series.items():
        text += f"\n## {name[0].upper() + name[1:]}\n\n{NOTES[name]}\n\n{table(rows)}\n"
    (arguments.docs / "images").mkdir(parents=True, exist_ok=True)
    (arguments.docs / "costs.md").write_text(text)
    write_picture(series, arguments.docs / "images" / "costs.svg")


if __name__ == "__main__":
    main()
