"""Types of the compiled part; see the package's own documentation."""

import os
from typing import Any, Callable, Literal, Sequence, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Path = str | os.PathLike[str]
_Vector = Sequence[float]
_Mode = Literal["pvrr", "hybrid", "exact", "raytrace", "cubemap"]

__version__: str

class Error(RuntimeError):
    file: str
    entity: str
    reason: str
    hint: str

class ImportError(Error): ...
class Cancelled(Error): ...

@final
class Face:
    @property
    def id(self) -> str: ...
    @property
    def index(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def body(self) -> int: ...
    @property
    def area_mm2(self) -> float: ...
    @property
    def planar(self) -> bool: ...
    @property
    def domain(self) -> tuple[float, float, float, float]: ...
    def points(self, uv: ArrayLike) -> NDArray[np.float64]: ...
    def normals(self, uv: ArrayLike) -> NDArray[np.float64]: ...
    def curvatures(self, uv: ArrayLike) -> NDArray[np.float64]: ...
    def contains(self, u: float, v: float) -> bool: ...

@final
class CadModel:
    @property
    def file(self) -> str: ...
    @property
    def format(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def faces(self) -> list[Face]: ...
    @property
    def bodies(self) -> list[dict[str, Any]]: ...
    @property
    def bounding_box_mm(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]: ...

@final
class LensEvaluation:
    @property
    def points(self) -> dict[str, NDArray[np.float64]]: ...
    @property
    def reference(self) -> dict[str, float]: ...
    @property
    def spectacle_magnification(self) -> float: ...
    @property
    def warnings(self) -> list[str]: ...
    def to_dict(self) -> dict[str, Any]: ...
    def to_csv(self) -> str: ...

@final
class Lens:
    @property
    def name(self) -> str: ...
    @property
    def material(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    def index(self, wavelength_nm: float = 587.5618) -> float: ...
    def evaluate(
        self,
        *,
        mode: Literal["lensmeter", "as-worn"] = "lensmeter",
        gaze_deg: ArrayLike | None = None,
        points_mm: ArrayLike | None = None,
        gaze_max_deg: float = 30.0,
        gaze_step_deg: float = 10.0,
        rotation_centre_mm: float = 25.0,
        vertex_distance_mm: float = 12.0,
        panto_deg: float = 0.0,
        wrap_deg: float = 0.0,
        eye: Literal["right", "left"] = "right",
        object_distance_mm: float = ...,
        wavelength_nm: float | None = None,
        cylinder: Literal["minus", "plus"] = "minus",
        threads: int = 0,
    ) -> LensEvaluation: ...
    def picture_png(self, vertex_distance_mm: float = 12.0) -> bytes: ...
    def write(self, file: _Path) -> None: ...

@final
class Picture:
    @property
    def color(self) -> NDArray[np.float32]: ...
    @property
    def srgb(self) -> NDArray[np.uint8]: ...
    @property
    def position(self) -> NDArray[np.float32] | None: ...
    @property
    def surface(self) -> NDArray[np.float32] | None: ...
    @property
    def direction(self) -> NDArray[np.float32] | None: ...
    @property
    def optic_id(self) -> NDArray[np.int32] | None: ...
    @property
    def time_ms(self) -> dict[str, float]: ...
    @property
    def rays(self) -> int: ...
    @property
    def warnings(self) -> list[str]: ...

@final
class Scene:
    def __init__(self, file: _Path) -> None: ...
    @property
    def mirrors(self) -> list[str]: ...
    @property
    def lenses(self) -> list[str]: ...
    @property
    def warnings(self) -> list[str]: ...
    def look(
        self,
        *,
        eye_mm: _Vector | None = None,
        target_mm: _Vector | None = None,
        up: _Vector | None = None,
        fov_deg: float | None = None,
    ) -> None: ...
    def render(
        self,
        *,
        mode: _Mode = "pvrr",
        resolution: tuple[int, int] | None = None,
        samples: int = 1,
        geometry: bool = False,
        threads: int = 0,
    ) -> Picture: ...

@final
class BatchPlan:
    @property
    def file(self) -> str: ...
    @property
    def repeated(self) -> int: ...
    def __len__(self) -> int: ...

@final
class BatchStore:
    def __init__(self, file: _Path) -> None: ...
    def add(self, plan: BatchPlan) -> int: ...
    def pending(self, plan: BatchPlan) -> list[str]: ...
    def put(self, line: str) -> None: ...

def load_cad(file: _Path, *, unit: str | None = None, scale: float = 1.0) -> CadModel: ...
def load_lens(
    file: _Path,
    *,
    material: str | None = None,
    index: float | None = None,
    abbe: float | None = None,
    name: str = "",
    up: _Vector | None = None,
) -> Lens: ...
def make_lens(
    *,
    sphere_d: float = 0.0,
    cylinder_d: float = 0.0,
    axis_deg: float = 0.0,
    prism_d: float = 0.0,
    prism_base_deg: float = 0.0,
    addition_d: float = 0.0,
    corridor_mm: float = 14.0,
    material: str | None = None,
    index: float | None = None,
    abbe: float | None = None,
    front_curve_d: float | None = None,
    front: Literal["sphere", "conic", "asphere", "freeform"] | None = None,
    conic: float = 0.0,
    asphere_mm: Sequence[float] = ...,
    back_conic: float = 0.0,
    center_thickness_mm: float | None = None,
    edge_thickness_mm: float | None = None,
    diameter_mm: float = 65.0,
) -> Lens: ...
def make_mirror(
    file: _Path,
    *,
    radius_mm: float = 1200.0,
    radius_h_mm: float | None = None,
    radius_v_mm: float | None = None,
    width_mm: float = 170.0,
    height_mm: float = 110.0,
    thickness_mm: float = 2.0,
    outline: Literal["rect", "rounded"] = "rect",
    corner_radius_mm: float = 20.0,
) -> None: ...
def evaluate_mirror(scene: Scene, *, mirror: str = "", rule: str = "", eye_mm: _Vector | None = None) -> dict[str, Any]: ...
def read_batch_plan(file: _Path) -> BatchPlan: ...
def evaluate_batch_case(line: str) -> str: ...
def run_batch_here(
    plan: BatchPlan,
    store: BatchStore,
    jobs: int = 0,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[int, int]: ...
