#!/usr/bin/env python3
"""Turns a mirror so that its middle shows the eye a chosen direction: prints the scene's `rotate_deg`.

The mirror's frame is the one of `catoptra mirror make`: pole at the origin, reflecting side +z, width along x, height along y.
The normal halves the angle between the directions to the eye and to what is to be seen (law of reflection); the width stays
level. The rotation about x, then y (none), then z is what `rotate_deg` applies.

    aim_mirror.py EYE_X,Y,Z POLE_X,Y,Z AZIMUTH_DEG PITCH_DEG

Lengths in any one unit; the azimuth is that of the direction seen, counter-clockwise from +y as seen from above (180: straight
back, less: towards the left); the pitch is positive upwards.
"""
import math
import sys


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def aim(eye, pole, azimuth_deg, pitch_deg):
    """rotate_deg of the mirror, degrees."""
    azimuth, pitch = math.radians(azimuth_deg), math.radians(pitch_deg)
    seen = [-math.sin(azimuth) * math.cos(pitch), math.cos(azimuth) * math.cos(pitch), math.sin(pitch)]
    to_eye = unit([e - p for e, p in zip(eye, pole)])
    normal = unit([a + b for a, b in zip(seen, to_eye)])
    about_x = math.degrees(math.acos(normal[2]))
    about_z = math.degrees(math.atan2(normal[0], -normal[1]))
    return [about_x, 0.0, about_z]


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    eye, pole = ([float(x) for x in text.split(",")] for text in sys.argv[1:3])
    print("rotate_deg = [%s]" % ", ".join("%.3f" % a for a in aim(eye, pole, float(sys.argv[3]), float(sys.argv[4]))))
