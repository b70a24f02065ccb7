// The example street and car: what the scenes rely on.
#include "examples/street/street.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "examples/street/cockpit.h"
#include "examples/street/flank.h"
#include "examples/street/house.h"
#include "examples/street/interiors.h"
#include "examples/street/palette.h"
#include "examples/street/shapes.h"
#include "tests/support/sound_model.h"

namespace catoptra::examples {
namespace {

/// The smallest part of the models is about a millimetre: no triangle is thinner than a tenth of a square
/// millimetre.
constexpr float kLeastArea = 1e-7f;

TEST(Street, HasAboutTenThousandTriangles) {
  const std::size_t count = make_street().triangle_count();
  EXPECT_GE(count, 8000u);
  EXPECT_LE(count, 12000u);
}

TEST(Street, ModelsAreSound) {
  const Palette palette = make_palette(CATOPTRA_SIGN_FONT);
  for (const Model& model :
       {make_street(), make_flank(), make_flank(true), make_cabin(), make_cockpit(), make_wall(),
        make_housing(0.17f, 0.11f, 1.2f), make_shop_row(), make_window_front()})
    test::expect_sound(model, palette, kLeastArea);
}

TEST(Street, LeavesTheDriversCarRoom) {
  // Nothing that rises above the kerb stands where the car is: 1.0 m left to 1.5 m right of the eye, 3.5 m
  // behind to 1.5 m before.
  for (const auto& [name, surface] : make_street().surfaces)
    for (const Vertex& v : surface.vertices)
      EXPECT_FALSE(v.position.x > -1.0f && v.position.x < 1.5f && v.position.y > -3.5f &&
                   v.position.y < 1.5f && v.position.z > 0.2f)
          << name;
}

TEST(Flank, IsLeftOfTheDriver) {
  for (const auto& [name, surface] : make_flank().surfaces)
    for (const Vertex& v : surface.vertices) {
      EXPECT_LT(v.position.x, 0.37f) << name;           // the middle of the car
      EXPECT_GT(v.position.x, kFlank - 0.05f) << name;  // handles and trim stand out by less than 5 cm
    }
}

TEST(Flank, LeavesTheMirrorInView) {
  // The straight line from the eye to the mirror of door_mirror.toml crosses the car's side within the open
  // window.
  const glm::vec3 eye(0, 0, 1.2f), mirror(-0.66f, 0.56f, 1.02f);
  const Model flanks[] = {make_flank(), make_flank(true)};
  for (const Model& flank : flanks)
    for (const auto& [name, surface] : flank.surfaces)
      for (std::size_t i = 0; i < surface.indices.size(); i += 3) {
        const auto corner = [&](std::size_t k) {
          return surface.vertices[surface.indices[i + k]].position - eye;
        };
        const glm::vec3 ray = mirror - eye;
        const float a = glm::dot(glm::cross(corner(0), corner(1)), ray),
                    b = glm::dot(glm::cross(corner(1), corner(2)), ray),
                    c = glm::dot(glm::cross(corner(2), corner(0)), ray);
        const bool crosses_line = (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
        EXPECT_FALSE(crosses_line && glm::dot(corner(0), ray) > 0 &&
                     glm::length(corner(0)) < glm::length(ray))
            << name;
      }
}

TEST(WindowFront, StaysSmall) {
  EXPECT_LE(make_window_front().triangle_count(), 4000u);
  EXPECT_LE(make_shop_row().triangle_count(), 4000u);
}

TEST(Housing, StaysBehindTheGlass) {
  for (const float radius : {0.3f, 1.2f, 0.0f, -1.2f})
    for (const auto& [name, surface] : make_housing(0.17f, 0.11f, radius).surfaces)
      for (const Vertex& v : surface.vertices) {
        const float r2 = v.position.x * v.position.x + v.position.y * v.position.y;
        const float root = std::sqrt(radius * radius - r2);
        const float glass = radius == 0 ? 0 : radius > 0 ? root - radius : -root - radius;
        EXPECT_LT(v.position.z, glass) << "radius " << radius;
      }
}

TEST(Panel, IsReadFromTheSideItFaces) {
  // One who stands before a panel that faces +y looks along -y and has +x on the left: the picture starts
  // there.
  Model model;
  add_panel(model, "sign", {0, 0, 0}, 0, {2, 1});
  for (const Vertex& v : model.surfaces.at("sign").vertices) {
    EXPECT_FLOAT_EQ(v.texture.x, v.position.x > 0 ? 0.0f : 1.0f);
    EXPECT_FLOAT_EQ(v.texture.y, v.position.z > 0 ? 0.0f : 1.0f);
    EXPECT_NEAR(v.normal.y, 1, 1e-6);
  }
}

}  // namespace
}  // namespace catoptra::examples
