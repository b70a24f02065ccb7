// Outlines of blanks: the file of corners, the checks of a polygon, and the pieces of a boundary.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <sstream>
#include <string>

#include "cad_import/outline.h"
#include "cad_import/src/blank_parts.h"

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

void check_polygon(std::span<const glm::dvec2> corners, const std::string& subject) {
  const std::size_t n = corners.size();
  if (n < 3) throw Error(subject, "outline", "a polygon needs at least three corners");
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec2 &a = corners[i], &b = corners[(i + 1) % n];
    const std::string name = "outline corner " + std::to_string(i + 1);
    if (!std::isfinite(a.x) || !std::isfinite(a.y)) throw Error(subject, name, "is not finite");
    if (a == b) throw Error(subject, name, "is repeated");
    const glm::dvec2& c = corners[(i + 2) % n];
    if (cross(b - a, c - b) == 0 && glm::dot(b - a, c - b) < 0)
      throw Error(subject, name, "the outline runs back on itself");
    for (std::size_t k = i + 2; k < n; ++k)
      if ((k + 1) % n != i && sides_meet(a, b, corners[k], corners[(k + 1) % n]))
        throw Error(subject, name, "the outline crosses itself at side " + std::to_string(k + 1));
  }
}

OutlineBox box_of(std::span<const glm::dvec2> corners) {
  OutlineBox box{corners.front(), corners.front()};
  for (const glm::dvec2& p : corners) {
    box.min = glm::min(box.min, p);
    box.max = glm::max(box.max, p);
  }
  return box;
}

std::vector<OutlinePiece> polygon_pieces(std::vector<glm::dvec2> corners) {
  double twice_area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    twice_area += a.x * b.y - a.y * b.x;
  }
  if (twice_area < 0) corners = {corners.rbegin(), corners.rend()};
  std::vector<OutlinePiece> pieces;
  for (std::size_t i = 0; i < corners.size(); ++i)
    pieces.push_back({corners[i], corners[(i + 1) % corners.size()], {}, 0});
  return pieces;
}

std::vector<OutlinePiece> rounded_pieces(const OutlineBox& box, double radius) {
  const glm::dvec2 in_min = box.min + radius, in_max = glm::max(box.max - radius, in_min);
  const glm::dvec2 centres[4]{{in_max.x, in_min.y}, in_max, {in_min.x, in_max.y}, in_min};
  const glm::dvec2 directions[4]{{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
  std::vector<OutlinePiece> pieces;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec2 begin = centres[i] + radius * directions[i];
    const glm::dvec2 end = centres[i] + radius * directions[(i + 1) % 4];
    pieces.push_back({begin, end, centres[i], radius});
    const glm::dvec2 next = centres[(i + 1) % 4] + radius * directions[(i + 1) % 4];
    if (glm::length(next - end) > 1e-6) pieces.push_back({end, next, {}, 0});
  }
  return pieces;
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
