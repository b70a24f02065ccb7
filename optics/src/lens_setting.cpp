#include "optics/src/lens_setting.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "cad_import/error.h"

namespace catoptra::optics {
namespace {

constexpr double kPupilBehindCornea_mm = 3;  // entrance pupil of the eye
// Below it the reference counts as a sphere: a twentieth of the narrowest tolerance of a cylinder (0.09 D),
// and above what a B-spline within 1e-7 mm of a sphere has.
constexpr double kNoCylinder_d = 0.005;
constexpr double kOnAxis = 1e-9;  // tangents or mm below which there is no meridian

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

void must_pass(bool passed, const std::string& name, const char* reason) {
  if (!passed) throw Error("", name, reason, "give the frame of a lens whose back vertex is clear");
}

double cylinder_of(const PowerMatrix& m) {
  const double difference = m.xx - m.yy;
  return std::sqrt(difference * difference + 4 * m.xy * m.xy);
}

// Power along the unit vector `m` of the matrix's axes.
double along(const PowerMatrix& p, const glm::dvec2& m) {
  return p.xx * m.x * m.x + 2 * p.xy * m.x * m.y + p.yy * m.y * m.y;
}

glm::dvec2 tangents(const Axes& axes, const glm::dvec3& d) {
  const glm::dvec3 v = axes.from_model(d);
  return {v.x / v.z, v.y / v.z};
}

// The derivative of tangents() for a direction that turns by `turn`.
glm::dvec2 tangent_change(const Axes& axes, const glm::dvec3& d, const glm::dvec3& turn) {
  const glm::dvec3 v = axes.from_model(d), w = axes.from_model(turn);
  return {(w.x - v.x / v.z * w.z) / v.z, (w.y - v.y / v.z * w.z) / v.z};
}

// What turns the light from -object_side to -eye_side, in `seen`, whose z is eye_side.
glm::dvec2 prism_in(const Axes& seen, const glm::dvec3& object_side) {
  return 100.0 * tangents(seen, object_side);
}

}  // namespace

LensSetting::LensSetting(const EvaluationOptions& options, const Optic& lens, const LensFrame& frame,
                         const ChiefRayTracer& tracer, const Ray& at_vertex)
    : options_(options),
      back_vertex_(frame.back_vertex_mm),
      lens_(lens_axes(frame)),
      wearer_(wearer_axes(frame, options.position)) {
  check_options(options);
  task_.kind = worn() ? ChiefRayKind::straight : ChiefRayKind::along_the_normal;
  task_.object_distance_mm = worn() ? options.object_distance_mm : kInfinity;
  task_.indices = lens_indices(lens, options.wavelength_nm);
  task_.indices_f = lens_indices(lens, kLineF_nm);
  task_.indices_c = lens_indices(lens, kLineC_nm);
  const auto ratio = [](const LensIndices& n) { return n.lens / n.around; };
  task_.coloured = options.chromatic && ratio(task_.indices_f) != ratio(task_.indices_c);
  rotation_centre_ = back_vertex_ - options.position.rotation_centre_mm * wearer_.z;
  entrance_pupil_ = back_vertex_ - (options.position.vertex_distance_mm + kPupilBehindCornea_mm) * wearer_.z;
  take_reference(tracer, at_vertex, lens.name);
}

// The focimeter's reading at the back vertex, and what the eye sees straight ahead.
void LensSetting::take_reference(const ChiefRayTracer& tracer, const Ray& at_vertex,
                                 const std::string& name) {
  ChiefRayTask focimeter;
  focimeter.kind = ChiefRayKind::along_the_normal;
  focimeter.indices = task_.indices;
  const ChiefRay chief = tracer.trace(at_vertex, focimeter);
  must_pass(chief.end == LensPathEnd::passed, name,
            "lets no light through along the normal of its back vertex");
  const Axes seen = listing_axes(lens_, chief.eye_side);
  reference_ = power(chief.wave, seen, kInfinity, 0);
  reference_is_sphere_ = cylinder_of(reference_) < kNoCylinder_d;
  of_lens_.reference = sphere_cylinder(reference_, CylinderForm::minus);
  of_lens_.reference_prism = prism_in(seen, chief.object_side);

  paraxial_ = straight_ahead_from(rotation_centre_, tracer, name);
  // An object's solid angle over that under which the eye sees it: tangents' areas, times cos^3 of the
  // object's direction.
  const Paraxial pupil = straight_ahead_from(entrance_pupil_, tracer, name);
  const double solid_angle = std::abs(glm::determinant(pupil.by_gaze)) *
                             std::pow(1 + glm::dot(pupil.tangents, pupil.tangents), -1.5);
  of_lens_.spectacle_magnification = 1 / std::sqrt(solid_angle);
}

LensSetting::Paraxial LensSetting::straight_ahead_from(const glm::dvec3& eye, const ChiefRayTracer& tracer,
                                                       const std::string& name) const {
  const auto turning = tracer.turning({eye, wearer_.z}, wearer_.x, wearer_.y, task_.indices);
  must_pass(turning.has_value(), name, "lets no light through straight ahead of the eye");
  return {tangents(wearer_, turning->object_side),
          {tangent_change(wearer_, turning->object_side, turning->by_x),
           tangent_change(wearer_, turning->object_side, turning->by_y)}};
}

// What the lens adds to the vergence of an object at `object_mm`, by the wave `ahead_mm` further on:
// transferred() within the two axes across the ray.
PowerMatrix LensSetting::power(const Wavefront& wave, const Axes& seen, double object_mm,
                               double ahead_mm) const {
  const glm::dvec3 qx = wave.curvature * seen.x, qy = wave.curvature * seen.y;
  const double xx = glm::dot(seen.x, qx), xy = glm::dot(seen.x, qy), yy = glm::dot(seen.y, qy);
  const double spread = ahead_mm * (xx * yy - xy * xy), n = 1000 * task_.indices.around,
               object_d = n / object_mm;
  const double scale = n / (1 + ahead_mm * (xx + yy + spread));
  return {object_d - scale * (xx + spread), -scale * xy, object_d - scale * (yy + spread)};
}

LensPoint LensSetting::measured(LensPoint point, const ChiefRay& chief) const {
  point.end = chief.end;
  if (chief.end == LensPathEnd::missed) return point;
  const glm::dvec3 on_back = lens_.from_model(chief.back_mm - back_vertex_);
  point.point_mm = {on_back.x, on_back.y};
  if (chief.end != LensPathEnd::passed) return point;

  const Axes& axes = worn() ? wearer_ : lens_;
  const Axes seen = listing_axes(axes, chief.eye_side);
  const double to_sphere_mm =
      worn() ? glm::distance(chief.back_mm, rotation_centre_) - options_.position.rotation_centre_mm : 0;
  point.power = power(chief.wave, seen, task_.object_distance_mm, to_sphere_mm);
  const glm::dvec2 gaze = tangents(axes, chief.eye_side), radial = worn() ? gaze : point.point_mm;
  const double radius = glm::length(radial);
  const glm::dvec2 meridian = radius > kOnAxis ? radial / radius : glm::dvec2(1, 0);
  point.tangential_d = along(point.power, meridian);
  point.sagittal_d = along(point.power, {-meridian.y, meridian.x});
  point.mean_power_error_d = point.power.mean() - reference_.mean();
  point.oblique_astigmatism_d = cylinder_of(
      {point.power.xx - reference_.xx, point.power.xy - reference_.xy, point.power.yy - reference_.yy});
  if (reference_is_sphere_ && point.tangential_d < point.sagittal_d) point.oblique_astigmatism_d *= -1;

  point.prism = prism_in(seen, chief.object_side);
  point.object_rad = gaze_of(axes, chief.object_side);
  const glm::dvec2 expected = paraxial_.by_gaze * gaze;
  if (worn() && glm::length(expected) > kOnAxis)
    point.distortion =
        glm::length(tangents(wearer_, chief.object_side) - paraxial_.tangents) / glm::length(expected) - 1;
  if (chief.coloured)
    point.transverse_colour =
        glm::distance(prism_in(seen, chief.object_side_f), prism_in(seen, chief.object_side_c));
  return point;
}

}  // namespace catoptra::optics
