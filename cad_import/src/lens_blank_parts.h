// The steps between a LensBlank and its solid, shared by the lens_blank*.cpp files.
#pragma once

#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cad_import/lens_blank.h"
#include "cad_import/src/blank_parts.h"

namespace catoptra::cad_import {

/// Throws Error("lens", key, ...) for values that are wrong by themselves.
void check_lens_blank(const LensBlank& blank);
[[noreturn]] void refuse_lens(const std::string& key, const std::string& reason,
                              const std::string& hint = {});
/// Shortest decimal text of a value for messages.
[[nodiscard]] std::string number_text(double value);

[[nodiscard]] std::vector<OutlinePiece> lens_outline(const LensBlank& blank);
/// Largest distance of the outline from the axis.
[[nodiscard]] double lens_reach_mm(const LensBlank& blank);

/// How far a freeform or round front falls from its vertex, mm, positive towards the back.
class LensFront {
 public:
  /// `curve_d`: the front curve to use.
  LensFront(const LensBlank& blank, double curve_d);
  /// Defined within limit_mm() of the axis.
  [[nodiscard]] double sag_mm(double x_mm, double y_mm) const;
  [[nodiscard]] double limit_mm() const;
  [[nodiscard]] double curvature() const { return curvature_; }  // at the vertex, 1/mm

 private:
  struct MeridianPoint {
    double y, z, angle, curvature, growth;  // growth: d curvature / d arc
  };
  [[nodiscard]] MeridianPoint meridian(double arc_mm) const;
  [[nodiscard]] glm::dvec2 corridor_chord(double from_arc_mm, double to_arc_mm) const;
  [[nodiscard]] double round_sag(double r2) const;
  [[nodiscard]] double trunk_sag(double x_mm, double y_mm) const;

  LensFrontForm form_;
  double curvature_, conic_ = 0;
  std::vector<double> coefficients_;
  double addition_curvature_ = 0, corridor_mm_ = 0;
  std::vector<glm::dvec2> corridor_;  // (y, z) of the meridian at equal steps of arc
};

/// The back in its own frame: origin at the back vertex, columns of `frame` its principal directions and its
/// normal, which points into the lens.
struct LensBack {
  glm::dvec3 vertex_mm{0};
  glm::dmat3 frame{1};
  double c1 = 0, c2 = 0;  // 1/mm, positive where the section opens towards the front
  LensBackForm form = LensBackForm::toric;
  double conic = 0;  // biconic only

  /// Height z in the lens's frame. Within limit_mm() of the axis.
  [[nodiscard]] double z_mm(double x_mm, double y_mm) const;
  [[nodiscard]] double limit_mm() const;

 private:
  struct Sag {
    double z, slope_x, slope_y;
  };
  /// Above (x, y) of the own frame; nullopt where the surface does not reach.
  [[nodiscard]] std::optional<Sag> toric_sag(double x, double y) const;
  [[nodiscard]] std::optional<Sag> biconic_sag(double x, double y) const;
};

/// The form that `blank` asks for or needs.
[[nodiscard]] LensBackForm back_form(const LensBlank& blank);

/// The back that gives `blank` its prescription behind a front of curvature `front_curvature` at the vertex
/// and `thickness_mm` of material.
[[nodiscard]] LensBack solve_back(const LensBlank& blank, double front_curvature, double thickness_mm);

}  // namespace catoptra::cad_import
