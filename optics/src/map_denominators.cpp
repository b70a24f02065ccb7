#include "optics/src/map_denominators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x2.hpp>

#include "optics/src/homography.h"

namespace catoptra::optics {
namespace {

// Depth, as a fraction of the distance, to which points beside or behind the viewpoint are brought forward,
// so that they come out far beyond the map's border on their own side.
constexpr double kGrazing = 0.05;

// Homogeneous map coordinates, w > 0, of the direction from the viewpoint `towards`.
glm::dvec3 forward_projection(glm::dvec3 towards, const VirtualView& view) {
  const double depth = glm::dot(towards, view.direction);
  if (depth < kGrazing) towards += (kGrazing - depth) * view.direction;
  return view.project_direction(towards);
}

glm::dvec3 project(const glm::dvec3& point_mm, const VertexHit& hit, const VirtualView& view) {
  if (view.projection == MapProjection::parallel) return view.project_point(point_mm);
  const glm::dvec3 towards = point_mm - view.viewpoint_mm;
  const double depth = glm::dot(towards, view.direction);
  if (view.zooms() && depth < -view.zooming_near_mm)
    return forward_projection(-glm::normalize(towards), view);
  // What lies elsewhere before the viewpoint is not in the map: the direction has to do.
  if (!(depth > 0)) return forward_projection(hit.direction, view);
  return forward_projection(glm::normalize(towards), view);
}

// What a ray shows at the distance `t_mm` from the optic, or infinitely far.
glm::dvec3 shown_at(const VertexHit& hit, double t_mm, const VirtualView& view) {
  if (view.projection == MapProjection::parallel) t_mm = std::min(t_mm, view.far_mm);
  if (!std::isfinite(t_mm)) return forward_projection(hit.direction, view);
  return project(hit.surface_point_mm + t_mm * hit.direction, hit, view);
}

// The map's place in lengths, so that errors in s and t weigh as they are seen.
glm::dvec2 in_lengths(const glm::dvec3& h, const VirtualView& view) {
  return {h.x / h.z * (view.right_side - view.left), h.y / h.z * (view.top - view.bottom)};
}

// A vertex in the plane in which a homography is fitted.
struct Place {
  glm::dvec2 plane{0};  // centred, scaled to about 1
  double weight = 1;    // the middle of a chord has the weighted mean of its ends' plane coordinates
};

struct Centre {
  glm::dvec3 position{0}, normal{0};
};

Centre centre_of(const MapProblem& problem) {
  Centre centre;
  for (const std::size_t i : problem.facing) {
    centre.position += problem.mesh.vertices[i].position_mm / static_cast<double>(problem.facing.size());
    centre.normal += problem.mesh.vertices[i].normal;
  }
  return centre;
}

void scale_to_unit(std::vector<Place>& places) {
  glm::dvec2 squares{0};
  for (const Place& place : places) squares += place.plane * place.plane / static_cast<double>(places.size());
  const glm::dvec2 scale{squares.x > 0 ? std::sqrt(squares.x) : 1, squares.y > 0 ? std::sqrt(squares.y) : 1};
  for (Place& place : places) place.plane /= scale;
}

std::array<glm::dvec3, 2> axes_across(const glm::dvec3& normal) {
  const glm::dvec3 helper =
      std::abs(normal.x) < 0.6 * glm::length(normal) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 e1 = glm::normalize(glm::cross(normal, helper));
  return {e1, glm::normalize(glm::cross(normal, e1))};
}

// Orthogonal projection onto the tangent plane at the optic's centre.
std::vector<Place> tangent_plane_places(const MapProblem& problem) {
  const Centre centre = centre_of(problem);
  const auto [e1, e2] = axes_across(centre.normal);
  std::vector<Place> places;
  for (const std::size_t i : problem.facing) {
    const glm::dvec3 p = problem.mesh.vertices[i].position_mm - centre.position;
    places.push_back({{glm::dot(p, e1), glm::dot(p, e2)}, 1});
  }
  scale_to_unit(places);
  return places;
}

// The eye is where the incident rays meet.
ViewpointFit eye_of(const MapProblem& problem) {
  std::vector<glm::dvec3> points, incident;
  for (const std::size_t i : problem.facing) {
    points.push_back(problem.mesh.vertices[i].position_mm);
    incident.push_back(problem.hits[i].from_eye);
  }
  return fit_viewpoint(points, incident);
}

// The optic as the eye sees it.
std::vector<Place> eye_places(const MapProblem& problem, const glm::dvec3& eye_mm) {
  const glm::dvec3 axis = centre_of(problem).position - eye_mm;
  const auto [e1, e2] = axes_across(axis);
  std::vector<Place> places;
  for (const std::size_t i : problem.facing) {
    const glm::dvec3 p = problem.mesh.vertices[i].position_mm - eye_mm;
    const double depth = glm::dot(p, axis) / glm::dot(axis, axis);
    if (!(depth > 0.1)) return tangent_plane_places(problem);  // an eye amid the optic has no such picture
    places.push_back({glm::dvec2(glm::dot(p, e1), glm::dot(p, e2)) / depth, depth});
  }
  scale_to_unit(places);
  return places;
}

std::vector<double> denominators_of(std::span<const Place> places, std::span<const MapSample> samples) {
  const glm::dvec2 g = homography_denominator(samples);
  std::vector<double> q;
  for (const Place& place : places) q.push_back(place.weight * (1 + glm::dot(g, place.plane)));
  // A homography whose horizon crosses the optic says nothing about its far side: affine.
  if (std::ranges::any_of(q, [](double value) { return !(value > 0); })) q.assign(q.size(), 1.0);
  return q;
}

// The usual distance of what the optic shows. Where all vertices are taken to show a point at this distance,
// neighbours no longer differ by the depth of what they meet, and the map is as smooth as the surface.
double usual_distance(const MapProblem& problem) {
  std::vector<double> distances;
  for (const std::size_t i : problem.facing) {
    const VertexHit& hit = problem.hits[i];
    distances.push_back(hit.scene_hit ? glm::distance(hit.hit_point_mm, hit.surface_point_mm) : kInfinity);
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  if (problem.view.projection == MapProjection::parallel) return std::min(*middle, problem.view.far_mm);
  // All on one side of the viewpoint, or else infinitely far.
  double side = 0;
  for (const std::size_t i : problem.facing) {
    const glm::dvec3 p = problem.hits[i].surface_point_mm + *middle * problem.hits[i].direction;
    const glm::dvec3 towards = p - problem.view.viewpoint_mm;
    const double depth = glm::dot(towards, problem.view.direction);
    if (side == 0) side = depth < 0 && problem.view.zooms() ? -1 : 1;
    if (!(side * depth > kGrazing * glm::length(towards))) return kInfinity;
    if (side < 0 && !(-depth > problem.view.zooming_near_mm)) return kInfinity;
  }
  return *middle;
}

// How the place of the map (in lengths) changes while the eye's ray moves from the vertex: a matrix that
// takes the movement of a point of the ray near the vertex, mm.
glm::dmat3x2 map_jacobian(const MapProblem& problem, std::size_t i, double distance_mm) {
  const VertexHit& hit = problem.hits[i];
  const VirtualView& view = problem.view;
  const bool far = !std::isfinite(distance_mm);
  const glm::dvec3 h = far ? view.project_direction(hit.direction)
                           : view.project_point(hit.surface_point_mm + distance_mm * hit.direction);
  const glm::dvec2 sides{view.right_side - view.left, view.top - view.bottom}, lower{view.left, view.bottom};
  const glm::dvec2 place = glm::dvec2(h) / h.z * sides + lower;

  glm::dmat3x2 jacobian{};
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3& turned = hit.differential.direction[axis];
    const glm::dvec3 moved = far ? turned : hit.differential.point[axis] + distance_mm * turned;
    // A place is (right, up) / depth; at a parallel projection the depth is 1 whatever moves.
    const double d_depth =
        view.projection == MapProjection::perspective ? glm::dot(moved, view.direction) : 0.0;
    jacobian[axis] =
        (glm::dvec2(glm::dot(moved, view.right), glm::dot(moved, view.up)) - d_depth * place) / h.z;
  }
  return jacobian;
}

struct EdgeRatio {
  std::size_t a, b;  // indices into `facing`
  double log_ratio;  // wanted ln q_b - ln q_a
  double weight;
};

// The mean of what the two ends of an edge ask for, or twice the smaller where they differ by more than that,
// or 0 where they disagree in sign. A curvature that jumps at a vertex (two faces joined smoothly, a knot of
// a B-spline) is the wrong one for the edges on its other side, and asks for far too much there. Source: the
// monotonised central limiter of van Leer, Journal of Computational Physics 23, 1977.
double limited_mean(double x, double y) {
  if (x * y <= 0) return 0;
  return std::copysign(std::min({2 * std::abs(x), 2 * std::abs(y), 0.5 * std::abs(x + y)}), x);
}

// With q_a and q_b at its ends, an edge shows m(x) = ((1 - x) q_a m_a + x q_b m_b) / ((1 - x) q_a + x q_b),
// so that m'(0) = q_b / q_a (m_b - m_a) and m'(1) = q_a / q_b (m_b - m_a). Each end's exact derivative, along
// m_b - m_a, thus asks for a ratio. On a planar mirror both ask for the same, and so do all edges together.
std::vector<EdgeRatio> edge_ratios(const MapProblem& problem, std::span<const MapSample> samples,
                                   double distance_mm) {
  const auto& vertices = problem.mesh.vertices;
  std::vector<std::size_t> index(vertices.size(), vertices.size());
  std::vector<glm::dmat3x2> jacobians;
  for (std::size_t k = 0; k < problem.facing.size(); ++k) {
    index[problem.facing[k]] = k;
    jacobians.push_back(map_jacobian(problem, problem.facing[k], distance_mm));
  }
  std::vector<EdgeRatio> edges;
  for (const auto& triangle : problem.mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::size_t i = triangle.vertices[k], j = triangle.vertices[(k + 1) % 3];
      if (index[i] == vertices.size() || index[j] == vertices.size()) continue;
      const glm::dvec3 chord = vertices[j].position_mm - vertices[i].position_mm;
      const glm::dvec2 step = samples[index[j]].map - samples[index[i]].map;
      const double start = glm::dot(jacobians[index[i]] * chord, step);
      const double end = glm::dot(jacobians[index[j]] * chord, step);
      // Across a caustic, where the map turns back, no ratio fits. Otherwise the error at the edge's middle
      // is step / 4 times that of the ratio's logarithm.
      if (!(start > 0 && end > 0)) continue;
      const double square = glm::dot(step, step);
      const double log_ratio = limited_mean(std::log(start / square), std::log(square / end));
      edges.push_back({index[i], index[j], std::clamp(log_ratio, -1.0, 1.0), square});
    }
  return edges;
}

// Changes `x` = ln q to minimise sum weight (x_b - x_a - log_ratio)^2 by conjugate gradients (Hestenes and
// Stiefel 1952), preconditioned by the diagonal. A relative residual of 1e-4 is below what the ratios
// themselves are good for.
void fit_logarithms(std::span<const EdgeRatio> edges, std::vector<double>& x) {
  constexpr int kMaxIterations = 200;
  // Ratios smaller than this are rounding: a change of q by 1e-8 moves what an edge shows by less than 1e-8
  // of its length. To go after them would not end: the system has a null space (all x moved alike), along
  // which noise grows from step to step.
  constexpr double kSmallestRatio = 1e-8;
  const std::size_t n = x.size();
  std::vector<double> diagonal(n, 0.0), residual(n, 0.0), z(n), direction(n, 0.0), product(n);
  double scale = 0;
  for (const auto& [a, b, log_ratio, weight] : edges) {
    const double pull = weight * (log_ratio - (x[b] - x[a]));
    diagonal[a] += weight;
    diagonal[b] += weight;
    residual[a] -= pull;
    residual[b] += pull;
    scale += weight * std::max(log_ratio * log_ratio, kSmallestRatio * kSmallestRatio);
  }
  double last = 0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    double now = 0;
    for (std::size_t i = 0; i < n; ++i) {
      z[i] = diagonal[i] > 0 ? residual[i] / diagonal[i] : 0.0;
      now += residual[i] * z[i];
    }
    if (!(now > 1e-8 * scale)) return;
    const double beta = iteration > 0 ? now / last : 0.0;
    for (std::size_t i = 0; i < n; ++i) direction[i] = z[i] + beta * direction[i];
    std::ranges::fill(product, 0.0);
    for (const EdgeRatio& edge : edges) {
      const double flow = edge.weight * (direction[edge.b] - direction[edge.a]);
      product[edge.b] += flow;
      product[edge.a] -= flow;
    }
    double curvature = 0;
    for (std::size_t i = 0; i < n; ++i) curvature += direction[i] * product[i];
    if (!(curvature > 0)) return;
    const double step = now / curvature;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += step * direction[i];
      residual[i] -= step * product[i];
    }
    last = now;
  }
}

}  // namespace

glm::dvec3 shown_at_vertex(const VertexHit& hit, const VirtualView& view) {
  return hit.scene_hit ? project(hit.hit_point_mm, hit, view) : shown_at(hit, kInfinity, view);
}

std::vector<double> homography_denominators(const MapProblem& problem) {
  const auto places = tangent_plane_places(problem);
  std::vector<MapSample> samples;
  for (std::size_t k = 0; k < places.size(); ++k)
    samples.push_back(
        {places[k].plane,
         in_lengths(shown_at_vertex(problem.hits[problem.facing[k]], problem.view), problem.view)});
  return denominators_of(places, samples);
}

std::vector<double> fitted_denominators(const MapProblem& problem) {
  const ViewpointFit eye = eye_of(problem);
  if (eye.parallel) return homography_denominators(problem);
  const double distance = usual_distance(problem);
  const auto places = eye_places(problem, eye.viewpoint_mm);
  std::vector<MapSample> samples;
  for (std::size_t k = 0; k < places.size(); ++k)
    samples.push_back(
        {places[k].plane,
         in_lengths(shown_at(problem.hits[problem.facing[k]], distance, problem.view), problem.view)});
  // The homography is the solution for a plane, and a good start otherwise.
  std::vector<double> q = denominators_of(places, samples);
  for (double& value : q) value = std::log(value);
  fit_logarithms(edge_ratios(problem, samples, distance), q);
  for (double& value : q) value = std::exp(value);
  return q;
}

}  // namespace catoptra::optics
