// The living room and the mounts: what the lens scenes rely on.
#include "examples/room/room.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "examples/room/dressing_table.h"
#include "examples/room/room_palette.h"
#include "examples/room/spectacles.h"
#include "examples/street/palette.h"
#include "tests/support/sound_model.h"

namespace catoptra::examples {
namespace {

void expect_sound(const Model& model) {
  Palette palette = make_palette(CATOPTRA_SIGN_FONT);
  add_room_paints(palette, CATOPTRA_SIGN_FONT);
  // The finest part is a frame of 2 mm tubes: no triangle below a hundredth of a square millimetre.
  test::expect_sound(model, palette, 1e-8f);
}

TEST(Room, HasThreeToSixThousandTriangles) {
  const Model room = make_room();
  EXPECT_GE(room.triangle_count(), 3000u);
  EXPECT_LE(room.triangle_count(), 6000u);
  expect_sound(room);
}

TEST(Room, LeavesTheEyeAndTheLensRoom) {
  // The person sits at the origin: nothing is nearer than 0.8 m to the eye at (0, 0, 1.2).
  for (const auto& [name, surface] : make_room().surfaces)
    for (const Vertex& v : surface.vertices)
      EXPECT_GT(glm::length(v.position - glm::vec3(0, 0, 1.2f)), 0.8f) << name;
}

TEST(Spectacles, FrameLeavesTheLensesClear) {
  const SpectacleSize size;
  const Model frame = make_spectacle_frame(size);
  expect_sound(frame);
  // Rims cover the edge of the glass by less than 1 mm.
  for (const auto& [name, surface] : frame.surfaces)
    for (const Vertex& v : surface.vertices) {
      const float x = std::abs(v.position.x) - size.pupil_distance / 2;
      EXPECT_GT(std::hypot(x, v.position.z), size.lens_diameter / 2 - 0.001f) << name;
    }
}

TEST(DressingTable, ThingsStandInsideTheFocalLength) {
  const Model table = make_dressing_table();
  expect_sound(table);
  for (const char* name : {"blue glaze", "gilt", "tail light", "letter chart", "pages"})
    for (const Vertex& v : table.surfaces.at(name).vertices) {
      EXPECT_GT(v.position.y, 0.10f) << name;
      EXPECT_LT(v.position.y, 0.25f) << name;
    }
}

TEST(HandLens, RingLeavesTheLensClear) {
  const Model glass = make_hand_lens(0.065f);
  expect_sound(glass);
  for (const auto& [name, surface] : glass.surfaces)
    for (const Vertex& v : surface.vertices)
      EXPECT_GT(std::hypot(v.position.x, v.position.z), 0.0325f - 0.001f) << name;
}

}  // namespace
}  // namespace catoptra::examples
