// Mirrors that see each other, and the paths of light between them in closed form, independent of the
// renderer.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "optics/placement.h"
#include "optics/reflection.h"
#include "render/renderer.h"
#include "render/src/sampling.h"
#include "tests/render/raster_test_scene.h"

namespace catoptra::test {

/// A rectangle of a plane (radius 0) or of a sphere, around the origin of its own frame and facing +z there.
struct PlacedMirror {
  double radius_mm = 0, width_mm = 0, height_mm = 0;
  optics::Placement at;

  /// Facing `towards`, with its middle at `middle_mm`; its width lies across `up`.
  static PlacedMirror facing(const glm::dvec3& middle_mm, const glm::dvec3& towards, double width_mm,
                             double height_mm, double radius_mm = 0, const glm::dvec3& up = {0, 1, 0}) {
    const glm::dvec3 z = glm::normalize(towards), x = glm::normalize(glm::cross(up, z));
    return {radius_mm, width_mm, height_mm, {glm::dmat3(x, glm::cross(z, x), z), middle_mm}};
  }

  [[nodiscard]] optics::Optic optic(int vertices) const {
    return optics::placed(conic_mirror(radius_mm, 0, width_mm, height_mm, vertices, vertices), at);
  }

  struct Met {
    double distance_mm;
    glm::dvec3 point_mm, normal;
  };
  [[nodiscard]] std::optional<Met> meet(const glm::dvec3& origin_mm, const glm::dvec3& direction) const {
    const glm::dvec3 o = at.own_point(origin_mm), d = at.own_direction(direction);
    double t = -o.z / d.z;
    if (radius_mm != 0) {
      const glm::dvec3 from_center = o - glm::dvec3(0, 0, -radius_mm);
      const double b = glm::dot(from_center, d),
                   root = b * b - glm::dot(from_center, from_center) + radius_mm * radius_mm;
      if (root < 0) return std::nullopt;
      t = -b - std::sqrt(root);  // the near side: these are convex
    }
    const glm::dvec3 p = o + t * d;
    if (!(t > 1e-9) || std::abs(p.x) > width_mm / 2 || std::abs(p.y) > height_mm / 2) return std::nullopt;
    const glm::dvec3 n =
        radius_mm == 0 ? glm::dvec3(0, 0, 1) : glm::normalize(p - glm::dvec3(0, 0, -radius_mm));
    return Met{t, at.point(p), at.direction(n)};
  }
};

/// The way of one ray of the eye by up to `depth` mirrors.
struct Bounces {
  std::vector<int> mirrors;  ///< met with their reflecting side
  int body = -1;             ///< the mirror that ends the way as a plain body or by its back; -1: none
  glm::dvec3 point_mm{0}, direction{0};  ///< the last ray
};

inline Bounces follow(const std::vector<PlacedMirror>& mirrors, glm::dvec3 origin_mm, glm::dvec3 direction,
                      int depth) {
  Bounces way;
  for (;;) {
    way.point_mm = origin_mm;
    way.direction = direction;
    std::optional<PlacedMirror::Met> nearest;
    int met = -1;
    for (int i = 0; i < int(mirrors.size()); ++i) {
      if (!way.mirrors.empty() && i == way.mirrors.back()) continue;
      const auto here = mirrors[std::size_t(i)].meet(origin_mm, direction);
      if (here && (!nearest || here->distance_mm < nearest->distance_mm)) nearest = here, met = i;
    }
    if (!nearest) return way;
    if (int(way.mirrors.size()) == depth || glm::dot(nearest->normal, direction) > 0) {
      way.body = met;
      return way;
    }
    way.mirrors.push_back(met);
    origin_mm = nearest->point_mm;
    direction = optics::reflect(direction, nearest->normal);
  }
}

/// A large box around everything, so that every ray ends somewhere.
inline render::Scene scene_of(const std::vector<PlacedMirror>& mirrors, int vertices, int depth) {
  render::Scene scene = room();
  add_box(scene.surroundings[0], {-6000, -5000, -6000}, {6000, 5000, 6000}, glm::vec3(0.4f, 0.5f, 0.6f));
  for (const PlacedMirror& mirror : mirrors) {
    scene.optics.push_back(mirror.optic(vertices));
    scene.optics.back().name = "mirror " + std::to_string(scene.optics.size());
  }
  scene.settings.depth = depth;
  return scene;
}

/// What `frame` shows against the closed form, by the number of mirrors on the way (index 0: none).
struct BounceErrors {
  std::vector<std::vector<double>>
      arcmin;                          ///< at the last mirror, where the frame shows the same way; ascending
  std::vector<std::size_t> other_way;  ///< pixels in which it shows another one

  explicit BounceErrors(int depth) : arcmin(std::size_t(depth) + 1), other_way(std::size_t(depth) + 1, 0) {}
};

inline BounceErrors bounce_errors(const render::Scene& scene, const std::vector<PlacedMirror>& mirrors,
                                  const render::Frame& frame) {
  const auto rays = render::camera_rays(scene.camera, frame.width, frame.height);
  BounceErrors errors(scene.settings.depth);
  for (int row = 0; row < frame.height; ++row)
    for (int column = 0; column < frame.width; ++column) {
      const auto i = std::size_t(row) * std::size_t(frame.width) + std::size_t(column);
      const Bounces way =
          follow(mirrors, rays.eye_mm,
                 glm::normalize(rays.corner + double(column) * rays.dx + double(row) * rays.dy),
                 scene.settings.depth);
      if (way.mirrors.empty()) continue;
      std::uint32_t path = 0;
      for (const int mirror : way.mirrors) path = render::path_after(path, mirror);
      if (render::path_of(frame, i) != path || frame.bounces[i] != way.mirrors.size())
        ++errors.other_way[way.mirrors.size()];
      else
        errors.arcmin[way.mirrors.size()].push_back(
            angle_arcmin(way.direction, shown_direction(frame, i, way.point_mm)));
    }
  for (auto& list : errors.arcmin) std::sort(list.begin(), list.end());
  return errors;
}

inline double quantile(const std::vector<double>& sorted, double share) {
  return sorted.empty() ? 0 : sorted[std::min(sorted.size() - 1, std::size_t(share * double(sorted.size())))];
}

}  // namespace catoptra::test
