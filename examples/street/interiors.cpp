#include "examples/street/interiors.h"

#include <array>
#include <string>
#include <vector>

#include "examples/street/house.h"
#include "examples/street/pixmap.h"
#include "examples/street/shapes.h"

namespace catoptra::examples {
namespace {

/// A room behind the front, open to it: from x = -left to -right, z = floor to ceiling, `depth` deep.
void add_room(Model& model, float left, float right, float floor, float ceiling, float depth) {
  const float front = -kReveal, back = -kReveal - depth;
  const auto at = [](float along, float y, float z) { return glm::vec3(-along, y, z); };
  add_quad(model, "dim wall", at(left, back, floor), at(right, back, floor), at(right, back, ceiling),
           at(left, back, ceiling));
  add_quad(model, "dim wall", at(left, front, floor), at(left, back, floor), at(left, back, ceiling),
           at(left, front, ceiling));
  add_quad(model, "dim wall", at(right, back, floor), at(right, front, floor), at(right, front, ceiling),
           at(right, back, ceiling));
  add_quad(model, "dim floor", at(left, front, floor), at(right, front, floor), at(right, back, floor),
           at(left, back, floor));
  add_quad(model, "dim ceiling", at(left, back, ceiling), at(right, back, ceiling), at(right, front, ceiling),
           at(left, front, ceiling));
}

void add_vase(Model& model, const std::string& paint, const glm::vec3& foot, float height) {
  add_lathe(model, paint, foot,
            {{0.20f * height, 0},
             {0.30f * height, 0.3f * height},
             {0.14f * height, 0.75f * height},
             {0.2f * height, height}},
            16);
}

/// A table with vases, boxes and a board to read, in the window of a shop.
void add_goods(Model& model, float left, float right, const std::string& board, int seed) {
  constexpr std::array kPaints{"goods red", "goods blue", "goods yellow", "goods white"};
  const float y = -0.75f, top = 0.55f;
  add_box(model, "dark wood", {-right + 0.3f, y - 0.3f, top - 0.05f}, {-left - 0.3f, y + 0.3f, top});
  for (int i = 0; i < 9; ++i) {
    const float x = left + 0.55f + (right - left - 1.1f) * float(i) / 8;
    const std::string paint = kPaints[std::size_t(int(4 * noise(i, 0, seed)))];
    const float high = 0.22f + 0.25f * noise(i, 1, seed);
    if (i % 2)
      add_box(model, paint, {-x - 0.13f, y - 0.12f, top}, {-x + 0.13f, y + 0.14f, top + high});
    else
      add_vase(model, paint, {-x, y, top}, high + 0.1f);
  }
  add_panel(model, board, {-(left + right) / 2, -1.6f, 1.75f}, 0, {2.4f, 0.6f});
}

}  // namespace

Model make_shop_row() {
  constexpr float kWidth = 8;
  struct Shop {
    const char *wall, *door, *sign, *board;
  };
  constexpr std::array kShops{Shop{"bricks", "green door", "shop optician", "dim board optician"},
                              Shop{"plaster blue", "red door", "shop baker", "dim board baker"},
                              Shop{"pale bricks", "green door", "shop books", "dim board books"}};
  Model row;
  for (std::size_t k = 0; k < kShops.size(); ++k) {
    HouseDesign design{kWidth, 9, 2, 3, 0, kShops[k].wall, kShops[k].door, kShops[k].sign, ""};
    design.glazed = true;
    Model house = make_house(design);
    add_room(house, 0.4f, 6.2f, 0.3f, 2.5f, 3);
    add_goods(house, 0.4f, 6.2f, kShops[k].board, int(k) + 71);
    row.add(house, place({-kWidth * float(k), 0, 0}));
  }
  return row;
}

Model make_window_front() {
  constexpr int kColumns = 10;
  constexpr float kBay = 2.2f;
  HouseDesign design{kBay * kColumns, 9, 2, kColumns, -1, "plaster yellow", "", "", ""};  // no door
  design.glazed = true;
  Model front = make_house(design);
  constexpr std::array kPaints{"goods red", "goods blue", "goods yellow", "goods white"};
  for (int storey = 0; storey < design.storeys; ++storey)
    for (int c = 0; c < kColumns; ++c) {
      const float left = kBay * float(c), floor = kStorey * float(storey), middle = left + kBay / 2;
      add_room(front, left + 0.05f, left + kBay - 0.05f, floor + 0.1f, floor + 2.7f, 2);
      add_vase(front, kPaints[std::size_t(c + storey) % 4], {-middle - 0.2f, -0.6f, floor + 0.85f}, 0.5f);
      add_box(front, "dark wood", {-middle - 0.5f, -0.8f, floor + 0.1f},
              {-middle + 0.5f, -0.4f, floor + 0.85f});
      add_panel(front, "dim board number " + std::to_string(c), {-middle + 0.1f, -2.1f, floor + 1.7f}, 0,
                {0.9f, 0.9f});
    }
  return front;
}

}  // namespace catoptra::examples
