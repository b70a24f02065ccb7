// What all points of one evaluation share, and what is read off a chief ray.
#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <string>

#include "optics/lens_evaluation.h"
#include "optics/src/lens_chief_ray.h"
#include "optics/src/lens_wearing.h"

namespace catoptra::optics {

class LensSetting {
 public:
  /// `at_vertex` runs along the lens's axis through its back vertex. Throws Error for options out of range,
  /// and where no light passes along the normal of the back vertex or straight ahead of the eye.
  LensSetting(const EvaluationOptions& options, const Optic& lens, const LensFrame& frame,
              const ChiefRayTracer& tracer, const Ray& at_vertex);

  [[nodiscard]] bool worn() const { return options_.mode == EvaluationMode::as_worn; }
  [[nodiscard]] const ChiefRayTask& task() const { return task_; }
  [[nodiscard]] const Axes& wearer() const { return wearer_; }
  [[nodiscard]] const glm::dvec3& rotation_centre_mm() const { return rotation_centre_; }

  /// The evaluation without its points.
  [[nodiscard]] const LensEvaluation& of_lens() const { return of_lens_; }

  /// Fills in what `chief` tells; `point` has its gaze already.
  [[nodiscard]] LensPoint measured(LensPoint point, const ChiefRay& chief) const;

 private:
  // How directions change near one: their tangents (x/z, y/z) and the derivatives by those of the gaze.
  struct Paraxial {
    glm::dvec2 tangents{0};
    glm::dmat2 by_gaze{1};
  };

  [[nodiscard]] PowerMatrix power(const Wavefront& wave, const Axes& seen, double object_mm,
                                  double ahead_mm) const;
  [[nodiscard]] Paraxial straight_ahead_from(const glm::dvec3& eye, const ChiefRayTracer& tracer,
                                             const std::string& name) const;
  void take_reference(const ChiefRayTracer& tracer, const Ray& at_vertex, const std::string& name);

  EvaluationOptions options_;
  glm::dvec3 back_vertex_;
  ChiefRayTask task_;
  Axes lens_, wearer_;
  glm::dvec3 rotation_centre_{0}, entrance_pupil_{0};
  LensEvaluation of_lens_;
  PowerMatrix reference_;
  bool reference_is_sphere_ = true;
  Paraxial paraxial_;
};

}  // namespace catoptra::optics
