// The eye's pupil: what is out of focus becomes a disc as large as vergences say, in all modes.
#include <gtest/gtest.h>

#include "tests/render/antialias_scenes.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

class Pupil : public ::testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(Modes, Pupil, kAllModes, name_of);

constexpr double kPupil_mm = 6;
const glm::dvec3 kUp(0.3, 1, 0);  // so that no edge runs along the pixels

/// A dark scene with a luminous square of `side_mm` about (x, y, z), facing -z and +z.
Scene luminous_square(glm::dvec3 at, double side_mm) {
  Scene scene;
  scene.file = "point of light";
  scene.environment = {glm::vec3(0), "", 0};
  cad_import::TriangleMesh mesh;
  const auto s = float(side_mm);
  add_quad(mesh, glm::vec3(at) + glm::vec3(-s / 2, -s / 2, 0), {s, 0, 0}, {0, s, 0}, glm::vec3(0));
  mesh.materials[0].emissive = glm::vec3(10);
  scene.surroundings.push_back(mesh);
  return scene;
}

struct Spot {
  glm::dvec2 middle{0};
  double spread = 0;  ///< mean square distance from the middle by axis, px^2
};

Spot spot_of(const Frame& frame) {
  double light = 0, square = 0;
  Spot spot;
  for (std::size_t i = 0; i < frame.color.size(); ++i) {
    const glm::dvec2 at(double(i % std::size_t(frame.width)), double(i / std::size_t(frame.width)));
    light += frame.color[i].g;
    spot.middle += double(frame.color[i].g) * at;
    square += double(frame.color[i].g) * glm::dot(at, at);
  }
  spot.middle /= light;
  spot.spread = 0.5 * (square / light - glm::dot(spot.middle, spot.middle));
  return spot;
}

/// Diameter of the blur disc, rad: an evenly lit disc has the variance D^2 / 16 by axis, added to that of the
/// picture without pupil.
double blur_rad(const Scene& scene, Mode mode, double focus_mm) {
  Renderer renderer(scene);
  Camera camera = scene.camera;
  const FrameOptions options = picture_of(scene, 64, false);
  const Spot sharp = spot_of(renderer.render(mode, camera, options).frame);
  camera.pupil_mm = kPupil_mm;
  camera.focus_mm = focus_mm;
  const Spot blurred = spot_of(renderer.render(mode, camera, options).frame);
  // Samples opposite in the pixel are so in the pupil. Through a lens the vertices' rays are others for each.
  EXPECT_LT(glm::distance(sharp.middle, blurred.middle), 0.25) << "px; the blur is no shift";
  return 4 * std::sqrt(std::max(0.0, blurred.spread - sharp.spread)) * camera_rays(camera, 160, 120).pixel;
}

TEST_P(Pupil, PointOutOfFocusIsADiscOfPupilTimesVergenceDifference) {
  Scene scene = luminous_square({0, 0, 1500}, 6);
  scene.camera = {{0, 0, 0}, {0, 0, 500}, kUp, 0.06, {160, 120}};
  // Thin lens focused at 500 mm (the target): 6 mm (1/500 - 1/1500) = 8 mrad. Then nearer and farther.
  for (const double focus_mm : {0.0, 700.0, 4000.0}) {
    const double expected = kPupil_mm * std::abs(1 / (focus_mm > 0 ? focus_mm : 500) - 1 / 1500.0);
    EXPECT_NEAR(blur_rad(scene, GetParam(), focus_mm), expected, 0.02 * expected) << focus_mm;
  }
  EXPECT_LT(blur_rad(scene, GetParam(), 1500), 0.05e-3) << "in focus: a twentieth of a pixel";
}

TEST_P(Pupil, InAPlaneMirrorThePathsLengthCounts) {
  if (GetParam() == Mode::cubemap) return;  // whose map is made from one point, for all places in the pupil
  Scene scene = luminous_square({0, 60, 700}, 4);
  scene.camera = {{0, -60, 700}, {0, 0, 0}, kUp, 0.06, {160, 120}};
  scene.optics.push_back(conic_mirror(0, 0, 170, 110, 3, 3));
  // Depth along the view of the mirrored point, which is where the view leads: twice the way to the mirror.
  const double depth_mm = 2 * std::hypot(60, 700);
  for (const double focus_mm : {0.0, 5000.0}) {
    const double expected = kPupil_mm * std::abs(1 / (focus_mm > 0 ? focus_mm : depth_mm / 2) - 1 / depth_mm);
    EXPECT_NEAR(blur_rad(scene, GetParam(), focus_mm), expected, 0.02 * expected) << focus_mm;
  }
  EXPECT_LT(blur_rad(scene, GetParam(), depth_mm), 0.05e-3);
}

/// Vergence, in 1/mm, of light from a point `object_mm` before a lens where it reaches an eye `eye_mm` behind
/// it: paraxial, surface by surface (Hecht 2017, 5.2 and 6.1). Radii positive where the centre is on the
/// eye's side.
double vergence_at_eye(double object_mm, double front_mm, double back_mm, double thickness_mm, double index,
                       double eye_mm) {
  const auto moved = [](double vergence, double reduced_mm) {
    return vergence / (1 - reduced_mm * vergence);
  };
  const double inside = -1 / object_mm + (index - 1) / front_mm;
  return moved(moved(inside, thickness_mm / index) + (1 - index) / back_mm, eye_mm);
}

TEST_P(Pupil, ThroughASpectacleLensTheVergenceAtTheEyeCounts) {
  if (GetParam() == Mode::cubemap) return;
  Scene scene = luminous_square({0, 0, 3000}, 12);
  scene.camera = {{0, 0, -16}, {0, 0, 100}, kUp, 0.06, {160, 120}};
  // No wider than the pupil asks: mode pvrr makes maps of the whole lens.
  scene.optics.push_back(lens_of(400, 95.2, 2, 8, 13));
  // -4 D, the back vertex 14 mm before the eye: the point at 3 m appears at about -4.1 D.
  const double vergence = vergence_at_eye(3000, 400, 95.2, 2, 1.5, 14);
  ASSERT_NEAR(1000 * vergence, -4.1, 0.1);
  const double expected = kPupil_mm * std::abs(1 / 1000.0 + vergence);
  EXPECT_NEAR(blur_rad(scene, GetParam(), 1000), expected, 0.02 * expected);
  // In focus: what is left of 24 mrad by the interpolation between vertices, and by spherical aberration.
  EXPECT_LT(blur_rad(scene, GetParam(), -1 / vergence), 0.4e-3);
}

TEST(PupilPoint, HasTheMomentsOfADiscAndIsNotInStepWithThePixel) {
  for (const int samples : {4, 8, 16, 64, 256}) {
    glm::dvec2 sum(0);
    double square = 0, farthest = 0, together = 0;
    EXPECT_EQ(pupil_point(0, samples), glm::dvec2(0));
    for (int i = 0; i < samples; ++i) {
      const glm::dvec2 at = pupil_point(i, samples);
      sum += at;
      square += glm::dot(at, at) / samples;
      farthest = std::max(farthest, glm::length(at));
      const glm::dvec2 offset = sample_offset(i, samples);  // +y down
      together += (at.x * offset.x - at.y * offset.y) / samples;
    }
    EXPECT_LT(glm::length(sum), 1e-12) << samples;
    EXPECT_NEAR(square, 0.5, 1e-12) << samples;
    EXPECT_LE(farthest, 1) << samples;
    if (samples >= 64) {
      EXPECT_GT(farthest, 0.97);
      // 0 where the two are independent; in step it would be about 0.36.
      EXPECT_LT(std::abs(together), 0.02) << samples;
    }
  }
}

TEST(PupilOptions, NothingOfItShowsInOneSampleAndBadNumbersAreRefused) {
  Scene scene = luminous_square({0, 0, 1500}, 6);
  scene.camera = {{0, 0, 0}, {0, 0, 500}, kUp, 0.06, {160, 120}};
  Renderer renderer(scene);
  const FrameOptions one = picture_of(scene, 1, false);
  const Frame point = renderer.render(Mode::pvrr, scene.camera, one).frame;
  scene.camera.pupil_mm = 6;
  const RenderResult pupil = renderer.render(Mode::pvrr, scene.camera, one);
  EXPECT_EQ(point.color, pupil.frame.color);
  EXPECT_EQ(pupil.warnings.size(), 1u);
  scene.camera.pupil_mm = -1;
  EXPECT_THROW((void)renderer.render(Mode::pvrr, scene.camera, one), Error);
}

}  // namespace
}  // namespace catoptra::render
