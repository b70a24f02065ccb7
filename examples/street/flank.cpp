#include "examples/street/flank.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "examples/street/shapes.h"

namespace catoptra::examples {
namespace {

/// Height, and how far the side stands in from its widest place, from the sill to the roof.
constexpr std::array<glm::vec2, 10> kSide = {{{0.20f, 0.060f},
                                              {0.30f, 0.015f},
                                              {0.46f, 0.000f},
                                              {0.66f, 0.002f},
                                              {0.80f, 0.010f},
                                              {0.90f, 0.030f},
                                              {0.94f, 0.045f},
                                              {1.38f, 0.190f},
                                              {1.45f, 0.250f},
                                              {1.49f, 0.420f}}};
constexpr int kBeltRow = 6;  // the row of kSide from which the windows rise

/// Places along the car, from the rear bumper to the front door's front edge. Between [i] and [i + 1]: is
/// there a window?
struct Cut {
  float y;
  enum Window { none, pane, open } window;
  bool seam = false;  ///< a door's edge
};
constexpr std::array<Cut, 21> kCuts = {{{-3.40f, Cut::none},       {-3.38f, Cut::none}, {-3.30f, Cut::none},
                                        {-3.15f, Cut::none},       {-2.90f, Cut::none}, {-2.60f, Cut::none},
                                        {-2.35f, Cut::none},       {-2.10f, Cut::none}, {-1.75f, Cut::pane},
                                        {-1.20f, Cut::pane, true}, {-1.19f, Cut::pane}, {-0.60f, Cut::pane},
                                        {-0.22f, Cut::none, true}, {-0.21f, Cut::none}, {-0.08f, Cut::open},
                                        {0.20f, Cut::open},        {0.40f, Cut::open},  {0.60f, Cut::open},
                                        {0.86f, Cut::none, true},  {0.87f, Cut::none},  {1.30f, Cut::none}}};

constexpr int kPillar = 15;  // the cut from which the windscreen's pillar rises

glm::vec3 side_point(int i, int j) {
  const float y = kCuts[static_cast<std::size_t>(i)].y;
  const glm::vec2 section = kSide[static_cast<std::size_t>(j)];
  // The rear corner is rounded in plan, and the boot's lid is lower than the roof.
  const float corner = std::max(0.0f, -2.75f - y) / 0.65f, boot = std::clamp((-1.75f - y) / 0.7f, 0.0f, 1.0f);
  const float round = 0.42f * (1 - std::sqrt(std::max(0.0f, 1 - corner * corner)));
  const float height = section.x <= 0.94f ? section.x : 0.94f + (section.x - 0.94f) * (1 - 0.92f * boot);
  return {kFlank + section.y + round, y, height};
}

/// The same with everything above the belt lowered, towards the belt, to the windscreen's slope.
glm::vec3 side_point_below_windscreen(int i, int j) {
  glm::vec3 point = side_point(i, j);
  if (j <= kBeltRow) return point;
  const float roof = kSide.back().x, belt = kSide[kBeltRow].x, slope = (1.41f - 0.94f) / (1.02f - 0.40f);
  const float highest = 1.41f - slope * (point.y - 0.40f);
  const float share = std::clamp((highest - belt) / (roof - belt), 0.02f, 1.0f);
  if (share < 1) point.x = std::min(point.x, kFlank + 0.20f);  // no roof there: a pillar
  const glm::vec3 foot = side_point(i, kBeltRow);
  return foot + share * (point - foot);
}

std::string side_paint(int i, int j) {
  const Cut& cut = kCuts[static_cast<std::size_t>(i)];
  if (j == 0) return "trim";
  if (cut.seam && j < kBeltRow) return "trim";
  if (j == kBeltRow && cut.window == Cut::open) return "";
  if (j == kBeltRow && cut.window == Cut::pane) return "car glass";
  if (j == kBeltRow - 1 && cut.window != Cut::none) return "trim";
  return j == 1 ? "own car shade" : "own car";
}

void add_rear_wheel(Model& car) {
  const glm::vec3 out(-1, 0, 0), hub(kFlank - 0.004f, -2.45f, 0.315f);
  add_disc(car, "trim", hub + glm::vec3(0, 0, 0.03f), out, 0.385f, 24);
  add_disc(car, "tyre", hub + 0.010f * out, out, 0.315f, 24);
  add_disc(car, "rim", hub + 0.016f * out, out, 0.205f, 16);
  add_disc(car, "trim", hub + 0.020f * out, out, 0.05f, 8);
}

}  // namespace

Model make_flank(bool to_windscreen) {
  Model car;
  // Seen from the left, the car's front is on the left: columns run backwards.
  constexpr int kColumns = static_cast<int>(kCuts.size());
  add_sheet(
      car, kColumns, static_cast<int>(kSide.size()),
      [&](int i, int j) {
        return to_windscreen ? side_point_below_windscreen(kColumns - 1 - i, j)
                             : side_point(kColumns - 1 - i, j);
      },
      [&](int i, int j) -> std::string {
        const std::string paint = side_paint(kColumns - 2 - i, j);
        // Seen from inside: the lining of the pillar.
        return to_windscreen && j > kBeltRow && kColumns - 2 - i >= kPillar ? "trim" : paint;
      });
  add_rear_wheel(car);
  for (const float y : {-0.02f, -1.02f}) {  // door handles
    add_box(car, "trim", {kFlank - 0.002f, y - 0.13f, 0.795f}, {kFlank + 0.012f, y + 0.10f, 0.845f});
    add_box(car, "own car", {kFlank - 0.032f, y - 0.12f, 0.810f}, {kFlank - 0.014f, y + 0.09f, 0.832f});
  }
  add_box(car, "tail light", {kFlank + 0.10f, -3.36f, 0.66f}, {kFlank + 0.20f, -3.12f, 0.84f});
  add_box(car, "rim", {kFlank - 0.010f, -3.0f, 0.50f}, {kFlank + 0.02f, 0.84f, 0.525f});  // a bright strip
  return car;
}

Model make_cabin() {
  constexpr float kLeft = -0.36f, kRight = 1.10f, kMiddle = 0.37f;
  Model cabin;
  for (const float x : {kMiddle - 0.37f, kMiddle + 0.37f}) {  // rear head rests
    add_box(cabin, "upholstery", {x - 0.12f, -1.32f, 1.02f}, {x + 0.12f, -1.22f, 1.17f});
  }
  add_box(cabin, "upholstery", {kLeft, -1.40f, 0.60f}, {kRight, -1.20f, 1.00f});
  // The rear window's frame leans forward; its opening is what the interior mirror looks through.
  const float low = 1.02f, high = 1.41f, y_low = -1.95f, y_high = -1.60f;
  const auto frame = [&](float x0, float x1, float z0, float z1) {
    const auto y = [&](float z) { return y_low + (z - low) / (high - low) * (y_high - y_low); };
    add_quad(cabin, "trim", {x1, y(z0), z0}, {x0, y(z0), z0}, {x0, y(z1), z1}, {x1, y(z1), z1});
  };
  frame(kLeft - 0.2f, kLeft, 0.80f, 1.47f);
  frame(kRight, kRight + 0.2f, 0.80f, 1.47f);
  frame(kLeft, kRight, high, 1.47f);
  frame(kLeft, kRight, 0.80f, low);
  add_quad(cabin, "upholstery", {kLeft, 0.3f, 1.44f}, {kRight, 0.3f, 1.44f}, {kRight, -1.6f, 1.42f},
           {kLeft, -1.6f, 1.42f});
  return cabin;
}

Model make_housing(float width_m, float height_m, float radius_m) {
  constexpr int kAround = 48;
  // Rings from the glass's edge outwards and then back: growth beyond the glass and depth behind its edge.
  constexpr std::array<glm::vec2, 8> kRings = {{{0.0005f, 0.0040f},
                                                {0.0025f, 0.0008f},
                                                {0.0070f, 0.0010f},
                                                {0.0105f, 0.0060f},
                                                {0.0120f, 0.0150f},
                                                {0.0060f, 0.0400f},
                                                {-0.0180f, 0.0620f},
                                                {-0.0420f, 0.0700f}}};
  Model shell;
  const auto ring_point = [&](int i, int j) {
    const glm::vec2 ring = kRings[static_cast<std::size_t>(j)];
    const float angle = glm::two_pi<float>() * float(i % kAround) / kAround;
    // A superellipse of power 4.4 follows a rectangle with well rounded corners.
    const auto power = [](float c) { return std::copysign(std::pow(std::abs(c), 2 / 4.4f), c); };
    const float x = (width_m / 2 + ring.x) * power(std::cos(angle)),
                y = (height_m / 2 + ring.x) * power(std::sin(angle));
    const float curvature = radius_m == 0 ? 0 : 1 / radius_m, r2 = x * x + y * y;
    const float sag = curvature * r2 / (1 + std::sqrt(1 - curvature * curvature * r2));
    return glm::vec3(x, y, -sag - ring.y);
  };
  // Seen from the glass's side the rings grow outwards: clockwise columns make the outside the front.
  add_sheet(
      shell, kAround + 1, static_cast<int>(kRings.size()),
      [&](int i, int j) { return ring_point(kAround - i, j); },
      [](int, int j) { return j < 3 ? "trim" : "own car"; });
  const auto back = static_cast<int>(kRings.size()) - 1;
  const float depth = ring_point(0, back).z;
  add_quad(shell, "own car", {width_m / 2 - 0.045f, -height_m / 2 + 0.045f, depth},
           {-width_m / 2 + 0.045f, -height_m / 2 + 0.045f, depth},
           {-width_m / 2 + 0.045f, height_m / 2 - 0.045f, depth},
           {width_m / 2 - 0.045f, height_m / 2 - 0.045f, depth});
  return shell;
}

}  // namespace catoptra::examples
