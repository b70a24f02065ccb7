// The shapes that the street is built from. Lengths in metres; faces run counter-clockwise seen from outside.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "examples/street/model.h"

namespace catoptra::examples {

/// A rectangle of texture coordinates: left, top, right, bottom.
struct TextureRect {
  float left = 0, top = 0, right = 1, bottom = 1;
};

/// A flat quadrilateral: lower left, lower right, upper right, upper left as seen from outside. Equal upper
/// corners make a triangle.
void add_quad(Model& model, const std::string& material, const glm::vec3& lower_left,
              const glm::vec3& lower_right, const glm::vec3& upper_right, const glm::vec3& upper_left,
              const TextureRect& texture = {});

/// A quad whose texture repeats every `repeat_m` metres along its lower and left sides.
void add_tiled_quad(Model& model, const std::string& material, const glm::vec3& lower_left,
                    const glm::vec3& lower_right, const glm::vec3& upper_right, const glm::vec3& upper_left,
                    float repeat_m);

/// An upright rectangle, `size` = width and height, that faces `heading_deg` (0: +y, 90: -x), with its
/// picture the right way round for one who stands before it.
void add_panel(Model& model, const std::string& material, const glm::vec3& centre, float heading_deg,
               glm::vec2 size);

/// Six faces between the corners `low` and `high`; each face shows the whole texture.
void add_box(Model& model, const std::string& material, const glm::vec3& low, const glm::vec3& high);

/// A surface of revolution about the upright axis through `foot`: (radius, height) from bottom to top, smooth
/// normals.
void add_lathe(Model& model, const std::string& material, const glm::vec3& foot,
               const std::vector<glm::vec2>& profile, int segments);

/// A round bar from `from` to `to` without caps.
void add_bar(Model& model, const std::string& material, const glm::vec3& from, const glm::vec3& to,
             float radius, int segments);

/// A disc around `centre` that faces `normal`; one texture over its square.
void add_disc(Model& model, const std::string& material, const glm::vec3& centre, const glm::vec3& normal,
              float radius, int segments);

/// A smooth sheet of columns x rows points: `point(i, j)` with i to the right and j up as seen from outside.
/// `material(i, j)` names the paint of the cell above and to the right of point (i, j); an empty name leaves
/// a hole.
void add_sheet(Model& model, int columns, int rows, const std::function<glm::vec3(int, int)>& point,
               const std::function<std::string(int, int)>& material);

}  // namespace catoptra::examples
