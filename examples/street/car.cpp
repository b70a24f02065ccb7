#include "examples/street/car.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "examples/street/shapes.h"

namespace catoptra::examples {
namespace {

/// A cut through the body across the direction of travel.
struct Station {
  float y;           ///< m, front positive
  float roof;        ///< height of the middle of the car
  float half_width;  ///< at the belt
  bool side_glass;   ///< the sides between here and the next station are windows
  bool top_glass;    ///< so is the top: windscreen or rear window
};

constexpr float kBelt = 0.90f;  // height of the windows' lower edge

std::vector<Station> stations(CarShape shape) {
  std::vector<Station> list = {{2.18f, 0.55f, 0.52f, false, false}, {2.14f, 0.64f, 0.66f, false, false},
                               {2.04f, 0.70f, 0.76f, false, false}, {1.80f, 0.77f, 0.82f, false, false},
                               {1.40f, 0.83f, 0.85f, false, false}, {0.98f, 0.90f, 0.86f, true, true},
                               {0.62f, 1.16f, 0.86f, true, true},   {0.28f, 1.38f, 0.86f, true, false},
                               {0.05f, 1.43f, 0.86f, true, false}};
  switch (shape) {
    case CarShape::saloon:
      list.insert(list.end(), {{-0.15f, 1.44f, 0.86f, false, false},
                               {-0.23f, 1.44f, 0.86f, true, false},
                               {-0.75f, 1.41f, 0.86f, true, false},
                               {-0.95f, 1.36f, 0.86f, true, true},
                               {-1.30f, 1.13f, 0.86f, false, true},
                               {-1.62f, 0.96f, 0.86f, false, false},
                               {-1.95f, 0.92f, 0.83f, false, false},
                               {-2.14f, 0.86f, 0.76f, false, false},
                               {-2.22f, 0.74f, 0.66f, false, false},
                               {-2.26f, 0.60f, 0.54f, false, false}});
      break;
    case CarShape::hatchback:
      list.insert(list.end(), {{-0.15f, 1.44f, 0.86f, false, false},
                               {-0.23f, 1.44f, 0.86f, true, false},
                               {-0.80f, 1.42f, 0.86f, true, false},
                               {-1.20f, 1.38f, 0.86f, false, false},
                               {-1.50f, 1.31f, 0.85f, false, true},
                               {-1.78f, 0.98f, 0.83f, false, false},
                               {-1.88f, 0.84f, 0.78f, false, false},
                               {-1.94f, 0.70f, 0.66f, false, false},
                               {-1.97f, 0.58f, 0.54f, false, false}});
      break;
    case CarShape::van:
      list.insert(list.end(), {{-0.10f, 1.60f, 0.88f, false, false},
                               {-0.60f, 1.72f, 0.89f, false, false},
                               {-1.20f, 1.76f, 0.89f, false, false},
                               {-2.00f, 1.75f, 0.88f, false, false},
                               {-2.18f, 1.70f, 0.86f, false, true},
                               {-2.24f, 1.05f, 0.84f, false, false},
                               {-2.27f, 0.70f, 0.78f, false, false},
                               {-2.29f, 0.56f, 0.66f, false, false}});
      break;
  }
  return list;
}

/// Half of a section, from the sill (share 0) over the belt to the middle of the roof (share 1): the place
/// across and up.
constexpr int kHalfSection = 8;
glm::vec2 section_point(const Station& station, int step) {
  const float belt = std::min(kBelt, station.roof - 0.04f), glass = station.roof - belt;
  const float lean = std::min(1.0f, glass / 0.5f);  // the windows lean inwards
  const float w = station.half_width;
  const std::array<glm::vec2, kHalfSection> points = {{{0.93f * w, 0.20f},
                                                       {1.00f * w, 0.36f},
                                                       {1.02f * w, 0.58f * belt / kBelt + 0.04f},
                                                       {0.98f * w, belt},
                                                       {(0.98f - 0.17f * lean) * w, belt + 0.80f * glass},
                                                       {(0.92f - 0.20f * lean) * w, belt + 0.93f * glass},
                                                       {0.45f * w, belt + 0.99f * glass},
                                                       {0.0f, station.roof}}};
  return points[static_cast<std::size_t>(step)];
}

void add_body(Model& car, const CarDesign& design, const std::vector<Station>& list) {
  constexpr int kSection = 2 * kHalfSection - 1;
  const auto across = [&](const Station& station, int step) {
    const bool left = step >= kHalfSection;
    const glm::vec2 p = section_point(station, left ? kSection - 1 - step : step);
    return glm::vec3(left ? -p.x : p.x, station.y, p.y);
  };
  // Columns run from back to front, rows from the right sill over the roof to the left sill: the outside is
  // seen.
  const int columns = static_cast<int>(list.size());
  add_sheet(
      car, columns, kSection,
      [&](int i, int j) { return across(list[static_cast<std::size_t>(columns - 1 - i)], j); },
      [&](int i, int j) -> std::string {
        const Station& front = list[static_cast<std::size_t>(columns - 2 - i)];
        const int row = j < kHalfSection - 1 ? j : kSection - 2 - j;
        if (row == 0) return "trim";
        if (row == 3 && front.side_glass) return "car glass";
        if (row >= 5 && front.top_glass) return "car glass";
        return design.paint;
      });
  const auto cap = [&](const Station& end, float side) {
    const float low = side * end.half_width * 0.93f, high = side * end.half_width * 0.98f,
                top = end.roof - 0.04f;
    add_quad(car, design.paint, {low, end.y, 0.20f}, {-low, end.y, 0.20f}, {-high, end.y, top},
             {high, end.y, top});
  };
  cap(list.front(), 1);
  cap(list.back(), -1);
}

void add_wheel(Model& car, glm::vec2 hub, float radius) {
  constexpr int kSegments = 16;
  constexpr float kWidth = 0.20f;
  const float side = hub.x > 0 ? 1.0f : -1.0f;
  const glm::vec3 outside(hub.x, hub.y, radius), outwards(side, 0, 0);
  add_disc(car, "trim", outside - 0.016f * outwards + glm::vec3(0, 0, 0.03f), outwards, radius * 1.17f,
           kSegments);
  add_bar(car, "tyre", outside - outwards * kWidth, outside + 0.004f * outwards, radius, kSegments);
  add_disc(car, "tyre", outside + 0.004f * outwards, outwards, radius, kSegments);
  add_disc(car, "rim", outside + 0.008f * outwards, outwards, radius * 0.64f, 12);
  add_disc(car, "trim", outside + 0.012f * outwards, outwards, radius * 0.16f, 6);
}

/// A panel on the front (heading 0) or the back (heading 180) of the car.
void add_fitting(Model& car, const std::string& paint, glm::vec3 centre, glm::vec2 size) {
  add_panel(car, paint, centre, centre.y > 0 ? 0.0f : 180.0f, size);
}

}  // namespace

Model make_car(const CarDesign& design) {
  Model car;
  const auto list = stations(design.shape);
  add_body(car, design, list);
  for (const float y : {1.36f, design.shape == CarShape::hatchback ? -1.16f : -1.34f})
    for (const float x : {0.885f, -0.885f}) add_wheel(car, {x, y}, 0.315f);

  const float front = list.front().y + 0.012f, back = list.back().y - 0.012f;
  const std::string plate = "plate " + std::to_string(design.plate);
  add_fitting(car, plate, {0, front, 0.36f}, {0.52f, 0.114f});
  add_fitting(car, plate, {0, back, 0.44f}, {0.52f, 0.114f});
  add_fitting(car, "trim", {0, front - 0.006f, 0.36f}, {0.90f, 0.20f});
  for (const float side : {1.0f, -1.0f}) {
    // Lamps sit proud of the rounded corners as small boxes.
    const float w = list[2].half_width;
    add_box(car, "headlight", {side * (w - 0.13f) - 0.12f, front - 0.16f, 0.50f},
            {side * (w - 0.13f) + 0.12f, front - 0.05f, 0.62f});
    const float v = list.back().half_width;
    add_box(car, "tail light", {side * (v - 0.02f) - 0.10f, back + 0.002f, 0.58f},
            {side * (v - 0.02f) + 0.10f, back + 0.12f, 0.70f});
    add_box(car, "indicator", {side * (v - 0.02f) - 0.10f, back + 0.004f, 0.52f},
            {side * (v - 0.02f) + 0.10f, back + 0.12f, 0.575f});
    add_box(car, "trim", {side * 0.91f - 0.09f, 0.66f, 0.93f},
            {side * 0.91f + 0.09f, 0.76f, 1.06f});  // door mirrors
  }
  // The road under a car is dark.
  add_quad(car, "contact shade", {-0.88f, back + 0.05f, 0.012f}, {0.88f, back + 0.05f, 0.012f},
           {0.88f, front - 0.05f, 0.012f}, {-0.88f, front - 0.05f, 0.012f});
  return car;
}

}  // namespace catoptra::examples
