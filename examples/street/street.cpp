#include "examples/street/street.h"

#include <array>

#include "examples/street/car.h"
#include "examples/street/furniture.h"
#include "examples/street/house.h"
#include "examples/street/shapes.h"

namespace catoptra::examples {
namespace {

// Across the street, in metres from the driver's eye: the road's left and right kerb and the house fronts.
constexpr float kLeftKerb = -4.6f, kRightKerb = 2.1f, kLeftFronts = -7.6f, kRightFronts = 5.2f,
                kMiddle = -1.25f;
// Along it.
constexpr float kBack = -78, kFront = 36, kKerbHeight = 0.12f;

void add_flat(Model& street, const std::string& paint, float x0, float x1, float y0, float y1, float z,
              float repeat_m) {
  add_tiled_quad(street, paint, {x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}, repeat_m);
}

void add_ground(Model& street) {
  add_flat(street, "grass", -160, 160, -200, 120, -0.05f, 3);
  constexpr float kPiece = 6;  // short pieces keep interpolation along a long quad well conditioned
  for (float y = kBack; y < kFront - 0.1f; y += kPiece) {
    add_flat(street, "asphalt", kLeftKerb, kRightKerb, y, y + kPiece, 0, 2.5f);
    add_flat(street, "paving", kLeftFronts - 1, kLeftKerb - 0.15f, y, y + kPiece, kKerbHeight, 2);
    add_flat(street, "paving", kRightKerb + 0.15f, kRightFronts + 1, y, y + kPiece, kKerbHeight, 2);
    for (const float x : {kLeftKerb - 0.15f, kRightKerb}) {
      add_flat(street, "stone", x, x + 0.15f, y, y + kPiece, kKerbHeight, 1);
    }
    add_quad(street, "stone", {kLeftKerb, y, 0}, {kLeftKerb, y + kPiece, 0},
             {kLeftKerb, y + kPiece, kKerbHeight}, {kLeftKerb, y, kKerbHeight});
    add_quad(street, "stone", {kRightKerb, y + kPiece, 0}, {kRightKerb, y, 0}, {kRightKerb, y, kKerbHeight},
             {kRightKerb, y + kPiece, kKerbHeight});
  }
  add_flat(street, "asphalt", -40, 40, kBack - 9, kBack, 0, 2.5f);  // the cross street behind
}

void add_markings(Model& street) {
  constexpr float kAbove = 0.006f;
  for (float y = kBack + 8; y < kFront - 4; y += 6)
    add_flat(street, "lane paint", kMiddle - 0.07f, kMiddle + 0.07f, y, y + 3, kAbove, 1);
  for (float y = kBack; y < kFront - 1; y += 6)
    for (const float x : {kLeftKerb + 0.22f, kRightKerb - 0.34f})
      add_flat(street, "lane paint", x, x + 0.12f, y, y + 6, kAbove, 1);
  for (float x = kLeftKerb + 0.35f; x < kRightKerb - 0.5f; x += 0.95f)  // pedestrian crossing
    add_flat(street, "lane paint", x, x + 0.5f, -25.5f, -22.5f, kAbove, 1);
  add_flat(street, "lane paint", kLeftKerb + 0.3f, kMiddle - 0.2f, -21.6f, -21.2f, kAbove, 1);
  add_flat(street, "lane paint", kMiddle + 0.2f, kRightKerb - 0.4f, -26.8f, -26.4f, kAbove, 1);
}

void add_houses(Model& street) {
  struct Plot {
    float y;  ///< of the end that is on the left as seen from the street
    bool left_side;
    HouseDesign design;
  };
  const std::array plots = {
      // Left of the driver: fronts look towards +x, their left end is the one with the smaller y... the
      // street runs on.
      Plot{-8, true, {9, 9, 2, 3, 0, "plaster yellow", "green door", "", ""}},
      Plot{-17.5f, true, {9, 9, 2, 3, 2, "bricks", "red door", "shop optician", ""}},
      Plot{-27, true, {8, 9, 3, 3, 0, "plaster blue", "red door", "shop baker", "hanging sign"}},
      Plot{-38, true, {10, 9, 2, 4, 1, "pale bricks", "green door", "", ""}},
      Plot{-48.5f, true, {9, 9, 3, 3, 0, "plaster rose", "green door", "shop books", ""}},
      Plot{-60, true, {10, 9, 2, 4, 0, "bricks", "red door", "", ""}},
      Plot{3, true, {10, 9, 2, 4, 3, "bricks", "green door", "", ""}},
      Plot{14, true, {9, 9, 2, 3, 1, "plaster rose", "red door", "", ""}},
      Plot{-2, false, {10, 9, 2, 4, 1, "pale bricks", "red door", "", ""}},
      Plot{-13, false, {9, 9, 2, 3, 1, "plaster rose", "green door", "", ""}},
      Plot{-24, false, {10, 9, 3, 4, 1, "bricks", "green door", "", ""}},
      Plot{-36, false, {9, 9, 2, 3, 0, "plaster yellow", "red door", "", ""}},
      Plot{10, false, {9, 9, 2, 3, 1, "plaster blue", "green door", "", ""}},
  };
  for (const Plot& plot : plots)
    street.add(make_house(plot.design),
               plot.left_side ? place({kLeftFronts, plot.y + plot.design.width, kKerbHeight}, -90)
                              : place({kRightFronts, plot.y, kKerbHeight}, 90));
  street.add(make_clock_tower(), place({-3.6f, kBack - 10, 0}));
  for (const float x : {9.0f, -9.0f})
    street.add(make_house({10, 9, 2, 4, 1, x > 0 ? "plaster yellow" : "plaster blue", "red door", "", ""}),
               place({x > 0 ? 12.0f : -9.0f, kBack - 12, 0}));
}

void add_cars(Model& street) {
  street.add(make_car({CarShape::hatchback, "car yellow", 0}),
             place({-2.95f, -12.0f, 0}, 180));                                        // has just passed
  street.add(make_car({CarShape::saloon, "car red", 1}), place({0.30f, -15.0f, 0}));  // follows
  street.add(make_car({CarShape::van, "car white", 2}),
             place({-3.55f, -33.0f, 0}, 180));  // parked on the left
  street.add(make_car({CarShape::saloon, "car blue", 3}), place({-3.1f, 9.0f, 0}, 180));  // coming towards us
  street.add(make_car({CarShape::hatchback, "car silver", 4}), place({0.6f, -38.0f, 0}));  // far behind
}

void add_furniture(Model& street) {
  for (const float y : {-27.5f, -50.0f, 12.0f})
    street.add(make_lamp_post(), place({kLeftKerb - 0.5f, y, kKerbHeight}, 180));
  for (const float y : {-22.0f, -44.0f})
    street.add(make_lamp_post(), place({kRightKerb + 0.5f, y, kKerbHeight}));

  // All signs face +y: towards a driver who looks back.
  street.add(make_board("direction sign", 2.5f, 1.25f, 2.75f), place({-5.75f, -17.5f, kKerbHeight}));
  street.add(make_sign("stop sign", 0.9f, 0.9f, 2.9f), place({kLeftKerb - 0.35f, -23.0f, kKerbHeight}));
  street.add(make_sign("speed limit", 0.75f, 0.75f, 2.8f), place({kRightKerb + 0.6f, -19.0f, kKerbHeight}));
  street.add(make_sign("street name", 1.6f, 0.3f, 2.5f), place({kLeftKerb - 0.7f, 7.5f, kKerbHeight}, -50));

  street.add(make_tree(5.5f, "leaves", 1), place({kLeftKerb - 1.1f, -30.0f, kKerbHeight}));
  street.add(make_tree(6.5f, "autumn leaves", 2), place({kLeftKerb - 1.1f, -45.0f, kKerbHeight}));
  street.add(make_tree(5.0f, "leaves", 3), place({kRightKerb + 1.2f, -30.0f, kKerbHeight}));
  street.add(make_tree(6.0f, "leaves", 4), place({-6.0f, 4.2f, kKerbHeight}));
  street.add(make_tree(7.0f, "autumn leaves", 5), place({8.0f, kBack - 8.5f, 0}));
  street.add(make_tree(7.0f, "leaves", 6), place({-8.0f, kBack - 9.0f, 0}));
}

}  // namespace

Model make_street() {
  Model street;
  add_ground(street);
  add_markings(street);
  add_houses(street);
  add_cars(street);
  add_furniture(street);
  return street;
}

}  // namespace catoptra::examples
