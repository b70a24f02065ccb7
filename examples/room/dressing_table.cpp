#include "examples/room/dressing_table.h"

#include "examples/street/shapes.h"

namespace catoptra::examples {
namespace {

constexpr float kTop = -0.080f;  // of the table: just below the mirror's shell
constexpr int kSegments = 24;

void add_table(Model& model) {
  add_box(model, "table wood", {-0.30f, -0.16f, kTop - 0.02f}, {0.30f, 0.33f, kTop});
  for (const float x : {-0.27f, 0.27f})
    for (const float y : {-0.13f, 0.30f})
      add_box(model, "table wood", {x - 0.02f, y - 0.02f, -1.2f}, {x + 0.02f, y + 0.02f, kTop - 0.02f});
  add_bar(model, "brass", {0, -0.06f, kTop}, {0, -0.06f, 0}, 0.006f, 12);  // carries the mirror
  add_lathe(model, "brass", {0, -0.06f, kTop}, {{0.045f, 0}, {0.045f, 0.004f}, {0.006f, 0.008f}}, kSegments);
}

}  // namespace

Model make_dressing_table() {
  Model model;
  add_table(model);
  add_lathe(model, "gilt", {0.005f, 0.115f, kTop}, {{0.010f, 0}, {0.010f, 0.045f}, {0.0065f, 0.046f}},
            kSegments);
  add_lathe(model, "tail light", {0.005f, 0.115f, kTop},
            {{0.0065f, 0.046f}, {0.0065f, 0.068f}, {0.004f, 0.075f}, {0.0005f, 0.077f}}, kSegments);
  add_lathe(
      model, "blue glaze", {-0.022f, 0.175f, kTop},
      {{0.020f, 0}, {0.024f, 0.006f}, {0.024f, 0.050f}, {0.017f, 0.062f}, {0.008f, 0.066f}, {0.008f, 0.070f}},
      kSegments);
  add_lathe(model, "brass", {-0.022f, 0.175f, kTop + 0.070f},
            {{0.011f, 0}, {0.011f, 0.016f}, {0.007f, 0.020f}, {0.0005f, 0.021f}}, kSegments);
  add_box(model, "pages", {0.014f, 0.1505f, kTop}, {0.046f, 0.1535f, kTop + 0.050f});
  add_panel(model, "letter chart", {0.030f, 0.150f, kTop + 0.025f}, 180, {0.032f, 0.050f});
  return model;
}

}  // namespace catoptra::examples
