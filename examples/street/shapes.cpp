#include "examples/street/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <utility>

namespace catoptra::examples {
namespace {

std::uint32_t add_vertex(Surface& surface, const glm::vec3& position, const glm::vec3& normal,
                         glm::vec2 texture = {}) {
  surface.vertices.push_back({position, normal, texture});
  return static_cast<std::uint32_t>(surface.vertices.size()) - 1;
}

/// Two unit vectors u, v with u x v = n.
struct Axes {
  glm::vec3 u, v;
};
Axes axes_across(const glm::vec3& n) {
  const glm::vec3 helper = std::abs(n.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  const glm::vec3 u = glm::normalize(glm::cross(helper, n));
  return {u, glm::cross(n, u)};
}

glm::vec2 circle(int step, int segments) {
  const float angle = glm::two_pi<float>() * float(step) / float(segments);
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

void add_quad(Model& model, const std::string& material, const glm::vec3& lower_left,
              const glm::vec3& lower_right, const glm::vec3& upper_right, const glm::vec3& upper_left,
              const TextureRect& t) {
  Surface& surface = model.surfaces[material];
  const glm::vec3 normal = glm::normalize(glm::cross(upper_right - lower_left, upper_left - lower_right));
  const auto a = add_vertex(surface, lower_left, normal, {t.left, t.bottom});
  add_vertex(surface, lower_right, normal, {t.right, t.bottom});
  add_vertex(surface, upper_right, normal, {t.right, t.top});
  add_vertex(surface, upper_left, normal, {t.left, t.top});
  surface.indices.insert(surface.indices.end(), {a, a + 1, a + 2});
  if (upper_right != upper_left) surface.indices.insert(surface.indices.end(), {a, a + 2, a + 3});
}

void add_tiled_quad(Model& model, const std::string& material, const glm::vec3& lower_left,
                    const glm::vec3& lower_right, const glm::vec3& upper_right, const glm::vec3& upper_left,
                    float repeat_m) {
  const float width = glm::distance(lower_left, lower_right), height = glm::distance(lower_left, upper_left);
  add_quad(model, material, lower_left, lower_right, upper_right, upper_left,
           {0, 0, width / repeat_m, height / repeat_m});
}

void add_panel(Model& model, const std::string& material, const glm::vec3& centre, float heading_deg,
               glm::vec2 size) {
  const float angle = glm::radians(heading_deg);
  // Seen from the front of a panel that faces +y, the picture's right is -x.
  const glm::vec3 right = -glm::vec3(std::cos(angle), std::sin(angle), 0) * (size.x / 2);
  const glm::vec3 up(0, 0, size.y / 2);
  add_quad(model, material, centre - right - up, centre + right - up, centre + right + up,
           centre - right + up);
}

void add_box(Model& model, const std::string& material, const glm::vec3& l, const glm::vec3& h) {
  add_quad(model, material, {h.x, h.y, l.z}, {l.x, h.y, l.z}, {l.x, h.y, h.z}, {h.x, h.y, h.z});  // +y
  add_quad(model, material, {l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z});  // -y
  add_quad(model, material, {h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z}, {h.x, l.y, h.z});  // +x
  add_quad(model, material, {l.x, h.y, l.z}, {l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z});  // -x
  add_quad(model, material, {l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z});  // top
  add_quad(model, material, {l.x, h.y, l.z}, {h.x, h.y, l.z}, {h.x, l.y, l.z}, {l.x, l.y, l.z});  // bottom
}

void add_lathe(Model& model, const std::string& material, const glm::vec3& foot,
               const std::vector<glm::vec2>& profile, int segments) {
  const int rows = static_cast<int>(profile.size());
  add_sheet(
      model, segments + 1, rows,
      [&](int i, int j) {
        const glm::vec2 around = circle(i % segments, segments) * profile[static_cast<std::size_t>(j)].x;
        return foot + glm::vec3(around, profile[static_cast<std::size_t>(j)].y);
      },
      [&](int, int) { return material; });
}

void add_bar(Model& model, const std::string& material, const glm::vec3& from, const glm::vec3& to,
             float radius, int segments) {
  Surface& surface = model.surfaces[material];
  const glm::vec3 along = glm::normalize(to - from);
  const auto [u, v] = axes_across(along);
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (int i = 0; i <= segments; ++i) {
    const glm::vec2 c = circle(i % segments, segments);
    const glm::vec3 out = u * c.x + v * c.y;
    add_vertex(surface, from + out * radius, out, {float(i) / float(segments), 1});
    add_vertex(surface, to + out * radius, out, {float(i) / float(segments), 0});
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(segments); ++i) {
    const std::uint32_t a = first + 2 * i;
    surface.indices.insert(surface.indices.end(), {a, a + 2, a + 3, a, a + 3, a + 1});
  }
}

void add_disc(Model& model, const std::string& material, const glm::vec3& centre, const glm::vec3& normal,
              float radius, int segments) {
  Surface& surface = model.surfaces[material];
  const auto [u, v] = axes_across(normal);
  const auto middle = add_vertex(surface, centre, normal, {0.5f, 0.5f});
  for (int i = 0; i < segments; ++i) {
    const glm::vec2 c = circle(i, segments);
    add_vertex(surface, centre + (u * c.x + v * c.y) * radius, normal, {0.5f + c.x / 2, 0.5f - c.y / 2});
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(segments); ++i) {
    const std::uint32_t next = (i + 1) % static_cast<std::uint32_t>(segments);
    surface.indices.insert(surface.indices.end(), {middle, middle + 1 + i, middle + 1 + next});
  }
}

void add_sheet(Model& model, int columns, int rows, const std::function<glm::vec3(int, int)>& point,
               const std::function<std::string(int, int)>& material) {
  // A closed sheet repeats its first column as its last: then the seam's normals look across it.
  const bool closed = glm::distance(point(0, rows / 2), point(columns - 1, rows / 2)) < 1e-6f;
  const auto at = [&](int i, int j) {
    if (closed) i = (i + columns - 1) % (columns - 1);
    return point(std::clamp(i, 0, columns - 1), std::clamp(j, 0, rows - 1));
  };
  const auto vertex = [&](int i, int j) {
    const glm::vec3 normal = glm::cross(at(i + 1, j) - at(i - 1, j), at(i, j + 1) - at(i, j - 1));
    const float length = glm::length(normal);
    return Vertex{at(i, j),
                  length > 0 ? normal / length : glm::vec3(0, 0, 1),
                  {float(i) / float(columns - 1), 1 - float(j) / float(rows - 1)}};
  };
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) {
      const std::string name = material(i, j);
      if (name.empty()) continue;
      Surface& surface = model.surfaces[name];
      const auto a = static_cast<std::uint32_t>(surface.vertices.size());
      for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        surface.vertices.push_back(vertex(i + di, j + dj));
      const auto different = [](const glm::vec3& p, const glm::vec3& q) {
        return glm::distance(p, q) > 1e-6f;
      };
      if (different(at(i + 1, j), at(i, j))) surface.indices.insert(surface.indices.end(), {a, a + 1, a + 2});
      if (different(at(i + 1, j + 1), at(i, j + 1)))
        surface.indices.insert(surface.indices.end(), {a, a + 2, a + 3});
    }
}

}  // namespace catoptra::examples
