"""Fixtures of the Python tests: the example scenes of the build."""

import os
import pathlib

import pytest


@pytest.fixture(scope="session")
def examples() -> pathlib.Path:
    folder = pathlib.Path(os.environ["CATOPTRA_EXAMPLES"])
    assert (folder / "door_mirror.toml").is_file(), "the examples have not been built"
    return folder
