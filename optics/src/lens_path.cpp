#include "optics/lens_path.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "cad_import/error.h"
#include "optics/refraction.h"
#include "optics/src/lens_side_start.h"

namespace catoptra::optics {
namespace {

// The exit's mesh lies up to its chord error inside the exact surface, and a thin lens edge may be thinner
// than that: the search for the exit starts a little before the entry point, and the exact hits decide the
// order.
constexpr double kBeforeEntry_mm = 0.05;

double sum_towards(const LensSideView& side, const glm::dvec3& eye_mm) {
  double sum = 0;
  for (const auto& triangle : side.mesh->triangles) {
    const auto& a = side.mesh->vertices[triangle.vertices[0]].position_mm;
    const auto& b = side.mesh->vertices[triangle.vertices[1]].position_mm;
    const auto& c = side.mesh->vertices[triangle.vertices[2]].position_mm;
    const glm::dvec3 to_eye = eye_mm - (a + b + c) / 3.0;
    sum += glm::dot(glm::cross(b - a, c - a), to_eye) / glm::length(to_eye);
  }
  return sum;
}

}  // namespace

LensSideView side_of(const Optic& lens, LensSide side) {
  if (side == LensSide::front) return {lens.faces, &lens.mesh};
  return {lens.back.faces, &lens.back.mesh};
}

LensSide other_side(LensSide side) {
  return side == LensSide::front ? LensSide::back : LensSide::front;
}

LensIndices lens_indices(const Optic& lens, double wavelength_nm) {
  return {lens.medium.index(wavelength_nm), lens.around.index(wavelength_nm)};
}

LensSide side_towards(const Optic& lens, const glm::dvec3& eye_mm) {
  const double front = sum_towards(side_of(lens, LensSide::front), eye_mm);
  const double back = sum_towards(side_of(lens, LensSide::back), eye_mm);
  return front >= back ? LensSide::front : LensSide::back;
}

struct LensTracer::Impl {
  // One side, and the two ways to find where a ray meets it.
  struct Side {
    LensSideView view;
    LensSideStart start;
    RayScene scene;

    explicit Side(const LensSideView& of) : view(of), start(of.faces, *of.mesh) {
      scene.add_optic(*view.mesh);
      scene.commit();
    }

    std::optional<ExactHit> hit(const Ray& ray) const {
      std::optional<ExactHit> hit = start.hit(ray);
      if (!hit) hit = exact_hit(view.faces, *view.mesh, ray, scene.intersect(ray));
      return hit;
    }
  };
  Side front, back;

  explicit Impl(const Optic& lens)
      : front(checked(lens, LensSide::front)), back(checked(lens, LensSide::back)) {}

  static LensSideView checked(const Optic& lens, LensSide side) {
    const LensSideView view = side_of(lens, side);
    if (view.faces.empty() || view.mesh->triangles.empty())
      throw Error("", lens.name, side == LensSide::front ? "has no front surface" : "has no back surface",
                  "name the faces of both sides");
    return view;
  }

  std::optional<ExactHit> hit(LensSide side, const Ray& ray) const {
    return (side == LensSide::front ? front : back).hit(ray);
  }
};

LensTracer::LensTracer(const Optic& lens) : impl_(std::make_unique<Impl>(lens)) {}
LensTracer::~LensTracer() = default;
LensTracer::LensTracer(LensTracer&&) noexcept = default;

LensPath LensTracer::trace(const Ray& ray, LensSide entered, const LensIndices& indices) const {
  const auto entry = impl_->hit(entered, ray);
  if (!entry || glm::dot(entry->normal, ray.direction) >= 0) return {};
  return trace_from(ray, *entry, entered, indices);
}

LensPath LensTracer::trace_from(const Ray& ray, const ExactHit& entry, LensSide entered,
                                const LensIndices& indices) const {
  LensPath path;
  path.entry = entry;
  // Into the lens. Normals point out of the material, so the entry's stands against the ray.
  path.end = LensPathEnd::total_reflection;
  const auto inside = refract(ray.direction, entry.normal, indices.around / indices.lens);
  if (!inside) return path;
  path.inside = *inside;

  // Across to the exact other surface.
  path.end = LensPathEnd::rim;
  const Ray within{entry.position_mm - kBeforeEntry_mm * path.inside, path.inside, 0};
  const auto exit = impl_->hit(other_side(entered), within);
  if (!exit || exit->t_mm < kBeforeEntry_mm || glm::dot(exit->normal, path.inside) <= 0) return path;
  path.exit = *exit;
  path.exit.t_mm -= kBeforeEntry_mm;

  // Out of it: here the normal points along the ray.
  path.end = LensPathEnd::total_reflection;
  const auto outside = refract(path.inside, -exit->normal, indices.lens / indices.around);
  if (!outside) return path;
  path.outside = *outside;
  path.end = LensPathEnd::passed;
  const double cos_in = -glm::dot(ray.direction, entry.normal), cos_out = glm::dot(path.inside, exit->normal);
  path.transmittance = (1 - fresnel_dielectric(cos_in, indices.around, indices.lens).unpolarised) *
                       (1 - fresnel_dielectric(cos_out, indices.lens, indices.around).unpolarised);
  return path;
}

}  // namespace catoptra::optics
