"""Pictures and mirrors from Python."""

import json
import subprocess
import os

import numpy as np
import pytest

import catoptra


def test_a_picture_is_what_the_program_writes(examples, tmp_path):
    scene = catoptra.Scene(examples / "door_mirror.toml")
    assert len(scene.mirrors) == 1
    picture = scene.render(mode="raytrace", resolution=(160, 90), geometry=True)
    assert picture.color.shape == (90, 160, 3) and picture.color.dtype == np.float32
    assert picture.optic_id.shape == (90, 160) and (picture.optic_id >= 0).any() and (picture.optic_id < 0).any()
    # Reflected directions are unit vectors where the mirror shows.
    shown = picture.optic_id >= 0
    np.testing.assert_allclose(np.linalg.norm(picture.direction[shown], axis=1), 1, atol=1e-5)
    program = os.environ["CATOPTRA_PROGRAM"]
    subprocess.run([program, "render", examples / "door_mirror.toml", "-o", tmp_path / "cli.png", "--mode", "raytrace",
                    "--resolution", "160,90", "--reference-threshold", "0"], check=True)
    reference = tmp_path / "cli.png"
    from_python = tmp_path / "python.ppm"
    from_python.write_bytes(b"P6 160 90 255\n" + picture.srgb.tobytes())
    compared = subprocess.run(["idiff", "-a", "-fail", "0", from_python, reference], capture_output=True, text=True)
    assert compared.returncode == 0, compared.stdout


def test_the_camera_moves(examples):
    scene = catoptra.Scene(examples / "door_mirror.toml")
    first = scene.render(mode="raytrace", resolution=(80, 45)).srgb
    scene.look(fov_deg=12)
    second = scene.render(mode="raytrace", resolution=(80, 45)).srgb
    assert (first != second).any()


def test_pvrr_draws_without_display(examples):
    picture = catoptra.Scene(examples / "door_mirror.toml").render(mode="pvrr", resolution=(160, 90))
    assert picture.srgb.std() > 10  # not a single colour
    assert picture.position is None


def test_a_mirror_is_evaluated(examples):
    scene = catoptra.Scene(examples / "door_mirror.toml")
    report = catoptra.evaluate_mirror(scene, rule="R46-III")
    assert report["mean_radius_mm"] == pytest.approx(1200, rel=0.001)
    program = os.environ["CATOPTRA_PROGRAM"]
    said = subprocess.run([program, "mirror", "evaluate", examples / "door_mirror.toml", "--rule", "R46-III", "--json", "-"],
                          check=True, capture_output=True, text=True).stdout
    assert json.loads(said)["field"]["covered_m2"] == report["field"]["covered_m2"]


def test_unknown_modes_and_rules_are_told(examples):
    scene = catoptra.Scene(examples / "door_mirror.toml")
    with pytest.raises(ValueError, match="prvr"):
        scene.render(mode="prvr")
    with pytest.raises(catoptra.Error):
        catoptra.evaluate_mirror(scene, rule="R46-XXX")
