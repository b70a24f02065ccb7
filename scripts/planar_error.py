#!/usr/bin/env python3
"""How far the one viewpoint of a refractor is off exact refraction: the table of docs/planar-optics.md."""
import math

DISTANCE, FACE, STEPS = 2.0, 1.0, 81  # m; square face, the ray to its middle has the angle of incidence


def refract(d, eta):
    """At the plane z = 0, from z > 0, eta = n_from / n_to; None beyond the critical angle."""
    x, y = eta * d[0], eta * d[1]
    rest = 1 - x * x - y * y
    return None if rest <= 0 else (x, y, -math.sqrt(rest))


def unit(v):
    length = math.sqrt(sum(c * c for c in v))
    return tuple(c / length for c in v)


def angle_arcmin(a, b):
    cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return math.degrees(math.atan2(math.sqrt(sum(c * c for c in cross)), sum(p * q for p, q in zip(a, b)))) * 60


def errors(degrees, eta, farther):
    a = math.radians(degrees)
    eye = (DISTANCE * math.sin(a), 0, DISTANCE * math.cos(a))
    axis = refract(unit(tuple(-c for c in eye)), eta)
    if axis is None:
        return []
    seen_from = tuple(-DISTANCE * farther * c for c in axis)
    found = []
    for i in range(STEPS):
        for j in range(STEPS):
            q = (FACE * (i / (STEPS - 1) - 0.5), FACE * (j / (STEPS - 1) - 0.5), 0)
            exact = refract(unit(tuple(p - e for p, e in zip(q, eye))), eta)
            if exact:
                found.append(angle_arcmin(unit(tuple(p - s for p, s in zip(q, seen_from))), exact))
    return sorted(found)


def cell(values):
    if not values:
        return "all reflected"
    return " / ".join(f"{values[int(share * (len(values) - 1))]:.0f}" for share in (0.5, 0.99, 1))


print("| index | incidence | eye rotated (the paper) | eye n times as far (used) |\n|---|---|---|---|")
for name, eta in (("1 to 1.33", 1 / 1.33), ("1 to 1.5", 1 / 1.5), ("1.33 to 1", 1.33), ("1.5 to 1", 1.5)):
    for degrees in (0, 15, 30, 45, 60, 75):
        print(f"| {name} | {degrees} | {cell(errors(degrees, eta, 1))} | {cell(errors(degrees, eta, 1 / eta))} |")
