#include "optics/map_coordinates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <string>

#include "cad_import/error.h"

namespace catoptra::optics {
namespace {

// Depth, as a fraction of the distance, to which points beside or behind the viewpoint are brought forward,
// so that they come out far beyond the map's border on their own side.
constexpr double kGrazing = 0.05;

// What a vertex shows, as homogeneous map coordinates with w > 0.
glm::dvec3 shown(const VertexHit& hit, const VirtualView& view) {
  if (view.projection == MapProjection::parallel) {
    const glm::dvec3 far_point = hit.surface_point_mm + view.far_mm * hit.direction;
    return view.project_point(hit.scene_hit ? hit.hit_point_mm : far_point);
  }
  glm::dvec3 towards = hit.direction;
  if (hit.scene_hit) {
    const glm::dvec3 to_hit = hit.hit_point_mm - view.viewpoint_mm;
    // A hit before the viewpoint is in the zooming region, which this map does not show: its direction has to
    // do.
    if (glm::dot(to_hit, view.direction) > 0) towards = glm::normalize(to_hit);
  }
  const double depth = glm::dot(towards, view.direction);
  if (depth < kGrazing) towards += (kGrazing - depth) * view.direction;
  return view.project_direction(towards);
}

struct MapSample {
  glm::dvec2 plane;  // tangent-plane coordinates, centred and scaled to about 1
  glm::dvec2 map;    // (s, t)
};

// Samples of the vertices that face the eye, with the optic's tangent-plane coordinates.
struct PlaneFrame {
  glm::dvec3 centre{0}, e1{1, 0, 0}, e2{0, 1, 0};
  double scale = 1;

  glm::dvec2 operator()(const glm::dvec3& p) const {
    return glm::dvec2(glm::dot(p - centre, e1), glm::dot(p - centre, e2)) / scale;
  }
};

PlaneFrame tangent_plane(const Optic& optic, std::span<const VertexHit> hits) {
  PlaneFrame frame;
  glm::dvec3 normal{0};
  double count = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].faces_eye) continue;
    frame.centre += optic.mesh.vertices[i].position_mm;
    normal += optic.mesh.vertices[i].normal;
    ++count;
  }
  if (count == 0 || glm::length(normal) == 0) return frame;
  frame.centre /= count;
  normal = glm::normalize(normal);
  const glm::dvec3 helper = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  frame.e1 = glm::normalize(glm::cross(normal, helper));
  frame.e2 = glm::cross(normal, frame.e1);
  double squares = 0;
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (hits[i].faces_eye) {
      const glm::dvec2 p = frame(optic.mesh.vertices[i].position_mm);
      squares += glm::dot(p, p);
    }
  if (squares > 0) frame.scale = std::sqrt(squares / count);
  return frame;
}

// Gradient g of the denominator 1 + g . x of the homography that maps `plane` to `map` best. Multiplied by
// the denominator the map is linear in its eight parameters; the six of the numerators are affine functions
// of x and are eliminated by projecting everything off them, which leaves two equations for g. Weighting by
// the last denominator turns the algebraic error into the geometric one. Source: Hartley and Zisserman,
// Multiple View Geometry, 2nd ed. 2004, 4.1 (direct linear transformation), 4.4.4 (normalisation).
glm::dvec2 homography_denominator(std::span<const MapSample> samples) {
  glm::dvec2 g{0};
  for (int iteration = 0; iteration < 4; ++iteration) {
    const auto weight = [&](const MapSample& sample) {
      const double q = 1 + glm::dot(g, sample.plane);
      return 1 / (q * q);
    };
    glm::dmat3 gram{0};
    std::array<glm::dvec3, 6> moments{};  // of s, a s, b s, t, a t, b t with (a, b, 1)
    const auto columns = [](const MapSample& m) {
      return std::array<double, 6>{m.map.x, m.plane.x * m.map.x, m.plane.y * m.map.x,
                                   m.map.y, m.plane.x * m.map.y, m.plane.y * m.map.y};
    };
    for (const MapSample& sample : samples) {
      const glm::dvec3 basis{sample.plane, 1};
      const double w = weight(sample);
      gram += w * glm::outerProduct(basis, basis);
      const auto c = columns(sample);
      for (int k = 0; k < 6; ++k) moments[k] += w * c[k] * basis;
    }
    const glm::dmat3 inverse = glm::inverse(gram);
    glm::dmat2 normal{0};
    glm::dvec2 right{0};
    double size = 0;
    for (const MapSample& sample : samples) {
      const glm::dvec3 basis = inverse * glm::dvec3(sample.plane, 1);
      auto c = columns(sample);
      for (int k = 0; k < 6; ++k) c[k] -= glm::dot(moments[k], basis);
      const double w = weight(sample);
      for (int k = 0; k < 6; k += 3) {
        const glm::dvec2 row{c[k + 1], c[k + 2]};
        normal += w * glm::outerProduct(row, row);
        right -= w * c[k] * row;
        size += w * glm::dot(row, row);
      }
    }
    // Fewer than four vertices, or all on a line, leave g open: then the affine map is as good as any.
    if (!(glm::determinant(normal) > 1e-12 * size * size)) return glm::dvec2(0);
    g = glm::inverse(normal) * right;
  }
  return g;
}

}  // namespace

std::vector<glm::dvec3> map_coordinates(const Optic& optic, std::span<const VertexHit> hits,
                                        const VirtualView& view, MapInterpolation interpolation) {
  if (hits.size() != optic.mesh.vertices.size())
    throw Error("", optic.name,
                std::to_string(hits.size()) + " traced rays for " +
                    std::to_string(optic.mesh.vertices.size()) + " vertices");
  std::vector<glm::dvec3> coordinates(hits.size(), glm::dvec3(0.5, 0.5, 1));
  const PlaneFrame frame = tangent_plane(optic, hits);
  std::vector<MapSample> samples;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].faces_eye) continue;
    const glm::dvec3 h = shown(hits[i], view);
    coordinates[i] = glm::dvec3(h.x / h.z, h.y / h.z, 1);
    samples.push_back({frame(optic.mesh.vertices[i].position_mm), glm::dvec2(coordinates[i])});
  }
  if (interpolation == MapInterpolation::affine) return coordinates;

  const glm::dvec2 g = homography_denominator(samples);
  const auto denominator = [&](std::size_t i) {
    return 1 + glm::dot(g, frame(optic.mesh.vertices[i].position_mm));
  };
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (hits[i].faces_eye && !(denominator(i) > 0)) return coordinates;  // no denominator: affine
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (hits[i].faces_eye) coordinates[i] *= denominator(i);
  return coordinates;
}

}  // namespace catoptra::optics
