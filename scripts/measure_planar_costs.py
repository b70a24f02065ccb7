#!/usr/bin/env python3
"""What planar optics and their shadows cost: docs/planar-costs.md and docs/images/planar_costs.svg.

Times the street front of the examples (`windows_*.toml`, target `examples`) by `catoptra bench`. Every time is a ratio to the front
without optics, timed again for each number of optics; the fastest frame counts. Needs the standard library alone. Let nothing else run meanwhile.
"""

import argparse
import json
import math
import pathlib
import re
import subprocess
import tempfile

KINDS = {"mirror": ("window_mirrors", 1), "pane": ("windows", 2)}  # name of the scenes, maps of one face
COUNTS, DEPTHS = (1, 5, 10, 20), (1, 2, 3)


def formula(faces, depth):
    """Pictures at the last level: Diefenbach and Badler 1994, (5)."""
    return faces * (faces - 1) ** (depth - 1)


def unchecked_maps(kind, faces, depth):
    """Maps at all levels where nothing is looked for: every map shows every other face."""
    each = KINDS[kind][1]
    return sum(each * faces * (each * (faces - 1)) ** (level - 1) for level in range(1, depth + 1))


class Bench:
    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, pathlib.Path(folder)
        self.series, self.bare_ms = None, 0

    def scene(self, kind, faces, depth, facing=False, shadows=False):
        """A scene file of the examples, changed as asked for."""
        name = "windows_0" if faces == 0 else f"{KINDS[kind][0]}_{faces}_depth_{depth}"
        text = (self.arguments.examples / f"{name}.toml").read_text()
        text = re.sub(r'file = "', f'file = "{self.arguments.examples.resolve()}/', text)
        if shadows:
            text = text.replace("shadows = false", "shadows = true")
        if facing:  # every other window goes to the other side of the street
            windows = text.split("[[planar]]")
            windows[2::2] = [window.replace("[5280,", "[-5280,") for window in windows[2::2]]
            text = "[[planar]]".join(windows)
        path = self.folder / f"{name}.toml"
        path.write_text(text)
        return path

    def time(self, scene, checks=True):
        command = [self.arguments.catoptra, "bench", scene, "--modes", "pvrr", "--frames", self.arguments.frames]
        command += ["--resolution", self.arguments.resolution, "--json", "--no-progress"]
        if not checks:
            command.append("--no-visibility-checks")
        done = subprocess.run([*map(str, command)], capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"{scene}: {done.stderr.strip()}")
        modes = json.loads(done.stdout)["modes"]
        pvrr = modes["pvrr"]
        return {
            "ms": pvrr["frame_ms"]["min"],
            "static_ms": modes["pvrr_static"]["frame_ms"]["min"],
            "raytrace_ms": modes["raytrace"]["frame_ms"]["min"],
            "maps": sum(map_["drawn"] for map_ in pvrr["maps"]),
            "levels": [map_["level"] for map_ in pvrr["maps"]],
            "draws": sum(map_["draws"] for map_ in pvrr["maps"]),
            "pruned": pvrr["maps_pruned"],
            "shadows": pvrr["shadows"],
        }

    def row(self, kind, faces, depth, facing=False, shadows=False):
        """Costs with and without checks; the latter None where they would need too much memory."""
        series = (kind, faces, facing, shadows)
        if series != self.series:
            self.series, self.bare_ms = series, self.time(self.scene(kind, 0, depth))["ms"]
        scene = self.scene(kind, faces, depth, facing, shadows)
        with_checks = self.time(scene)
        without = None
        if not shadows and unchecked_maps(kind, faces, depth) <= self.arguments.most_maps:
            without = self.time(scene, checks=False)
        for costs in filter(None, (with_checks, without)):
            costs["deepest"] = costs["levels"].count(depth)
            for key in ("ms", "static_ms", "raytrace_ms"):
                costs[key] /= self.bare_ms
        print(kind, faces, depth, "facing" if facing else "", f"{with_checks['ms']:.2f}", flush=True)
        return {"kind": kind, "faces": faces, "depth": depth, "with": with_checks, "without": without}


def table(rows):
    lines = [
        "| optics | faces | depth | formula (5) | of the last level, unchecked | drawn, checked | pruned | draw calls | frame unchecked"
        " | frame checked | at rest | `raytrace` |",
        "|" + "---|" * 12,
    ]
    for row in rows:
        checked, without = row["with"], row["without"]
        counted, slow = (without["deepest"], f"{without['ms']:.2f}") if without else ("-", "-")
        lines.append(
            f"| {row['kind']} | {row['faces']} | {row['depth']} | {formula(row['faces'], row['depth'])} | {counted} | {checked['maps']}"
            f" | {checked['pruned']} | {checked['draws']} | {slow} | {checked['ms']:.2f} | {checked['static_ms']:.2f} | {checked['raytrace_ms']:.2f} |"
        )
    return "\n".join(lines)


def shadow_table(rows):
    lines = ["| optics | faces | depth | views | volumes | silhouette edges | edges / view | stencil draws | folds | frame | frame / that of 0 faces |", "|" + "---|" * 11]
    for row in rows:
        costs = row["with"]
        shadows = costs["shadows"]
        per_view = shadows["silhouette_edges"] / max(1, shadows["views"])
        lines.append(
            f"| {row['kind']} | {row['faces']} | {row['depth']} | {shadows['views']} | {shadows['volumes']} | {shadows['silhouette_edges']}"
            f" | {per_view:.0f} | {shadows['stencil_draws']} | {shadows['folds']} | {costs['ms']:.1f} | {costs['ms'] / rows[0]['with']['ms']:.1f} |"
        )
    return "\n".join(lines)


def svg(charts):
    """Charts side by side: title and lines, each a label, a colour, dashes and points (faces, ratio > 0); the ratio's axis is logarithmic."""
    width, height, left, top = 330, 250, 52, 34
    most = max(y for _, lines in charts for *_, points in lines for _, y in points)
    decades = max(1, math.ceil(math.log10(most)))
    total = len(charts) * (width + left + 110) + left + 20
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{total}" height="{height + top + 50}" font-family="sans-serif" font-size="12">']
    out.append('<rect width="100%" height="100%" fill="white"/>')
    for number, (title, lines) in enumerate(charts):
        x0, y0 = left + number * (width + left + 110), top + height
        place = lambda x, y: (x0 + width * x / 20, y0 - height * math.log10(max(y, 0.5) / 0.5) / (decades - math.log10(0.5)))
        out.append(f'<text x="{x0}" y="{top - 12}" font-weight="bold">{title}</text>')
        for y in [0.5] + [step * 10**k for k in range(decades) for step in (1, 2, 5)] + [10**decades]:
            _, at = place(0, y)
            out.append(f'<path d="M{x0} {at:.1f}h{width}" stroke="#ddd"/><text x="{x0 - 6}" y="{at + 4:.1f}" text-anchor="end">{y:g}</text>')
        for x in (0, 5, 10, 15, 20):
            at, _ = place(x, 1)
            out.append(f'<text x="{at:.1f}" y="{y0 + 18}" text-anchor="middle">{x}</text>')
        out.append(f'<text x="{x0 + width / 2}" y="{y0 + 38}" text-anchor="middle">planar optics</text>')
        for order, (label, colour, dashes, points) in enumerate(lines):
            path = " ".join(f"{x:.1f},{y:.1f}" for x, y in (place(*point) for point in points))
            style = f'fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="{dashes}"'
            at = top + 10 + 18 * order
            out.append(f'<polyline points="{path}" {style}/><path d="M{x0 + width + 8} {at}h22" {style}/>')
            out.append(f'<text x="{x0 + width + 34}" y="{at + 4}">{label}</text>')
    return "\n".join([*out, "</svg>"]) + "\n"


def charts_of(series):
    charts = []
    for title, rows in series.items():
        lines = []
        for depth, colour in zip(DEPTHS, ("#1b6ca8", "#d1495b", "#3a7d44")):
            for key, dashes, label in (("with", "none", "checked"), ("without", "5 4", "unchecked")):
                points = [(0, 1.0)] + [(row["faces"], row[key]["ms"]) for row in rows if row["depth"] == depth and row[key]]
                if len(points) > 1:
                    lines.append((f"depth {depth}, {label}", colour, dashes, points))
        charts.append((title, lines))
    return charts


def write_tables(path, tables):
    """Into the page, between the comments that name each; a table without rows leaves the one there."""
    text = path.read_text()
    for name, part in tables.items():
        if part.count("\n") > 1:
            text = re.sub(rf"(<!-- {name} -->\n).*?(<!-- end -->)", lambda found: f"{found[1]}{part}\n{found[2]}", text, flags=re.S)
    path.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--catoptra", default="build/catoptra")
    parser.add_argument("--examples", type=pathlib.Path, default=pathlib.Path("build/examples"))
    parser.add_argument("--resolution", default="640,360")
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--most-maps", type=int, default=105, help="unchecked maps that time and memory have room for: 3 MB each at 640 x 360")
    parser.add_argument("--shadows-alone", action="store_true", help="measure that table alone")
    parser.add_argument("--docs", type=pathlib.Path, default=pathlib.Path("docs"))
    arguments = parser.parse_args()
    rows, facing, shadows = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(arguments, folder)
        if not arguments.shadows_alone:
            rows = [bench.row(kind, faces, depth) for kind in KINDS for faces in COUNTS for depth in DEPTHS]
            facing = [bench.row(kind, faces, depth, facing=True) for kind in KINDS for faces in COUNTS[2:] for depth in DEPTHS]
        shadows = [bench.row("pane", faces, depth, shadows=True) for faces in (0, 5, 20) for depth in (1, 2) if faces or depth == 1]
    write_tables(arguments.docs / "planar-costs.md", {"one front": table(rows), "two fronts": table(facing), "shadows": shadow_table(shadows)})
    if arguments.shadows_alone:
        return
    of_kind = lambda kind, of: [row for row in of if row["kind"] == kind]
    series = {
        "mirrors, one front": of_kind("mirror", rows),
        "panes, one front": of_kind("pane", rows),
    }
    (arguments.docs / "images" / "planar_costs.svg").write_text(svg(charts_of(series)))


if __name__ == "__main__":
    main()
