#include "examples/street/house.h"

#include <vector>

#include "examples/street/shapes.h"

namespace catoptra::examples {
namespace {

/// An opening in the front, in metres from the left end and from the ground.
struct Opening {
  float left, right, bottom, top;
  std::string pane;  ///< paint; empty: a hole
  bool sill;
};

/// A point of the front: metres from the left end as seen from the street, height, and how far it stands out.
glm::vec3 on_front(float along, float height, float out = 0) {
  return {-along, out, height};
}

void add_opening(Model& house, const Opening& o) {
  const float in = -kReveal;
  if (!o.pane.empty())
    add_quad(house, o.pane, on_front(o.left, o.bottom, in), on_front(o.right, o.bottom, in),
             on_front(o.right, o.top, in), on_front(o.left, o.top, in));
  add_quad(house, "stone", on_front(o.left, o.bottom), on_front(o.left, o.bottom, in),
           on_front(o.left, o.top, in), on_front(o.left, o.top));
  add_quad(house, "stone", on_front(o.right, o.bottom, in), on_front(o.right, o.bottom),
           on_front(o.right, o.top), on_front(o.right, o.top, in));
  add_quad(house, "stone", on_front(o.left, o.top, in), on_front(o.right, o.top, in),
           on_front(o.right, o.top), on_front(o.left, o.top));
  if (o.sill)
    add_box(house, "stone", {-o.right - 0.08f, in, o.bottom - 0.09f}, {-o.left + 0.08f, 0.07f, o.bottom});
}

/// The wall around the openings of one storey: strips between, below and above them.
void add_wall_storey(Model& house, const std::string& wall, float width, float floor,
                     const std::vector<Opening>& openings) {
  const auto piece = [&](float left, float right, float bottom, float top) {
    if (right - left > 1e-3f && top - bottom > 1e-3f)
      add_tiled_quad(house, wall, on_front(left, bottom), on_front(right, bottom), on_front(right, top),
                     on_front(left, top), 1);
  };
  float left = 0;
  for (const Opening& o : openings) {
    piece(left, o.left, floor, floor + kStorey);
    piece(o.left, o.right, floor, o.bottom);
    piece(o.left, o.right, o.top, floor + kStorey);
    left = o.right;
  }
  piece(left, width, floor, floor + kStorey);
}

std::vector<Opening> storey_openings(const HouseDesign& design, int storey) {
  const float floor = kStorey * float(storey), bay = design.width / float(design.bays);
  if (storey == 0 && !design.shop.empty()) {
    const float door = design.width - 1.5f;
    return {{0.5f, door - 0.4f, 0.5f, 2.3f, design.glazed ? "" : "shop window", true},
            {door, door + 1.0f, 0.05f, 2.25f, design.door, false}};
  }
  std::vector<Opening> openings;
  for (int i = 0; i < design.bays; ++i) {
    const float middle = bay * (float(i) + 0.5f);
    if (storey == 0 && i == design.door_bay)
      openings.push_back({middle - 0.5f, middle + 0.5f, 0.15f, 2.25f, design.door, false});
    else
      openings.push_back({middle - 0.55f, middle + 0.55f, floor + 0.85f, floor + 2.4f,
                          design.glazed && design.shop.empty() ? ""
                          : (i + storey) % 2 == 0              ? "window with curtains"
                                                               : "window",
                          true});
  }
  return openings;
}

void add_roof(Model& house, const HouseDesign& design) {
  constexpr float kOverhang = 0.35f;
  const float eaves = kStorey * float(design.storeys), ridge = eaves + design.depth * 0.36f, w = design.width;
  const float middle = -design.depth / 2, back = -design.depth - kOverhang;
  const float slope = (ridge - eaves) / (design.depth / 2), low = eaves - slope * kOverhang;
  add_tiled_quad(house, "roof tiles", {0, kOverhang, low}, {-w, kOverhang, low}, {-w, middle, ridge},
                 {0, middle, ridge}, 1.6f);
  add_tiled_quad(house, "roof tiles", {-w, back, low}, {0, back, low}, {0, middle, ridge},
                 {-w, middle, ridge}, 1.6f);
  add_box(house, "stone", {-w, -0.02f, eaves - 0.18f}, {0, 0.10f, eaves});
  add_box(house, "bricks", {-0.95f, middle - 0.5f, ridge - 0.8f}, {-0.25f, middle + 0.1f, ridge + 0.9f});
  // Gable ends: the wall below the eaves and a triangle (a quad with two corners on the ridge) above.
  for (const auto& [x, front_first] : {std::pair{0.0f, false}, {-w, true}}) {
    const glm::vec3 a(x, 0, 0), b(x, -design.depth, 0), up(0, 0, eaves), top(x, middle, ridge);
    const glm::vec3 left = front_first ? b : a, right = front_first ? a : b;
    add_tiled_quad(house, design.wall, right, left, left + up, right + up, 1);
    add_tiled_quad(house, design.wall, right + up, left + up, top, top, 1);
  }
}

}  // namespace

Model make_house(const HouseDesign& design) {
  Model house;
  for (int storey = 0; storey < design.storeys; ++storey) {
    const auto openings = storey_openings(design, storey);
    add_wall_storey(house, design.wall, design.width, kStorey * float(storey), openings);
    for (const Opening& opening : openings) add_opening(house, opening);
  }
  add_roof(house, design);
  if (!design.shop.empty()) {
    add_box(house, "dark wood", {-design.width + 0.2f, 0, 2.40f}, {-0.2f, 0.14f, 3.05f});
    add_panel(house, design.shop, {-design.width / 2, 0.15f, 2.725f}, 0, {design.width - 2.2f, 0.55f});
  }
  if (!design.hanging.empty()) {
    // Readable from both directions along the street.
    const glm::vec3 centre(-design.width + 0.7f, 0.85f, 3.75f);
    add_bar(house, "metal", {centre.x, 0, 4.35f}, {centre.x, 1.5f, 4.35f}, 0.03f, 6);
    add_panel(house, design.hanging, centre + glm::vec3(0.02f, 0, 0), -90, {1.2f, 0.9f});
    add_panel(house, design.hanging, centre - glm::vec3(0.02f, 0, 0), 90, {1.2f, 0.9f});
  }
  return house;
}

Model make_clock_tower() {
  constexpr float kWidth = 3.6f, kHeight = 9;
  Model tower;
  const glm::vec3 a(0, 0, 0), b(-kWidth, 0, 0), c(-kWidth, -kWidth, 0), d(0, -kWidth, 0), up(0, 0, kHeight);
  for (const auto& [left, right] : {std::pair{a, b}, {b, c}, {c, d}, {d, a}})
    add_tiled_quad(tower, "pale bricks", left, right, right + up, left + up, 1);
  const glm::vec3 top(-kWidth / 2, -kWidth / 2, kHeight + 3);
  for (const auto& [left, right] : {std::pair{a, b}, {b, c}, {c, d}, {d, a}})
    add_tiled_quad(tower, "roof tiles", left + up, right + up, top, top, 1.6f);
  for (const float height : {3.4f, 4.1f, 8.7f})
    add_box(tower, "stone", {-kWidth - 0.12f, -0.1f, height}, {0.12f, 0.12f, height + 0.18f});
  add_disc(tower, "clock", {-kWidth / 2, 0.06f, 6.4f}, {0, 1, 0}, 1.7f, 32);
  add_panel(tower, "notice", {-kWidth / 2, 0.05f, 3.85f}, 0, {3.2f, 0.5f});
  add_opening(tower, {kWidth / 2 - 0.7f, kWidth / 2 + 0.7f, 0.0f, 2.4f, "green door", false});
  add_panel(tower, "green door", {-kWidth / 2, 0.02f, 1.2f}, 0, {1.4f, 2.4f});
  return tower;
}

Model make_wall() {
  Model wall;
  const glm::vec3 left(4, 0, -3), right(-4, 0, -3), up(0, 0, 6);
  add_tiled_quad(wall, "bricks", left, right, right + up, left + up, 1);
  add_disc(wall, "clock", {0.75f, 0.01f, 0.15f}, {0, 1, 0}, 0.5f, 32);
  add_panel(wall, "direction sign", {-0.6f, 0.01f, 0.2f}, 0, {1.4f, 0.7f});
  add_panel(wall, "notice", {0, 0.01f, -0.65f}, 0, {1.6f, 0.4f});
  return wall;
}

}  // namespace catoptra::examples
