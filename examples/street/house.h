// Terraced houses with windows, doors and shops.
#pragma once

#include <string>

#include "examples/street/model.h"

namespace catoptra::examples {

/// A house whose front lies in the plane y = 0 and looks towards +y, from x = 0 to x = -width, behind it
/// `depth`. Seen from the street its left end is at x = 0.
struct HouseDesign {
  float width = 8, depth = 9;
  int storeys = 2;   ///< each 2.9 m high
  int bays = 3;      ///< windows a storey
  int door_bay = 0;  ///< counted from the left; -1: no door
  std::string wall = "bricks";
  std::string door = "green door";
  std::string shop;     ///< paint of the sign over a shop on the ground floor; empty: a dwelling
  std::string hanging;  ///< paint of a sign that hangs out over the pavement; empty: none
  bool glazed = false;  ///< the shop's window, or without a shop all of them, are holes: see interiors.h
};

/// How far behind the front a painted window lies, and the height of a storey, m.
inline constexpr float kReveal = 0.16f;
inline constexpr float kStorey = 2.9f;

[[nodiscard]] Model make_house(const HouseDesign& design);

/// A tower of 3.6 m square and 9 m with a clock on its front and a notice board below; placed like a house.
[[nodiscard]] Model make_clock_tower();

/// A brick wall in the plane y = 0 that looks towards +y, 8 m wide and 6 m high around the origin, with a
/// clock and boards to read.
[[nodiscard]] Model make_wall();

}  // namespace catoptra::examples
