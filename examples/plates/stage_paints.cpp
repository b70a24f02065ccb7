// Paints and patterns of the stages, and the labelled floors of Figure 2.
#include <cmath>
#include <string>

#include "examples/plates/stage.h"

namespace catoptra::examples {
namespace {

constexpr Rgba kPaper{232, 230, 222, 255}, kInk{24, 26, 30, 255}, kLine{150, 40, 36, 255};

Pixmap checker(const Rgba& light, const Rgba& dark) {
  Pixmap picture(128, 128, light);
  picture.rectangle(64, 0, 128, 64, dark);
  picture.rectangle(0, 64, 64, 128, dark);
  return picture;
}

/// 20 columns A to T by 12 rows 1 to 12 of named squares, 64 px each.
Pixmap named_squares(const Font& font) {
  constexpr int kColumns = 20, kRows = 12, kSide = 64;
  Pixmap picture(kColumns * kSide, kRows * kSide, kPaper);
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const int x = column * kSide, y = row * kSide;
      if ((row + column) % 2)
        picture.rectangle(x, y, x + kSide, y + kSide,
                          mix({188, 206, 222, 255}, {222, 206, 180, 255}, float(row) / kRows));
      picture.rectangle(x, y, x + kSide, y + 2, kInk);
      picture.rectangle(x, y, x + 2, y + kSide, kInk);
      const std::string name = std::string(1, char('A' + column)) + std::to_string(row + 1);
      picture.text(font, name, {float(x) + 33, float(y) + 33}, 22, 52, kInk);
    }
  return picture;
}

Pixmap letters(const Font& font, const char* text, const Rgba& ground) {
  Pixmap picture(512, 256, kInk);
  picture.rectangle(10, 10, 502, 246, ground);
  picture.text(font, text, {256, 128}, 120, 440, kInk);
  return picture;
}

/// Grey, with a thin line where two regions meet and each region's number in the middle of its largest
/// square.
Pixmap region_floor(const Font& font, const LightStage& stage) {
  constexpr double kPerMetre = 300;
  const glm::dvec2 size = stage.floor_high - stage.floor_low;
  const int width = int(std::lround(size.x * kPerMetre)), height = int(std::lround(size.y * kPerMetre));
  Pixmap picture(width, height, {208, 206, 200, 255});
  const auto pixel = [&](const glm::dvec2& p) {
    return glm::dvec2(p.x - stage.floor_low.x, stage.floor_high.y - p.y) * kPerMetre;
  };
  const auto region = [&](int x, int y) {
    return floor_region(
        stage, {stage.floor_low.x + (x + 0.5) / kPerMetre, stage.floor_high.y - (y + 0.5) / kPerMetre});
  };
  for (int y = 0; y + 1 < height; ++y)
    for (int x = 0; x + 1 < width; ++x) {
      const int here = region(x, y);
      if (here != region(x + 1, y) || here != region(x, y + 1)) picture.rectangle(x, y, x + 2, y + 2, kLine);
    }
  const auto places = label_places(stage);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].half_side <= 0) continue;
    const double tall = std::min(kLargestNumber_m, kNumberShare * 2 * places[i].half_side);
    picture.text(font, std::to_string(i + 1), glm::vec2(pixel(places[i].middle)), float(tall * kPerMetre),
                 float(tall * kPerMetre), kInk);
  }
  return picture;
}

}  // namespace

void add_stage_paints(Palette& palette, const std::filesystem::path& font_file) {
  const Font font(font_file);
  const auto picture = [&](const std::string& name, Pixmap pixmap) {
    palette.textures.insert_or_assign(name, std::move(pixmap));
    palette.paints[name] = {glm::vec3(1), name, 0};
  };
  picture("stage floor", checker({206, 202, 192, 255}, {120, 124, 132, 255}));
  picture("stage wall", checker({224, 220, 208, 255}, {206, 200, 186, 255}));
  picture("named squares", named_squares(font));
  picture("letters FROG", letters(font, "FROG", {238, 196, 70, 255}));
  picture("letters PLUG", letters(font, "PLUG", {120, 190, 220, 255}));
  picture("regions refraction", region_floor(font, refraction_stage()));
  picture("regions reflection", region_floor(font, reflection_stage()));
  const auto plain = [&](const char* name, glm::vec3 color) { palette.paints[name] = {color, "", 0}; };
  plain("stage red", {0.62f, 0.06f, 0.05f});
  plain("stage green", {0.07f, 0.42f, 0.14f});
  plain("stage blue", {0.06f, 0.16f, 0.55f});
  plain("stage yellow", {0.80f, 0.56f, 0.06f});
  plain("stage white", {0.80f, 0.80f, 0.78f});
  plain("stage frame", {0.05f, 0.05f, 0.06f});
}

}  // namespace catoptra::examples
