#include "examples/street/cockpit.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <string>

#include "examples/street/flank.h"
#include "examples/street/shapes.h"

namespace catoptra::examples {
namespace {

constexpr float kLeft = -0.49f, kRight = 1.23f, kMiddle = 0.37f;

/// A sheet from the left to the right of the car along a profile of (y, z), seen from the driver's side.
template <std::size_t kRows>
void add_across(Model& car, const std::string& paint, const std::array<glm::vec2, kRows>& profile,
                float crown) {
  constexpr int kColumns = 13;
  add_sheet(
      car, kColumns, int(kRows),
      [&](int i, int j) {
        const float s = 2 * float(i) / (kColumns - 1) - 1;  // -1 .. 1 across
        const glm::vec2 p = profile[std::size_t(j)];
        return glm::vec3(kMiddle + s * (kRight - kLeft) / 2, p.x - crown * s * s, p.y - 0.3f * crown * s * s);
      },
      [&](int, int) { return paint; });
}

void add_wheel(Model& car) {
  const glm::vec3 hub(0, 0.44f, 0.86f), across(1, 0, 0), up = glm::normalize(glm::vec3(0, 0.45f, 0.893f));
  constexpr int kSegments = 32;
  constexpr float kRadius = 0.19f;
  const auto rim = [&](int i) {
    const float angle = glm::two_pi<float>() * float(i % kSegments) / kSegments;
    return hub + kRadius * (std::cos(angle) * across + std::sin(angle) * up);
  };
  for (int i = 0; i < kSegments; ++i) add_bar(car, "trim", rim(i), rim(i + 1), 0.015f, 8);
  for (const int i : {0, 16, 24}) add_bar(car, "trim", hub, rim(i), 0.018f, 8);
  add_disc(car, "metal", hub - glm::vec3(0, 0.02f, -0.01f), glm::cross(across, up), 0.06f, 20);
}

/// The inside of a door up to the window's edge.
void add_door(Model& car, float x, float side) {
  const auto quad = [&](const char* paint, float inwards, float z0, float z1) {
    const float y0 = side < 0 ? -0.6f : 1.0f, y1 = side < 0 ? 1.0f : -0.6f;
    const float at = x - side * inwards;
    add_quad(car, paint, {at, y0, z0}, {at, y1, z0}, {at, y1, z1}, {at, y0, z1});
  };
  quad("upholstery", 0.0f, 0.4f, 0.80f);
  quad("trim", 0.02f, 0.80f, 0.93f);
}

}  // namespace

Model make_cockpit() {
  Model car = make_flank(true);
  add_across(car, "trim",
             std::array<glm::vec2, 5>{
                 {{0.60f, 0.55f}, {0.58f, 0.82f}, {0.64f, 0.88f}, {0.80f, 0.91f}, {1.02f, 0.90f}}},
             0.05f);
  add_across(car, "own car",
             std::array<glm::vec2, 4>{{{1.06f, 0.90f}, {1.45f, 0.88f}, {1.85f, 0.82f}, {2.10f, 0.72f}}},
             0.12f);
  add_box(car, "upholstery", {-0.20f, 0.56f, 0.86f}, {0.20f, 0.74f, 0.96f});  // over the instruments
  add_wheel(car);
  for (const auto& [low, high] : {std::array{kLeft + 0.02f, -0.35f}, {kRight - 0.02f, 1.09f}})
    add_bar(car, "trim", {low, 1.02f, 0.93f}, {high, 0.40f, 1.42f}, 0.035f, 10);
  add_box(car, "upholstery", {-0.36f, 0.24f, 1.405f}, {1.10f, 0.42f, 1.45f});           // header
  add_bar(car, "trim", {kMiddle, 0.555f, 1.352f}, {kMiddle, 0.42f, 1.42f}, 0.010f, 8);  // carries the mirror
  add_door(car, kLeft, -1);
  add_door(car, kRight, 1);
  add_bar(car, "trim", {1.09f, 0.40f, 1.42f}, {1.09f, -0.6f, 1.42f}, 0.03f,
          8);  // over the right door's window
  return car;
}

}  // namespace catoptra::examples
