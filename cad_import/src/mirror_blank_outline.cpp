// Outlines of mirror glasses: the file of corners and the checks of a polygon.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>
#include <string>

#include "cad_import/mirror_blank.h"
#include "cad_import/src/mirror_blank_parts.h"

namespace catoptra::cad_import {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Sides a-b and c-d have a point in common.
bool sides_meet(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  const double c_side = cross(b - a, c - a), d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c), b_side = cross(d - c, b - c);
  if (c_side * d_side > 0 || a_side * b_side > 0) return false;
  // Collinear sides meet only where their boxes overlap.
  return std::max(std::min(a.x, b.x), std::min(c.x, d.x)) <=
             std::min(std::max(a.x, b.x), std::max(c.x, d.x)) &&
         std::max(std::min(a.y, b.y), std::min(c.y, d.y)) <= std::min(std::max(a.y, b.y), std::max(c.y, d.y));
}

glm::dvec2 read_corner(std::string line, const std::filesystem::path& file, std::size_t number) {
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == ',' || c == ';' || c == '\t'; }, ' ');
  std::istringstream words(line);
  words.imbue(std::locale::classic());
  glm::dvec2 corner{0};
  std::string rest;
  if (!(words >> corner.x >> corner.y) || words >> rest || !std::isfinite(corner.x) ||
      !std::isfinite(corner.y))
    throw ImportError(file.string(), "line " + std::to_string(number), "is not a corner",
                      "write \"x y\" in mm");
  return corner;
}

}  // namespace

void check_polygon(std::span<const glm::dvec2> corners) {
  const std::size_t n = corners.size();
  if (n < 3) throw Error("mirror", "outline", "a polygon needs at least three corners");
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec2 &a = corners[i], &b = corners[(i + 1) % n];
    const std::string name = "outline corner " + std::to_string(i + 1);
    if (!std::isfinite(a.x) || !std::isfinite(a.y)) throw Error("mirror", name, "is not finite");
    if (a == b) throw Error("mirror", name, "is repeated");
    const glm::dvec2& c = corners[(i + 2) % n];
    if (cross(b - a, c - b) == 0 && glm::dot(b - a, c - b) < 0)
      throw Error("mirror", name, "the outline runs back on itself");
    for (std::size_t k = i + 2; k < n; ++k)
      if ((k + 1) % n != i && sides_meet(a, b, corners[k], corners[(k + 1) % n]))
        throw Error("mirror", name, "the outline crosses itself at side " + std::to_string(k + 1));
  }
}

std::vector<glm::dvec2> read_outline(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw ImportError(file.string(), "", "cannot be opened");
  std::vector<glm::dvec2> corners;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    line.erase(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    corners.push_back(read_corner(line, file, number));
  }
  if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  if (corners.size() < 3) throw ImportError(file.string(), "", "an outline needs at least three corners");
  return corners;
}

}  // namespace catoptra::cad_import
