#include "examples/room/spectacles.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string>

#include "examples/street/shapes.h"

namespace catoptra::examples {
namespace {

const char* const kPaint = "spectacle frame";

/// The rims lie so far behind the front vertices: in the middle of the lens's edge.
constexpr float kEdgeDepth = 0.0045f;

/// A torus around the axis y through `centre`.
void add_rim(Model& frame, const std::string& paint, const glm::vec3& centre, float radius, float tube) {
  constexpr int kAround = 49, kAcross = 9;
  add_sheet(
      frame, kAround, kAcross,
      [&](int i, int j) {
        const float a = glm::two_pi<float>() * float(i % (kAround - 1)) / float(kAround - 1);
        const float b = glm::two_pi<float>() * float(j % (kAcross - 1)) / float(kAcross - 1);
        const float r = radius - tube * std::cos(b);  // the sheet's seam lies in the groove
        return centre + glm::vec3(r * std::cos(a), tube * 1.3f * std::sin(b), r * std::sin(a));
      },
      [&](int, int) { return paint; });
}

}  // namespace

Model make_spectacle_frame(const SpectacleSize& size) {
  constexpr float kTube = 0.0020f, kTemple = 0.135f;
  Model frame;
  const float half = size.pupil_distance / 2, radius = size.lens_diameter / 2 + 0.8f * kTube;
  for (const float side : {-1.0f, 1.0f}) {
    add_rim(frame, kPaint, {side * half, -kEdgeDepth, 0}, radius, kTube);
    const float hinge = side * (half + radius + kTube);
    add_box(frame, kPaint, {hinge - 0.004f, -kEdgeDepth - 0.003f, 0.006f},
            {hinge + 0.004f, -kEdgeDepth + 0.003f, 0.012f});
    add_bar(frame, kPaint, {hinge, -kEdgeDepth, 0.009f}, {hinge + side * 0.004f, -kTemple, 0.009f}, 0.0020f,
            10);
  }
  // The bridge: an arched tube between the rims.
  constexpr int kAround = 11, kAlong = 13;
  const float reach = half - radius;
  add_sheet(
      frame, kAround, kAlong,
      [&](int i, int j) {
        const float a = glm::two_pi<float>() * float(i % (kAround - 1)) / float(kAround - 1);
        const float s = 2 * float(j) / float(kAlong - 1) - 1;
        return glm::vec3(s * reach, -kEdgeDepth + 0.002f + kTube * std::cos(a),
                         0.005f + 0.004f * (1 - s * s) + kTube * std::sin(a));
      },
      [](int, int) { return std::string(kPaint); });
  return frame;
}

Model make_hand_lens(float lens_diameter) {
  constexpr float kTube = 0.0025f;
  const float radius = lens_diameter / 2 + 0.8f * kTube;
  Model glass;
  add_rim(glass, "brass", {0, -0.003f, 0}, radius, kTube);
  add_bar(glass, "brass", {0, -0.003f, -radius - 0.02f}, {0, -0.003f, -radius}, 0.003f, 12);
  add_lathe(glass, "shelf wood", {0, -0.003f, -radius - 0.11f},
            {{0.004f, 0}, {0.008f, 0.006f}, {0.007f, 0.05f}, {0.008f, 0.085f}, {0.003f, 0.09f}}, 16);
  return glass;
}

}  // namespace catoptra::examples
