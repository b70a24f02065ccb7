// What every model of the examples keeps to.
#pragma once

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <string>

#include "examples/street/model.h"

namespace catoptra::test {

/// Every triangle refers to vertices that exist and has an area of more than `least_area` (m^2); every normal
/// is a unit vector; every paint is known, and so is its texture.
inline void expect_sound(const examples::Model& model, const examples::Palette& palette, float least_area) {
  for (const auto& [name, surface] : model.surfaces) {
    ASSERT_TRUE(palette.paints.contains(name)) << name;
    const std::string& texture = palette.paints.at(name).texture;
    ASSERT_TRUE(texture.empty() || palette.textures.contains(texture)) << name;
    ASSERT_EQ(surface.indices.size() % 3, 0u);
    for (const examples::Vertex& vertex : surface.vertices)
      ASSERT_NEAR(glm::length(vertex.normal), 1, 1e-5) << name;  // single precision
    for (std::size_t i = 0; i < surface.indices.size(); i += 3) {
      glm::vec3 corner[3];
      for (std::size_t k = 0; k < 3; ++k) corner[k] = surface.vertices.at(surface.indices[i + k]).position;
      ASSERT_GT(glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0])) / 2, least_area)
          << name;
    }
  }
}

}  // namespace catoptra::test
