// The field on the ground against plane geometry.
#include "optics/mirror_field.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "cad_import/error.h"
#include "optics/mirror_aim.h"
#include "tests/support/analytic_optic.h"

namespace catoptra::optics {
namespace {

/// Mirror at the origin looking to +z, that is backwards; up is +y; the ground lies 1000 mm below; the eye is
/// behind.
constexpr double kGround = -1000;
const glm::dvec3 kUp(0, 1, 0), kForward(0, 0, -1);

SightOptions sight_from(const std::vector<glm::dvec3>& eyes) {
  SightOptions sight;
  sight.eyes_mm = eyes;
  glm::dvec3 middle{0};
  for (const glm::dvec3& eye : eyes) middle += eye / double(eyes.size());
  sight.road = make_road_frame(kForward, kUp, {0, kGround, 0}, middle);
  return sight;
}

/// A mirror's plane z = 0 seen from `eye`: the ground polygon of its rectangle, by the mirrored eye. Only for
/// lower edges and clips above the horizon: `y_high` is the highest y whose ray meets the ground before
/// `far`.
GroundPolygon projected_rectangle(const RoadFrame& road, const glm::dvec3& eye, double x0, double x1,
                                  double y0, double y1) {
  const glm::dvec3 image(eye.x, eye.y, -eye.z);
  GroundPolygon polygon;
  for (const glm::dvec2 corner : {glm::dvec2(x0, y0), {x1, y0}, {x1, y1}, {x0, y1}}) {
    const glm::dvec3 way = glm::dvec3(corner, 0) - image;
    const double t = (kGround - image.y) / way.y;
    polygon.push_back(glm::dvec2(road.coordinates(image + t * way)));
  }
  return polygon;
}

/// A region that holds the field with room to spare.
GroundPolygon region_around(const GroundPolygon& polygon) {
  glm::dvec2 low{1e300}, high{-1e300};
  for (const glm::dvec2& p : polygon) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const glm::dvec2 room = 0.2 * (high - low);
  low -= room;
  high += room;
  return {low, {high.x, low.y}, high, {low.x, high.y}};
}

// A glass high enough over the eye's line that even its upper edge shows ground: the eye is above it.
const glm::dvec3 kEye(400, 150, 700);

TEST(MirrorField, PlaneMirrorShowsTheProjectedRectangle) {
  const MirrorGlass glass(test::conic_mirror(0, 0, 170, 110, 9, 9), kUp);
  const MirrorSight sight(glass, sight_from({kEye}));
  const GroundPolygon expected = projected_rectangle(sight.options().road, kEye, -85, 85, -55, 55);
  const std::vector<GroundPolygon> region{region_around(expected)};
  const FieldAreas field = measure_field(sight, region);
  const double area = polygon_area_mm2(expected) * 1e-6;
  EXPECT_NEAR(field.covered_m2 / area, 1, 1e-3);
  EXPECT_LE(std::abs(field.covered_m2 - area), field.uncertain_m2) << "the stated bound holds";
  EXPECT_EQ(field.covered_m2, field.reflected_m2);
  // Place by place: what is inside is seen, what is outside is not.
  for (int i = 0; i < 400; ++i) {
    const glm::dvec2 place = region[0][0] + (region[0][2] - region[0][0]) * glm::dvec2(i % 20, i / 20) / 19.0;
    EXPECT_EQ((sight.state(place) & kSeenByAny) != 0, polygon_holds(expected, place))
        << place.x << " " << place.y;
  }
  // The drawing's outline has the same corners.
  const auto outline = field_outline(sight, 0, 1e9);
  for (const glm::dvec2& corner : expected) {
    double nearest = 1e300;
    for (const glm::dvec2& p : outline) nearest = std::min(nearest, glm::distance(p, corner));
    EXPECT_LT(nearest, 1e-6);
  }
}

TEST(MirrorField, AmbinocularIsTheUnionOfBothEyes) {
  const MirrorGlass glass(test::conic_mirror(1200, 0, 170, 110, 9, 9), kUp);
  const glm::dvec3 left = kEye - glm::dvec3(32.5, 0, 0), right = kEye + glm::dvec3(32.5, 0, 0);
  const std::vector<GroundPolygon> region{{{2000, -9000}, {2000, 6000}, {15000, 6000}, {15000, -9000}}};
  RegionOptions fine;
  fine.tolerance = 1e-4;
  const FieldAreas one = measure_field(MirrorSight(glass, sight_from({left})), region, fine);
  // The same ground for the other eye: its own frame would be moved with it.
  SightOptions other = sight_from({left});
  other.eyes_mm = {right};
  const FieldAreas two = measure_field(MirrorSight(glass, other), region, fine);
  SightOptions together = sight_from({left});
  together.eyes_mm = {left, right};
  const FieldAreas both = measure_field(MirrorSight(glass, together), region, fine);
  const double slack = one.uncertain_m2 + two.uncertain_m2 + both.uncertain_m2;
  EXPECT_GT(one.covered_m2, 10);
  EXPECT_NE(one.covered_m2, two.covered_m2);
  EXPECT_NEAR(both.monocular_m2[0], one.covered_m2, slack);
  EXPECT_NEAR(both.monocular_m2[1], two.covered_m2, slack);
  EXPECT_NEAR(both.covered_m2, one.covered_m2 + two.covered_m2 - both.binocular_m2, slack);
  EXPECT_LT(both.binocular_m2, std::min(one.covered_m2, two.covered_m2));
}

TEST(MirrorField, LevelAngleGrowsAsTheRadiusSays) {
  // A narrow mirror looked at head on from distance a: a ray at x from the middle leaves at x / a + 2 x / R.
  const double width = 20, a = 600;
  SightOptions options = sight_from({{0, 0, a}});
  for (const double radius : {0.0, 3000.0, 1200.0, 600.0, 300.0}) {
    const MirrorGlass glass(test::conic_mirror(radius, 0, width, 10, 9, 5), kUp);
    const auto angle = horizon_angle(MirrorSight(glass, options));
    ASSERT_TRUE(angle) << radius;
    const double x = width / 2, slope = radius == 0 ? 0 : std::asin(x / radius);
    const double depth = radius == 0 ? 0 : radius * (1 - std::cos(slope));
    const double exact = 2 * (std::atan(x / (a + depth)) + 2 * slope);
    EXPECT_NEAR(angle->angle_rad(), exact, 1e-5) << radius;
    EXPECT_NEAR(angle->left_rad, -angle->right_rad, 2e-6);
  }
}

/// Alhazen's problem: the reflection point on a sphere of `radius` about `center`, by bisection of the angle
/// in the plane of eye, centre and target. Nothing of it is the program's.
glm::dvec3 alhazen(const glm::dvec3& center, double radius, const glm::dvec3& eye, const glm::dvec3& target) {
  const double to_eye = glm::distance(eye, center), to_target = glm::distance(target, center);
  const glm::dvec3 e = (eye - center) / to_eye, g = (target - center) / to_target;
  const double whole = std::acos(glm::dot(e, g));
  const glm::dvec3 aside = glm::normalize(g - glm::dot(e, g) * e);
  double low = 0, high = whole;
  for (int i = 0; i < 80; ++i) {
    const double t = (low + high) / 2, rest = whole - t;
    const double incidence = std::atan2(to_eye * std::sin(t), to_eye * std::cos(t) - radius);
    const double leaving = std::atan2(to_target * std::sin(rest), to_target * std::cos(rest) - radius);
    (incidence < leaving ? low : high) = t;
  }
  return center + radius * (std::cos(low) * e + std::sin(low) * aside);
}

TEST(MirrorField, SphereShowsWhatAlhazensProblemSays) {
  const double radius = 700;
  const MirrorGlass glass(test::conic_mirror(radius, 0, 170, 110, 9, 9), kUp);
  const MirrorSight sight(glass, sight_from({kEye}));
  int seen = 0, hidden = 0;
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec2 place(600 + 250.0 * (i % 100), -12000 + 240.0 * (i / 100));
    const glm::dvec3 at = alhazen({0, 0, -radius}, radius, kEye, sight.options().road.point(place));
    const double inside = std::min(85 - std::abs(at.x), 55 - std::abs(at.y));
    if (std::abs(inside) < 1e-6) continue;  // on the border rounding decides
    EXPECT_EQ((sight.state(place) & kSeen[0]) != 0, inside > 0) << place.x << " " << place.y;
    ++(inside > 0 ? seen : hidden);
  }
  EXPECT_GT(seen, 1000);
  EXPECT_GT(hidden, 1000);
}

/// An upright board across the road.
cad_import::TriangleMesh board(double x0, double x1, double y0, double y1, float z) {
  cad_import::TriangleMesh mesh;
  mesh.positions = {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.texture_coordinates.assign(4, {0, 0});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.triangle_material = {0, 0};
  mesh.materials.resize(1);
  return mesh;
}

TEST(MirrorField, ABoardHidesItsShadowFromTheMirroredEye) {
  const MirrorGlass glass(test::conic_mirror(0, 0, 170, 110, 9, 9), kUp);
  RayScene vehicle;
  // Between mirror and ground, 300 mm behind the mirror, out of the eye's own way.
  vehicle.add_surroundings(board(-220, -100, -600, 0, 300));
  vehicle.commit();
  SightOptions options = sight_from({kEye});
  options.vehicle = &vehicle;
  const MirrorSight sight(glass, options);
  const GroundPolygon whole = projected_rectangle(options.road, kEye, -85, 85, -55, 55);
  const glm::dvec3 image(kEye.x, kEye.y, -kEye.z);
  int hidden = 0;
  const GroundPolygon region = region_around(whole);
  for (int i = 0; i < 900; ++i) {
    const glm::dvec2 place = region[0] + (region[2] - region[0]) * glm::dvec2(i % 30, i / 30) / 29.0;
    const glm::dvec3 target = options.road.point(place);
    const glm::dvec3 at = image + (target - image) * ((300 - image.z) / (target.z - image.z));
    const bool blocked = at.x > -220 && at.x < -100 && at.y > -600 && at.y < 0;
    const std::uint8_t state = sight.state(place);
    EXPECT_EQ((state & kReflected[0]) != 0, polygon_holds(whole, place));
    EXPECT_EQ((state & kSeen[0]) != 0, polygon_holds(whole, place) && !blocked) << place.x << " " << place.y;
    hidden += polygon_holds(whole, place) && blocked;
  }
  EXPECT_GT(hidden, 20) << "the board is in the way somewhere";
  const std::vector<GroundPolygon> zone{region};
  const FieldAreas field = measure_field(sight, zone);
  EXPECT_NEAR(field.obstructed_m2, field.reflected_m2 - field.covered_m2, 1e-9);
  EXPECT_GT(field.obstructed_m2, 0.1);
}

TEST(MirrorField, MarginsAreDistancesToTheProjectedBorder) {
  const MirrorGlass glass(test::conic_mirror(0, 0, 170, 110, 9, 9), kUp);
  // Head on, the field is a trapezoid symmetric about the line straight back.
  const MirrorSight sight(glass, sight_from({{0, 150, 700}}));
  const GroundPolygon field = projected_rectangle(sight.options().road, {0, 150, 700}, -85, 85, -55, 55);
  const double near = std::min(field[0].x, field[2].x), far = std::max(field[0].x, field[2].x);
  ASSERT_GT(far - near, 3000);
  const std::vector<GroundPolygon> zone{
      {{near + 1000, -200}, {near + 1000, 200}, {far - 700, 200}, {far - 700, -200}}};
  const auto margins = field_margins(sight, zone);
  ASSERT_EQ(margins.size(), 4u);
  EXPECT_NEAR(margins[0].margin_mm, 1000, 2);  // the near edge
  EXPECT_NEAR(margins[2].margin_mm, 700, 2);   // the far edge
  // A zone that starts before the field: the near edge is not seen, over that distance.
  const std::vector<GroundPolygon> too_near{{{near - 500, -200}, {near - 500, 200}, {far, 200}, {far, -200}}};
  EXPECT_NEAR(field_margins(sight, too_near)[0].margin_mm, -500, 2);
  // An edge that two parts share is no border.
  const std::vector<GroundPolygon> two{
      {{near + 1000, -200}, {near + 1000, 200}, {near + 2000, 200}, {near + 2000, -200}},
      {{near + 2000, -200}, {near + 2000, 200}, {far - 700, 200}, {far - 700, -200}}};
  EXPECT_EQ(field_margins(sight, two).size(), 6u);
}

TEST(MirrorField, BlindIsWhatNeitherMirrorNorDirectViewShows) {
  const MirrorGlass glass(test::conic_mirror(0, 0, 170, 110, 9, 9), kUp);
  SightOptions options = sight_from({kEye});
  options.direct_limit_rad = glm::radians(90.0);
  const MirrorSight sight(glass, options);
  const GroundPolygon region{{-3000, -4000}, {-3000, 4000}, {20000, 4000}, {20000, -4000}};
  const BlindZone blind = measure_blind_zone(sight, region);
  const std::vector<GroundPolygon> zone{region};
  const double seen = measure_field(MirrorSight(glass, sight_from({kEye})), zone).covered_m2;
  // Ahead of the eye everything is seen directly: 3 m x 8 m; the mirror's field lies behind it.
  EXPECT_NEAR(blind.blind_m2, blind.region_m2 - 24 - seen, blind.uncertain_m2 + 0.2);
  EXPECT_NEAR(blind.from_mm, 0, 260) << "a cell's width";
}

TEST(MirrorField, SameBitsOnOneThreadAndMany) {
  const MirrorGlass glass(test::conic_mirror(900, 0, 170, 110, 9, 9), kUp);
  const std::vector<GroundPolygon> zone{{{1000, -5000}, {1000, 5000}, {20000, 5000}, {20000, -5000}}};
  const SightOptions options = sight_from({kEye, kEye + glm::dvec3(65, 0, 0)});
  const auto all = measure_field(MirrorSight(glass, options), zone);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto one = measure_field(MirrorSight(glass, options), zone);
  EXPECT_EQ(one.covered_m2, all.covered_m2);
  EXPECT_EQ(one.binocular_m2, all.binocular_m2);
  EXPECT_EQ(one.cells.size(), all.cells.size());
  EXPECT_EQ(solve_aim(glass, options, zone).yaw_rad, solve_aim(glass, options, zone).yaw_rad);
}

TEST(MirrorField, ConcaveMirrorHasAFieldToo) {
  // Within the focal length (R/2 = 600) the eye's rays spread less, but they spread: the map is one to one.
  const MirrorGlass glass(test::conic_mirror(-1200, 0, 170, 110, 9, 9), kUp);
  const MirrorGlass plane(test::conic_mirror(0, 0, 170, 110, 9, 9), kUp);
  const glm::dvec3 eye(0, 60, 300);
  const std::vector<GroundPolygon> zone{{{500, -4000}, {500, 4000}, {25000, 4000}, {25000, -4000}}};
  const double concave = measure_field(MirrorSight(glass, sight_from({eye})), zone).covered_m2;
  EXPECT_GT(concave, 0.5);
  EXPECT_LT(concave, measure_field(MirrorSight(plane, sight_from({eye})), zone).covered_m2);
}

TEST(RoadFrame, IsRightHandedAndRefusesParallelDirections) {
  const RoadFrame road = make_road_frame({0, 1, 0.3}, {0, 0, 2}, {5, 5, 100}, {1, 2, 1300});
  EXPECT_NEAR(road.origin_mm.z, 100, 1e-12);
  EXPECT_NEAR(glm::distance(road.left, glm::dvec3(-1, 0, 0)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(road.coordinates(road.point({300, -20}, 7)), glm::dvec3(300, -20, 7)), 0, 1e-9);
  EXPECT_THROW((void)make_road_frame({0, 0, 1}, {0, 0, 1}, {0, 0, 0}, {0, 0, 1}), Error);
}

}  // namespace
}  // namespace catoptra::optics
