"""Lenses from Python against closed forms, and what goes wrong."""

import math
import threading
import time

import numpy as np
import pytest

import catoptra


def test_reads_back_its_prescription():
    lens = catoptra.make_lens(sphere_d=-4, cylinder_d=-1.5, axis_deg=20, material="CR-39")
    reference = lens.evaluate().reference
    assert reference["sphere_d"] == pytest.approx(-4, abs=0.01)
    assert reference["cylinder_d"] == pytest.approx(-1.5, abs=0.01)
    assert reference["axis_deg"] == pytest.approx(20, abs=0.5)


def test_back_vertex_power_of_a_thick_lens():
    # F'v = F1 / (1 - t/n F1) + F2; the lens is made for F'v = +7.522 with F1 = +10.25, t = 4 mm, n = 1.586: F2 comes out as -3.00.
    lens = catoptra.make_lens(sphere_d=7.522, index=1.586, front_curve_d=10.25, center_thickness_mm=4, diameter_mm=40)
    report = lens.evaluate().to_dict()
    assert report["reference"]["sphere_d"] == pytest.approx(7.522, abs=0.001)
    assert report["back_curve_d"] == pytest.approx([-3.0, -3.0], abs=0.002)


def test_the_front_is_what_the_order_needs():
    # As `lens make`: an addition needs a freeform front, whose power grows downwards.
    lens = catoptra.make_lens(sphere_d=1, addition_d=2, index=1.6)
    far, near = lens.evaluate(points_mm=[[0, 8], [0, -16]]).points["sphere_d"]
    assert near - far > 1
    with pytest.raises(ValueError, match="front must be"):
        catoptra.make_lens(sphere_d=1, index=1.5, front="square")


def test_points_are_numpy_columns_in_the_order_asked_for():
    lens = catoptra.make_lens(sphere_d=5, index=1.5)
    gaze = np.array([[0.0, 0.0], [20.0, 0.0], [0.0, -20.0]])
    points = lens.evaluate(mode="as-worn", gaze_deg=gaze).points
    np.testing.assert_allclose(points["gaze_h_deg"], gaze[:, 0], atol=1e-9)
    np.testing.assert_allclose(points["gaze_v_deg"], gaze[:, 1], atol=1e-9)
    assert points["sphere_d"].dtype == np.float64
    # A lens of revolution is as oblique to the side as below.
    assert points["mean_power_error_d"][1] == pytest.approx(points["mean_power_error_d"][2], abs=1e-6)
    # The base of a plus lens is in its middle: seen to the right of it, towards the left; seen below, up.
    assert points["prism_h"][1] < -3 and points["prism_v"][2] > 3


def test_rays_that_miss_are_nan():
    lens = catoptra.make_lens(sphere_d=-2, index=1.5, diameter_mm=40)
    points = lens.evaluate(points_mm=[[0, 0], [35, 0]]).points
    assert math.isfinite(points["sphere_d"][0]) and math.isnan(points["sphere_d"][1])


def test_written_and_loaded_again(tmp_path):
    made = catoptra.make_lens(sphere_d=2.25, material="CR-39")
    made.write(tmp_path / "lens.step")
    loaded = catoptra.load_lens(tmp_path / "lens.step", material="CR-39")
    assert loaded.evaluate().reference["sphere_d"] == pytest.approx(2.25, abs=0.01)
    assert loaded.index() == pytest.approx(1.498, abs=1e-4)


def test_faces_evaluate_arrays(tmp_path):
    catoptra.make_mirror(tmp_path / "mirror.step", radius_mm=1200)
    model = catoptra.load_cad(tmp_path / "mirror.step")
    glass = next(face for face in model.faces if face.name == "Glass")
    u0, u1, v0, v1 = glass.domain
    uv = np.random.default_rng(1).uniform([u0, v0], [u1, v1], (50, 2))
    points = glass.points(uv)
    np.testing.assert_allclose(np.linalg.norm(points + [0, 0, 1200], axis=1), 1200, atol=1e-5)
    np.testing.assert_allclose(glass.normals(uv), (points + [0, 0, 1200]) / 1200, atol=1e-6)
    np.testing.assert_allclose(glass.curvatures(uv), 1 / 1200, rtol=1e-3)


def test_errors_say_file_reason_and_hint(tmp_path):
    with pytest.raises(catoptra.ImportError) as caught:
        catoptra.load_cad(tmp_path / "absent.step")
    assert caught.value.file.endswith("absent.step") and caught.value.reason
    with pytest.raises(catoptra.Error, match="CR-39"):
        catoptra.make_lens(sphere_d=1, material="CR-38")
    with pytest.raises(ValueError, match="no default"):
        catoptra.make_lens(sphere_d=1)
    with pytest.raises(ValueError, match="abbe belongs to index"):
        catoptra.make_lens(sphere_d=1, material="CR-39", abbe=58)
    with pytest.raises(ValueError, match=r"\(N, 2\)"):
        catoptra.make_lens(sphere_d=1, index=1.5).evaluate(gaze_deg=[1.0, 2.0, 3.0])


def test_other_threads_run_while_a_lens_is_measured():
    lens = catoptra.make_lens(sphere_d=-3, index=1.6)
    ticks = 0
    running = True

    def tick():
        nonlocal ticks
        while running:
            ticks += 1
            time.sleep(0)

    thread = threading.Thread(target=tick)
    thread.start()
    before = ticks
    lens.evaluate(mode="as-worn", gaze_max_deg=35, gaze_step_deg=0.25)  # a single call, tens of thousands of points
    during = ticks - before
    running = False
    thread.join()
    assert during > 10  # a call that held the interpreter's lock would leave it at one or two
