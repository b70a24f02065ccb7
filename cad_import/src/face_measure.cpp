#include "cad_import/src/face_measure.h"

#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <GeomLib_IsPlanarSurface.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "cad_import/bspline_surface.h"
#include "cad_import/src/affine_map.h"

namespace catoptra::cad_import {
namespace {

constexpr int kLeastGrid = 16;      // samples a side for the bounds
constexpr int kMostGrid = 512;      // a terrain of 300 x 300 poles needs that many; more would take seconds
constexpr double kPlanarMm = 1e-7;  // the promise of Face::planar

/// The rectangle of parameters that the boundary spans.
struct ParameterBox {
  glm::dvec2 low{1e300}, high{-1e300};
};

/// Seeks the extreme of one coordinate near a start by a pattern search over (u, v) inside the trimming,
/// which has a margin, and inside the boundary's rectangle, which has none.
class ExtremeSearch {
 public:
  ExtremeSearch(const ExactSurface& surface, const FaceTrim& trim, const ParameterBox& box, int axis,
                double sign)
      : surface_(surface), trim_(trim), box_(box), axis_(axis), sign_(sign) {}

  glm::dvec3 run(glm::dvec2 uv, glm::dvec2 step) const {
    glm::dvec3 best = surface_.point(uv.x, uv.y);
    for (int halvings = 0; halvings < 12;) {
      bool better = false;
      for (const glm::dvec2 d : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
        const glm::dvec2 next = glm::clamp(uv + d * step, box_.low, box_.high);
        if (!trim_.contains(next.x, next.y)) continue;
        const glm::dvec3 p = surface_.point(next.x, next.y);
        if (sign_ * p[axis_] <= sign_ * best[axis_]) continue;
        best = p;
        uv = next;
        better = true;
      }
      if (better) continue;
      step *= 0.5;
      ++halvings;
    }
    return best;
  }

 private:
  const ExactSurface& surface_;
  const FaceTrim& trim_;
  const ParameterBox& box_;
  int axis_;
  double sign_;
};

/// Two samples for every span of a B-spline: each may have a bump of its own.
glm::ivec2 sample_counts(const ExactSurface& surface) {
  const BSplineSurface* spline = surface.as_bspline();
  if (!spline) return glm::ivec2(kLeastGrid);
  return {std::clamp(2 * spline->axis_u().span_count(), kLeastGrid, kMostGrid),
          std::clamp(2 * spline->axis_v().span_count(), kLeastGrid, kMostGrid)};
}

void hash_number(std::uint32_t& hash, std::int64_t value) {
  for (int byte = 0; byte < 8; ++byte) {
    hash ^= std::uint32_t(static_cast<std::uint64_t>(value) >> (8 * byte) & 0xFF);
    hash *= 16777619u;
  }
}

}  // namespace

void extend(BoundingBox& box, const glm::dvec3& point) {
  box.min = glm::min(box.min, point);
  box.max = glm::max(box.max, point);
}

void extend(BoundingBox& box, const BoundingBox& other) {
  box.min = glm::min(box.min, other.min);
  box.max = glm::max(box.max, other.max);
}

BoundingBox face_bounds(const ExactSurface& surface, const FaceTrim& trim,
                        std::span<const std::vector<glm::dvec2>> polygons) {
  BoundingBox box;
  ParameterBox uv_box;
  for (const auto& polygon : polygons)
    for (const glm::dvec2& p : polygon) {
      uv_box.low = glm::min(uv_box.low, p);
      uv_box.high = glm::max(uv_box.high, p);
      extend(box, surface.point(p.x, p.y));
    }
  if (box.empty() || surface.kind() == SurfaceKind::plane) return box;

  struct Sample {
    glm::dvec2 uv;
    glm::dvec3 point;
  };
  std::vector<Sample> samples;
  const glm::ivec2 count = sample_counts(surface);
  const glm::dvec2 step = (uv_box.high - uv_box.low) / glm::dvec2(count);
  for (int i = 0; i < count.x; ++i)
    for (int j = 0; j < count.y; ++j) {
      const glm::dvec2 uv = uv_box.low + step * (glm::dvec2(i, j) + 0.5);
      if (trim.contains(uv.x, uv.y)) samples.push_back({uv, surface.point(uv.x, uv.y)});
    }
  if (samples.empty()) return box;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      const auto best =
          std::ranges::max_element(samples, {}, [&](const Sample& s) { return sign * s.point[axis]; });
      extend(box, ExtremeSearch(surface, trim, uv_box, axis, sign).run(best->uv, step));
    }
  return box;
}

FaceMass face_mass(const TopoDS_Face& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  return {std::abs(properties.Mass()), to_glm(properties.CentreOfMass().XYZ())};
}

bool is_planar(const TopoDS_Face& face) {
  TopLoc_Location location;
  return GeomLib_IsPlanarSurface(BRep_Tool::Surface(face, location), kPlanarMm).IsPlanar();
}

std::string_view kind_name(SurfaceKind kind) {
  static constexpr std::array<std::string_view, 11> kNames{"plane",     "cylinder", "cone",    "sphere",
                                                           "torus",     "bezier",   "bspline", "revolution",
                                                           "extrusion", "offset",   "other"};
  return kNames[std::size_t(kind)];
}

// Source of the hash: Fowler, Noll and Vo, FNV-1a, 32 bit.
std::string face_id(SurfaceKind kind, const FaceMass& mass) {
  constexpr double kRounding =
      1e3;  // 1e-3 mm and mm2: far above what re-reading changes, far below a designer's step
  std::uint32_t hash = 2166136261u;
  for (const char c : kind_name(kind)) hash = (hash ^ std::uint8_t(c)) * 16777619u;
  const auto rounded = [](double value) {
    return std::isfinite(value) && std::abs(value) < 1e15 ? std::int64_t(std::llround(value * kRounding)) : 0;
  };
  for (const double value : {mass.area, mass.centre.x, mass.centre.y, mass.centre.z})
    hash_number(hash, rounded(value));
  char text[9];
  std::snprintf(text, sizeof text, "%08x", hash);
  return text;
}

}  // namespace catoptra::cad_import
