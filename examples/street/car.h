// Cars with rounded bodies. A car stands on z = 0, its middle at the origin, and drives towards +y.
#pragma once

#include <string>

#include "examples/street/model.h"

namespace catoptra::examples {

enum class CarShape { saloon, hatchback, van };

struct CarDesign {
  CarShape shape = CarShape::saloon;
  std::string paint = "car red";
  int plate = 0;  ///< number plate, see plate_text()
};

/// About 700 triangles: body, windows, wheels, lights, number plates in front and behind.
[[nodiscard]] Model make_car(const CarDesign& design);

}  // namespace catoptra::examples
