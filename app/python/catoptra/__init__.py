"""Catoptra: see and measure what a curved mirror or a spectacle lens does, straight from CAD, with a stated error.

    import catoptra
    lens = catoptra.make_lens(sphere_d=-4, cylinder_d=-1.5, axis_deg=20, material="CR-39")
    worn = lens.evaluate(mode="as-worn", gaze_deg=[[0, 0], [20, -10]])
    print(worn.reference, worn.points["mean_power_error_d"])

    scene = catoptra.Scene("door_mirror.toml")
    picture = scene.render(mode="hybrid", resolution=(640, 360))   # picture.srgb is a NumPy array

Lengths are in mm, angles in degrees where a name says so, powers in dioptre. Whatever goes wrong with an input raises catoptra.Error (or
ImportError below it) with the attributes file, entity, reason and hint; wrong arguments raise ValueError or TypeError.
"""

from . import batch
from ._core import (
    BatchPlan,
    BatchStore,
    CadModel,
    Cancelled,
    Error,
    Face,
    ImportError,
    Lens,
    LensEvaluation,
    Picture,
    Scene,
    __version__,
    evaluate_mirror,
    load_cad,
    load_lens,
    make_lens,
    make_mirror,
)

__all__ = [
    "BatchPlan",
    "BatchStore",
    "CadModel",
    "Cancelled",
    "Error",
    "Face",
    "ImportError",
    "Lens",
    "LensEvaluation",
    "Picture",
    "Scene",
    "__version__",
    "batch",
    "evaluate_mirror",
    "load_cad",
    "load_lens",
    "make_lens",
    "make_mirror",
]
