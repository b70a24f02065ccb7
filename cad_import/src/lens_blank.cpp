// A lens to order: its checks, its thickness, and the heights of its two surfaces.
#include "cad_import/lens_blank.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "cad_import/src/lens_blank_parts.h"

namespace catoptra::cad_import {
namespace {

/// A round or toric surface must be this much wider than the lens: steeper rims are no lens any more, and
/// splines near the equator of a ball need many poles.
constexpr double kSteepest = 1.05;

/// Default front curves are flatter than this against the reach of the lens.
constexpr double kComfortable = 1.25;

struct Thicknesses {
  double least, most;
};

/// Vogel's rule within its useful range: high myopia gets a biconcave lens, high hyperopia a biconvex one.
/// Source: Brooks and Borish 2007, chapter 18.
double default_front_curve_d(const LensBlank& blank, double reach_mm) {
  const double mean = blank.sphere_d + blank.cylinder_d / 2;
  const double vogel = mean > 0 ? mean + 6 : mean / 2 + 6;
  const double most = 1000 * (blank.index - 1) / (kComfortable * reach_mm) - blank.addition_d;
  return std::min({vogel, 12.0, most});
}

void check_steepness(double limit_mm, double reach_mm, const std::string& key) {
  if (limit_mm < kSteepest * reach_mm)
    refuse_lens(key,
                "its radius of " + number_text(limit_mm) + " mm is too small for a lens that reaches " +
                    number_text(reach_mm) + " mm from its axis",
                "make the lens smaller or the curve flatter");
}

std::vector<glm::dvec2> rim_points(const LensBlank& blank) {
  constexpr int kPerPiece = 64;
  std::vector<glm::dvec2> points;
  for (const OutlinePiece& piece : lens_outline(blank))
    for (int i = 0; i < kPerPiece; ++i) {
      const double t = double(i) / kPerPiece;
      if (piece.radius == 0) {
        points.push_back(piece.from + t * (piece.to - piece.from));
        continue;
      }
      const glm::dvec2 a = piece.from - piece.centre;
      const double angle = t * std::numbers::pi / 2;
      points.push_back(piece.centre + std::cos(angle) * a + std::sin(angle) * glm::dvec2(-a.y, a.x));
    }
  return points;
}

}  // namespace

struct LensShape::Impl {
  LensBlank blank;
  LensFront front;
  LensBack back;
  double reach_mm;
  double front_room_mm = 0, back_room_mm = 0;  // see drawn_in()
  LensBlankReport report;

  explicit Impl(const LensBlank& wanted, double curve_d)
      : blank(wanted), front(wanted, curve_d), reach_mm(lens_reach_mm(wanted)) {}

  void set_thickness(double thickness_mm) {
    back = solve_back(blank, front.curvature(), thickness_mm);
    check_steepness(back.limit_mm(), reach_mm, "back curve");
    front_room_mm = room_mm(front.limit_mm());
    back_room_mm = room_mm(back.limit_mm());
  }

  /// Most of the way from the lens's reach to the circle on which a surface turns vertical.
  [[nodiscard]] double room_mm(double limit_mm) const {
    return 0.8 * (std::min(limit_mm, 100 * reach_mm) - reach_mm);
  }

  /// The rectangle around a lens may reach where its surfaces end. Beyond the lens's reach the argument is
  /// therefore drawn in, smoothly (six continuous derivatives), towards reach + room.
  [[nodiscard]] glm::dvec2 drawn_in(double x, double y, double room) const {
    const double r = std::hypot(x, y);
    if (r <= reach_mm) return {x, y};
    const double t = (r - reach_mm) / room;
    const double t2 = t * t, t6 = t2 * t2 * t2;
    return glm::dvec2(x, y) * ((reach_mm + room * t / std::pow(1 + t6, 1.0 / 6)) / r);
  }
  [[nodiscard]] double front_z(double x, double y) const {
    const glm::dvec2 p = drawn_in(x, y, front_room_mm);
    return -front.sag_mm(p.x, p.y);
  }
  [[nodiscard]] double back_z(double x, double y) const {
    const glm::dvec2 p = drawn_in(x, y, back_room_mm);
    return back.z_mm(p.x, p.y);
  }

  [[nodiscard]] Thicknesses rim() const {
    Thicknesses rim{1e300, -1e300};
    for (const glm::dvec2& p : rim_points(blank)) {
      const double thickness = front_z(p.x, p.y) - back_z(p.x, p.y);
      rim = {std::min(rim.least, thickness), std::max(rim.most, thickness)};
    }
    return rim;
  }

  /// Grows or shrinks the centre until the rim's least thickness is `edge_mm`. The back hardly changes with
  /// the thickness, so that adding what is missing converges at once.
  void reach_edge(double edge_mm) {
    double thickness = std::max(-back.vertex_mm.z, edge_mm);
    for (int iteration = 0; iteration < 60; ++iteration) {
      set_thickness(thickness);
      const double missing = edge_mm - rim().least;
      if (std::abs(missing) < 1e-10) return;
      thickness += missing;
    }
    refuse_lens("edge thickness", number_text(edge_mm) + " mm leads to no lens",
                "give the center thickness instead");
  }

  /// Throws where front and back cross, on the rim or on the way from the axis to it.
  void check_crossing() const {
    constexpr int kSteps = 12;
    for (const glm::dvec2& rim_point : rim_points(blank))
      for (int i = 0; i <= kSteps; ++i) {
        const glm::dvec2 p = rim_point * (double(i) / kSteps);
        const double thickness = front_z(p.x, p.y) - back_z(p.x, p.y);
        if (thickness > 0) continue;
        refuse_lens(blank.edge_thickness_mm ? "edge thickness" : "center thickness",
                    number_text(blank.edge_thickness_mm.value_or(-back.vertex_mm.z)) +
                        " mm lets front and back cross: the thickness at (" + number_text(p.x) + ", " +
                        number_text(p.y) + ") mm is " + number_text(thickness) + " mm",
                    "make the lens thicker or smaller");
      }
  }
};

LensShape::LensShape(const LensBlank& blank) {
  check_lens_blank(blank);
  const double reach = lens_reach_mm(blank);
  const double curve = blank.front_curve_d.value_or(default_front_curve_d(blank, reach));
  auto impl = std::make_shared<Impl>(blank, curve);
  check_steepness(impl->front.limit_mm(), reach, "front curve");
  impl->set_thickness(blank.center_thickness_mm.value_or(blank.index < 1.6 ? 2.0 : 1.5));
  if (blank.edge_thickness_mm) {
    impl->reach_edge(*blank.edge_thickness_mm);
    if (const double centre = -impl->back.vertex_mm.z; !(centre > 0))
      refuse_lens("edge thickness", number_text(*blank.edge_thickness_mm) +
                                        " mm leaves a center thickness of " + number_text(centre) + " mm");
  } else if (!blank.center_thickness_mm && impl->rim().least < 1) {
    impl->reach_edge(1);
  }
  impl->check_crossing();
  const auto radius = [](double curvature) { return curvature == 0 ? 0 : 1 / curvature; };
  const Thicknesses rim = impl->rim();
  impl->report = {impl->back.form,
                  curve,
                  radius(impl->front.curvature()),
                  radius(-impl->back.c1),
                  radius(-impl->back.c2),
                  -impl->back.vertex_mm.z,
                  rim.least,
                  rim.most};
  impl_ = std::move(impl);
}

double LensShape::front_z_mm(double x_mm, double y_mm) const {
  return impl_->front_z(x_mm, y_mm);
}
double LensShape::back_z_mm(double x_mm, double y_mm) const {
  return impl_->back_z(x_mm, y_mm);
}
const LensBlankReport& LensShape::report() const {
  return impl_->report;
}
const LensBlank& LensShape::blank() const {
  return impl_->blank;
}

}  // namespace catoptra::cad_import
