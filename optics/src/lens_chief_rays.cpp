#include "optics/src/lens_chief_rays.h"

#include <algorithm>
#include <optional>

#include "optics/src/lens_batch_surface.h"
#include "optics/src/lens_wave_kernel.h"
#include "optics/src/trim_grid.h"

namespace catoptra::optics {
namespace {

using Kernel = void (*)(const lens_batch::WaveLens&, const lens_batch::WaveRays&);

Kernel kernel_for(SimdLevel level) {
#ifdef CATOPTRA_X86_KERNELS
  const SimdLevel lowered = std::min(level, best_simd_level());
  if (lowered == SimdLevel::avx512) return lens_batch::trace_waves_avx512;
  if (lowered == SimdLevel::avx2) return lens_batch::trace_waves_avx2;
#endif
  return lens_batch::trace_waves_scalar;
}

// One B-spline face a side.
struct Side {
  LensBatchSurface surface;
  TrimGrid trim;

  explicit Side(const cad_import::Face& face) : surface(face), trim(face) {}
};

// What the kernel reads and writes, small enough for the first-level cache.
struct Columns {
  double values[35][ChiefRays::kMost];
  std::uint8_t outcome[ChiefRays::kMost];

  static constexpr int kRay = 0, kBack = 6, kEye = 9, kObject = 12, kWave = 15, kColourF = 21, kColourC = 24,
                       kUv = 27, kUvColour = 31;

  void load(std::size_t i, const Ray& ray) {
    for (int k = 0; k < 3; ++k) {
      values[kRay + k][i] = ray.origin_mm[k];
      values[kRay + 3 + k][i] = ray.direction[k];
    }
  }
  glm::dvec3 vector(int at, std::size_t i) const {
    return {values[at][i], values[at + 1][i], values[at + 2][i]};
  }
  glm::dmat3 wave(std::size_t i) const {
    const auto w = [&](int k) { return values[kWave + k][i]; };
    return {w(0), w(1), w(2), w(1), w(3), w(4), w(2), w(4), w(5)};
  }
  lens_batch::WaveRays rays(std::size_t count) {
    lens_batch::WaveRays r;
    r.count = count;
    const auto columns = [&](auto& pointers, int at) {
      for (auto& pointer : pointers) pointer = values[at++];
    };
    columns(r.ray, kRay);
    columns(r.back, kBack);
    columns(r.eye_side, kEye);
    columns(r.object_side, kObject);
    columns(r.wave, kWave);
    columns(r.colour_f, kColourF);
    columns(r.colour_c, kColourC);
    columns(r.uv, kUv);
    columns(r.uv_colour, kUvColour);
    r.outcome = outcome;
    return r;
  }
};

}  // namespace

struct ChiefRays::Impl {
  ChiefRayTracer one_by_one;
  std::optional<Side> back, front;

  explicit Impl(const Optic& lens) : one_by_one(lens) {
    if (!LensBatchTracer::supported(lens)) return;
    back.emplace(side_of(lens, LensSide::back).faces[0]);
    front.emplace(side_of(lens, LensSide::front).faces[0]);
  }

  // Whether the kernel's path keeps within the outlines, in every colour.
  bool within(const Columns& c, std::size_t i, bool coloured) const {
    const auto& v = c.values;
    constexpr int uv = Columns::kUv, colour = Columns::kUvColour;
    if (!back->trim.contains(v[uv][i], v[uv + 1][i]) || !front->trim.contains(v[uv + 2][i], v[uv + 3][i]))
      return false;
    return !coloured || (front->trim.contains(v[colour][i], v[colour + 1][i]) &&
                         front->trim.contains(v[colour + 2][i], v[colour + 3][i]));
  }
};

ChiefRays::ChiefRays(const Optic& lens) : impl_(std::make_unique<Impl>(lens)) {}
ChiefRays::~ChiefRays() = default;
ChiefRays::ChiefRays(ChiefRays&&) noexcept = default;

const ChiefRayTracer& ChiefRays::one_by_one() const {
  return impl_->one_by_one;
}

std::vector<ChiefRay> ChiefRays::trace(std::span<const Ray> rays, const ChiefRayTask& task,
                                       SimdLevel level) const {
  std::vector<ChiefRay> result(rays.size());
  if (!impl_->back) {
    for (std::size_t i = 0; i < rays.size(); ++i) result[i] = impl_->one_by_one.trace(rays[i], task);
    return result;
  }
  const auto eta = [](const LensIndices& n) { return n.around / n.lens; };
  const lens_batch::WaveLens lens{impl_->back->surface.surface(),
                                  impl_->front->surface.surface(),
                                  eta(task.indices),
                                  1 / task.object_distance_mm,
                                  task.kind == ChiefRayKind::along_the_normal,
                                  task.coloured,
                                  eta(task.indices_f),
                                  eta(task.indices_c)};
  Columns columns;
  for (std::size_t i = 0; i < rays.size(); ++i) columns.load(i, rays[i]);
  kernel_for(level)(lens, columns.rays(rays.size()));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ChiefRay& chief = result[i];
    if (columns.outcome[i] != lens_batch::kPassed || !impl_->within(columns, i, task.coloured)) {
      chief = impl_->one_by_one.trace(rays[i], task);
      continue;
    }
    chief.end = LensPathEnd::passed;
    chief.back_mm = columns.vector(Columns::kBack, i);
    chief.eye_side = columns.vector(Columns::kEye, i);
    chief.object_side = columns.vector(Columns::kObject, i);
    chief.wave.curvature = columns.wave(i);
    chief.coloured = task.coloured;
    if (!task.coloured) continue;
    chief.object_side_f = columns.vector(Columns::kColourF, i);
    chief.object_side_c = columns.vector(Columns::kColourC, i);
  }
  return result;
}

}  // namespace catoptra::optics
