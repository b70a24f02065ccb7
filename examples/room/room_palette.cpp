#include "examples/room/room_palette.h"

#include <cmath>
#include <string>

namespace catoptra::examples {
namespace {

constexpr Rgba kPaper{246, 244, 236, 255}, kInk{16, 16, 18, 255}, kGold{240, 206, 110, 255};

constexpr std::array<Rgba, 6> kCloth{{{126, 30, 34, 255},
                                      {26, 60, 112, 255},
                                      {30, 88, 58, 255},
                                      {214, 176, 62, 255},
                                      {58, 44, 84, 255},
                                      {208, 204, 194, 255}}};

/// The back of a book, lying: 512 x 96.
Pixmap book_back(const Font& font, const char* title, std::size_t index) {
  const Rgba cloth = kCloth[index % kCloth.size()];
  const bool light = cloth[0] > 200;
  const Rgba letters = light ? kInk : kGold;
  Pixmap picture(512, 96, cloth);
  for (const int x : {14, 26, 482, 494}) picture.rectangle(x, 0, x + 5, 96, letters);
  picture.text(font, title, {256, 48}, 54, 400, letters);
  return picture;
}

/// Rows of letters, each row smaller than the one above, as opticians hang them up.
Pixmap letter_chart(const Font& font) {
  constexpr std::array kRows{"R", "K O", "H D V", "N Z C R", "S K O H D", "V N Z C R S"};
  Pixmap picture(512, 768, kPaper);
  float height = 150, y = 110;
  for (const char* row : kRows) {
    picture.text(font, row, {256, y}, height, 470, kInk);
    y += height * 0.5f + 38;
    height *= 0.66f;
    y += height * 0.5f;
  }
  picture.rectangle(0, 0, 512, 8, kInk);
  picture.rectangle(0, 760, 512, 768, kInk);
  picture.rectangle(0, 0, 8, 768, kInk);
  picture.rectangle(504, 0, 512, 768, kInk);
  return picture;
}

/// Hills, a lake and a sun.
Pixmap landscape() {
  Pixmap picture(512, 320, {150, 190, 220, 255});
  for (int y = 0; y < 190; ++y)
    picture.rectangle(0, y, 512, y + 1, mix({96, 150, 206, 255}, {238, 222, 190, 255}, float(y) / 190));
  picture.disc({380, 90}, 34, {255, 236, 170, 255});
  for (int x = 0; x < 512; ++x) {
    const float t = float(x) / 512;
    const int far = 150 - int(34 * std::sin(5 * t + 1)), near = 196 - int(30 * std::sin(3 * t + 2.4f));
    picture.rectangle(x, far, x + 1, 320, {88, 112, 128, 255});
    picture.rectangle(x, near, x + 1, 320, {72, 106, 62, 255});
  }
  picture.rectangle(60, 236, 300, 290, {120, 168, 196, 255});
  picture.grain(0.04f, 2, 41);
  return picture;
}

Pixmap floorboards() {
  Pixmap picture(256, 256, {150, 104, 66, 255});
  for (int board = 0; board < 4; ++board) {
    const Rgba shade = mix({166, 118, 76, 255}, {128, 86, 52, 255}, noise(board, 0, 51));
    picture.rectangle(board * 64, 0, board * 64 + 62, 256, shade);
    picture.rectangle(board * 64, 60 + 40 * board, board * 64 + 62, 62 + 40 * board, {84, 56, 36, 255});
  }
  picture.grain(0.10f, 2, 52);
  return picture;
}

Pixmap rug() {
  Pixmap picture(256, 256, {140, 36, 40, 255});
  for (int i = 0; i < 5; ++i) {
    const Rgba band = i % 2 ? Rgba{226, 204, 160, 255} : Rgba{34, 52, 92, 255};
    const int a = 10 + 14 * i;
    picture.rectangle(a, a, 256 - a, a + 5, band);
    picture.rectangle(a, 251 - a, 256 - a, 256 - a, band);
    picture.rectangle(a, a, a + 5, 256 - a, band);
    picture.rectangle(251 - a, a, 256 - a, 256 - a, band);
  }
  picture.grain(0.06f, 2, 53);
  return picture;
}

Pixmap wallpaper() {
  Pixmap picture(256, 256, {206, 212, 196, 255});
  for (int i = 0; i < 8; i += 2) picture.rectangle(i * 32, 0, i * 32 + 32, 256, {194, 202, 184, 255});
  return picture;
}

}  // namespace

void add_room_paints(Palette& palette, const std::filesystem::path& font_file) {
  const Font font(font_file);
  const auto picture = [&](const std::string& name, Pixmap pixmap) {
    palette.textures.insert_or_assign(name, std::move(pixmap));
    palette.paints[name] = {glm::vec3(1), name, 0};
  };
  for (std::size_t i = 0; i < kBookTitles.size(); ++i)
    picture("book " + std::to_string(i), book_back(font, kBookTitles[i], i));
  picture("letter chart", letter_chart(font));
  picture("landscape", landscape());
  picture("floorboards", floorboards());
  picture("rug", rug());
  picture("wallpaper", wallpaper());
  const auto plain = [&](const char* name, glm::vec3 color) { palette.paints[name] = {color, "", 0}; };
  plain("pages", {0.86f, 0.82f, 0.72f});
  plain("ceiling", {0.85f, 0.85f, 0.83f});
  plain("shelf wood", {0.24f, 0.13f, 0.06f});
  plain("table wood", {0.42f, 0.24f, 0.11f});
  plain("gilt", {0.62f, 0.44f, 0.14f});
  plain("curtain", {0.55f, 0.16f, 0.12f});
  plain("window frame", {0.03f, 0.03f, 0.035f});
  plain("daylight", {1.0f, 1.0f, 1.0f});
  plain("lamp shade", {0.95f, 0.82f, 0.55f});
  plain("brass", {0.55f, 0.40f, 0.14f});
  plain("porcelain", {0.82f, 0.84f, 0.88f});
  plain("blue glaze", {0.04f, 0.12f, 0.38f});
  plain("spectacle frame", {0.10f, 0.03f, 0.02f});
  for (std::size_t i = 0; i < kCloth.size(); ++i) {
    const auto linear = [&](std::size_t k) { return std::pow(float(kCloth[i][k]) / 255, 2.2f); };
    palette.paints["cloth " + std::to_string(i)] = {{linear(0), linear(1), linear(2)}, "", 0};
  }
}

}  // namespace catoptra::examples
