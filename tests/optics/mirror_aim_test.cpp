// Aims whose answer is known by symmetry.
#include "optics/mirror_aim.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "cad_import/error.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::optics {
namespace {

const glm::dvec3 kUp(0, 1, 0), kEye(0, 150, 700);

SightOptions straight_back() {
  SightOptions sight;
  sight.eyes_mm = {kEye};
  sight.road = make_road_frame({0, 0, -1}, kUp, {0, -1000, 0}, kEye);
  return sight;
}

/// A field of 2 x 2 m, symmetric about the line straight back.
const std::vector<GroundPolygon> kZone{{{4000, -400}, {4000, 400}, {6000, 400}, {6000, -400}}};

TEST(MirrorAim, PlaneMirrorTurnedAwayComesBackToTheLineOfSymmetry) {
  const MirrorGlass glass(test::conic_mirror(0, 0, 170, 110, 17, 11), kUp);
  for (const double turned_deg : {-4.0, 3.0}) {
    // The mirror is given turned: its surface is symmetric, so the eye and the road are turned the other way
    // round it.
    SightOptions sight = straight_back();
    const MirrorPose pose = aimed_pose(glass, sight.road, {0, 0, 0}, glm::radians(turned_deg), 0);
    for (glm::dvec3& eye : sight.eyes_mm) eye = pose.to_glass(eye);
    sight.road = make_road_frame(pose.to_glass({0, 0, -1}), kUp, {0, -1000, 0}, sight.eyes_mm[0]);
    const MirrorAim aim = solve_aim(glass, sight, kZone);
    EXPECT_NEAR(glm::degrees(aim.yaw_rad), -turned_deg, 0.02);
    EXPECT_EQ(aim.coverage, 1);
    EXPECT_GT(aim.inside_mm, 0);
    EXPECT_FALSE(aim.at_yaw_stop);
  }
}

TEST(MirrorAim, StopsHold) {
  const MirrorGlass glass(test::conic_mirror(0, 0, 60, 40, 9, 9), kUp);
  SightOptions sight = straight_back();
  // A zone that lies 20 degrees to the left needs a turn of 10.
  const std::vector<GroundPolygon> zone{{{5000, 1700}, {5000, 1900}, {5400, 1900}, {5400, 1700}}};
  AimOptions options;
  options.yaw_limit_rad = glm::radians(2.0);
  options.pitch_limit_rad = glm::radians(8.0);
  const MirrorAim held = solve_aim(glass, sight, zone, options);
  EXPECT_TRUE(held.at_yaw_stop);
  EXPECT_LE(std::abs(glm::degrees(held.yaw_rad)), 2.0 + 1e-9);
  options.yaw_limit_rad = glm::radians(15.0);
  const MirrorAim free = solve_aim(glass, sight, zone, options);
  EXPECT_FALSE(free.at_yaw_stop);
  EXPECT_GT(free.coverage, held.coverage);
  EXPECT_EQ(free.coverage, 1);
}

TEST(MirrorAim, YawTurnsToTheLeftAndPitchTurnsUp) {
  const MirrorGlass glass(test::conic_mirror(0, 0, 170, 110, 9, 9), kUp);
  const SightOptions sight = straight_back();
  // The mirror looks back; its driver's left is -x. Turned to the left seen from above, its normal moves from
  // +z to +x.
  const glm::dvec3 yawed = aimed_pose(glass, sight.road, {0, 0, 0}, 0.1, 0).rotation * glm::dvec3(0, 0, 1);
  EXPECT_GT(yawed.x, 0.09);
  const glm::dvec3 pitched = aimed_pose(glass, sight.road, {0, 0, 0}, 0, 0.1).rotation * glm::dvec3(0, 0, 1);
  EXPECT_GT(pitched.y, 0.09);
}

TEST(MirrorAim, NeedsAZone) {
  const MirrorGlass glass(test::conic_mirror(0, 0, 170, 110, 9, 9), kUp);
  EXPECT_THROW((void)solve_aim(glass, straight_back(), {}), Error);
}

}  // namespace
}  // namespace catoptra::optics
