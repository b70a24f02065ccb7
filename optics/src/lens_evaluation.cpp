#include "optics/lens_evaluation.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

#include "cad_import/error.h"
#include "optics/src/lens_chief_ray.h"
#include "optics/src/lens_wearing.h"

namespace catoptra::optics {
namespace {

constexpr double kLineF_nm = 486.13, kLineC_nm = 656.27;  // ISO 7944
constexpr double kPupilBehindCornea_mm = 3;               // facts: entrance pupil of the eye
// Below it the reference counts as a sphere: a twentieth of the narrowest tolerance of a cylinder (0.09 D),
// and above what a B-spline within 1e-7 mm of a sphere has.
constexpr double kNoCylinder_d = 0.005;

void check(bool good, const char* what, const char* reason, const char* hint) {
  if (!good) throw Error("", what, reason, hint);
}

void check_options(const EvaluationOptions& o) {
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  check(positive(o.position.rotation_centre_mm), "rotation centre", "is not a distance above 0 mm",
        "it lies 25 to 27 mm behind the back vertex");
  check(positive(o.position.vertex_distance_mm), "vertex distance", "is not a distance above 0 mm",
        "12 to 14 mm are usual");
  check(std::abs(o.position.pantoscopic_rad) < 1, "pantoscopic angle", "is not within 57 degrees",
        "8 degrees are usual");
  check(std::abs(o.position.wrap_rad) < 1, "wrap angle", "is not within 57 degrees", "5 degrees are usual");
  check(o.object_distance_mm > 0, "object distance", "is not above 0 mm", "leave it out for infinity");
  check(positive(o.wavelength_nm), "wavelength", "is not above 0 nm", "587.56 is the d line");
}

double cylinder_of(const PowerMatrix& m) {
  return 2 * std::hypot(0.5 * (m.xx - m.yy), m.xy);
}

// The tangents of a direction's two angles.
glm::dvec2 tangents(const Axes& axes, const glm::dvec3& d) {
  const glm::dvec3 v = axes.from_model(d);
  return {v.x / v.z, v.y / v.z};
}

// Prism that turns the light from -object_side to -eye_side, in `axes` whose z is eye_side.
glm::dvec2 prism_in(const Axes& axes, const glm::dvec3& object_side) {
  return 100.0 * tangents(axes, object_side);
}

// Straight ahead: what distortion is measured against.
struct Paraxial {
  glm::dvec2 tangents{0};
  glm::dmat2 by_gaze{1};  ///< d tangents of the object's direction / d tangents of the gaze
};

// The derivative of the tangents (x/z, y/z) of a direction that turns by `turn`.
glm::dvec2 tangent_change(const Axes& axes, const glm::dvec3& d, const glm::dvec3& turn) {
  const glm::dvec3 v = axes.from_model(d), w = axes.from_model(turn);
  return {(w.x - v.x / v.z * w.z) / v.z, (w.y - v.y / v.z * w.z) / v.z};
}

}  // namespace

struct LensEvaluator::Impl {
  const Optic& lens;
  LensFrame frame;
  ChiefRayTracer tracer;
  double start_mm;  // so far behind the back vertex every ray starts outside the lens

  Impl(const Optic& optic, const LensFrame& f) : lens(optic), frame(f), tracer(optic), start_mm(10) {
    for (const auto& vertex : lens.back.mesh.vertices)
      start_mm = std::max(start_mm, 10 - glm::dot(vertex.position_mm - frame.back_vertex_mm, frame.z));
  }

  // The ray along the lens's axis that meets its back at (x, y).
  Ray axial_ray(const glm::dvec2& point) const {
    return {frame.back_vertex_mm + point.x * frame.x + point.y * frame.y - start_mm * frame.z, frame.z};
  }
};

namespace {

// What all points of one evaluation share.
struct Setting {
  const EvaluationOptions& options;
  const LensFrame& frame;
  const ChiefRayTracer& tracer;
  LensIndices indices, indices_f, indices_c;
  Axes lens, wearer;
  glm::dvec3 rotation_centre{0}, entrance_pupil{0};
  PowerMatrix reference;
  bool reference_is_sphere = true;
  Paraxial paraxial;

  Setting(const EvaluationOptions& o, const Optic& optic, const LensFrame& f, const ChiefRayTracer& t)
      : options(o),
        frame(f),
        tracer(t),
        indices(lens_indices(optic, o.wavelength_nm)),
        indices_f(lens_indices(optic, kLineF_nm)),
        indices_c(lens_indices(optic, kLineC_nm)),
        lens(lens_axes(f)),
        wearer(wearer_axes(f, o.position)) {
    const double pupil = o.position.vertex_distance_mm + kPupilBehindCornea_mm;
    rotation_centre = f.back_vertex_mm - o.position.rotation_centre_mm * wearer.z;
    entrance_pupil = f.back_vertex_mm - pupil * wearer.z;
  }

  bool worn() const { return options.mode == EvaluationMode::as_worn; }
  const Axes& axes() const { return worn() ? wearer : lens; }

  PowerMatrix power(const ChiefRay& chief, const Axes& seen, bool at_sphere, double object_mm) const {
    Wavefront wave = chief.wave;
    if (at_sphere) {
      const double ahead =
          glm::distance(chief.back_mm, rotation_centre) - options.position.rotation_centre_mm;
      wave = transferred(wave, -chief.eye_side, ahead);
    }
    const double n = 1000 * indices.around, object_d = n / object_mm;
    return {object_d - n * glm::dot(seen.x, wave.curvature * seen.x),
            -n * glm::dot(seen.x, wave.curvature * seen.y),
            object_d - n * glm::dot(seen.y, wave.curvature * seen.y)};
  }

  void measure(LensPoint& point, const Ray& ray) const;
};

void Setting::measure(LensPoint& point, const Ray& ray) const {
  const ChiefRayKind kind = worn() ? ChiefRayKind::straight : ChiefRayKind::along_the_normal;
  const double object_mm = worn() ? options.object_distance_mm : kInfinity;
  const ChiefRay chief = tracer.trace(ray, kind, indices, object_mm);
  point.end = chief.end;
  if (chief.end == LensPathEnd::missed) return;
  const glm::dvec3 on_back = lens.from_model(chief.back_mm - frame.back_vertex_mm);
  point.point_mm = {on_back.x, on_back.y};
  if (chief.end != LensPathEnd::passed) return;

  const Axes seen = listing_axes(axes(), chief.eye_side);
  point.power = power(chief, seen, worn(), object_mm);
  const glm::dvec2 radial = worn() ? tangents(wearer, chief.eye_side) : point.point_mm;
  const double meridian = glm::length(radial) > 1e-9 ? std::atan2(radial.y, radial.x) : 0;
  point.tangential_d = point.power.along(meridian);
  point.sagittal_d = point.power.along(meridian + 0.5 * std::numbers::pi);
  point.mean_power_error_d = point.power.mean() - reference.mean();
  point.oblique_astigmatism_d = cylinder_of(
      {point.power.xx - reference.xx, point.power.xy - reference.xy, point.power.yy - reference.yy});
  if (reference_is_sphere && point.tangential_d < point.sagittal_d) point.oblique_astigmatism_d *= -1;

  point.prism = prism_in(seen, chief.object_side);
  point.object_rad = gaze_of(axes(), chief.object_side);
  if (worn()) {
    const glm::dvec2 gaze = tangents(wearer, chief.eye_side), expected = paraxial.by_gaze * gaze;
    if (glm::length(expected) > 1e-9)
      point.distortion =
          glm::length(tangents(wearer, chief.object_side) - paraxial.tangents) / glm::length(expected) - 1;
  }
  if (!options.chromatic) return;
  const ChiefRay f = tracer.trace(ray, kind, indices_f, kInfinity),
                 c = tracer.trace(ray, kind, indices_c, kInfinity);
  if (f.end == LensPathEnd::passed && c.end == LensPathEnd::passed)
    point.transverse_colour = glm::distance(prism_in(seen, f.object_side), prism_in(seen, c.object_side));
}

// The focimeter's reading at the back vertex, and what the eye sees straight ahead.
void take_reference(Setting& setting, const Ray& at_vertex, LensEvaluation& result, const std::string& name) {
  const ChiefRay chief =
      setting.tracer.trace(at_vertex, ChiefRayKind::along_the_normal, setting.indices, kInfinity);
  const auto blocked = [&](bool passed, const char* reason) {
    if (!passed) throw Error("", name, reason, "give the frame of a lens whose back vertex is clear");
  };
  blocked(chief.end == LensPathEnd::passed, "lets no light through along the normal of its back vertex");
  const Axes seen = listing_axes(setting.lens, chief.eye_side);
  setting.reference = setting.power(chief, seen, false, kInfinity);
  setting.reference_is_sphere = cylinder_of(setting.reference) < kNoCylinder_d;
  result.reference = sphere_cylinder(setting.reference, CylinderForm::minus);
  result.reference_prism = prism_in(seen, chief.object_side);

  const Axes& w = setting.wearer;
  const auto by_gaze = [&](const glm::dvec3& from) {
    const auto turning = setting.tracer.turning({from, w.z}, w.x, w.y, setting.indices);
    blocked(turning.has_value(), "lets no light through straight ahead of the eye");
    return Paraxial{tangents(w, turning->object_side),
                    {tangent_change(w, turning->object_side, turning->by_x),
                     tangent_change(w, turning->object_side, turning->by_y)}};
  };
  setting.paraxial = by_gaze(setting.rotation_centre);
  // Solid angles: the object's at the eye-side ray is seen under that angle over the determinant.
  const Paraxial pupil = by_gaze(setting.entrance_pupil);
  const double determinant =
      glm::determinant(pupil.by_gaze) * std::pow(1 + glm::dot(pupil.tangents, pupil.tangents), -1.5);
  result.spectacle_magnification = std::pow(std::abs(determinant), -0.5);
}

void for_each_point(std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& measure) {
  const std::size_t most = std::size_t(tbb::this_task_arena::max_concurrency());
  tbb::task_arena arena(int(threads == 0 ? most : std::min(threads, most)));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 16), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) measure(i);
    });
  });
}

}  // namespace

LensEvaluator::LensEvaluator(const Optic& lens, const LensFrame& frame)
    : impl_(std::make_unique<Impl>(lens, frame)) {}
LensEvaluator::~LensEvaluator() = default;
LensEvaluator::LensEvaluator(LensEvaluator&&) noexcept = default;

LensEvaluation LensEvaluator::at_gaze(std::span<const glm::dvec2> gaze_rad,
                                      const EvaluationOptions& options) const {
  check_options(options);
  Setting setting(options, impl_->lens, impl_->frame, impl_->tracer);
  LensEvaluation result;
  take_reference(setting, impl_->axial_ray({0, 0}), result, impl_->lens.name);
  result.points.resize(gaze_rad.size());
  for_each_point(gaze_rad.size(), options.threads, [&](std::size_t i) {
    LensPoint& point = result.points[i];
    point.gaze_rad = gaze_rad[i];
    setting.measure(point, {setting.rotation_centre, gaze_direction(setting.wearer, gaze_rad[i])});
  });
  return result;
}

LensEvaluation LensEvaluator::at_points(std::span<const glm::dvec2> points_mm,
                                        const EvaluationOptions& options) const {
  check_options(options);
  Setting setting(options, impl_->lens, impl_->frame, impl_->tracer);
  LensEvaluation result;
  take_reference(setting, impl_->axial_ray({0, 0}), result, impl_->lens.name);
  result.points.resize(points_mm.size());
  for_each_point(points_mm.size(), options.threads, [&](std::size_t i) {
    LensPoint& point = result.points[i];
    point.point_mm = points_mm[i];
    const Ray axial = impl_->axial_ray(points_mm[i]);
    const ChiefRay met = setting.tracer.trace(axial, ChiefRayKind::straight, setting.indices, kInfinity);
    point.end = met.end;
    if (met.end == LensPathEnd::missed) return;
    const glm::dvec3 sight = glm::normalize(met.back_mm - setting.rotation_centre);
    point.gaze_rad = gaze_of(setting.wearer, sight);
    setting.measure(point, setting.worn() ? Ray{setting.rotation_centre, sight} : axial);
  });
  return result;
}

}  // namespace catoptra::optics
