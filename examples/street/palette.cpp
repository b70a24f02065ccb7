#include "examples/street/palette.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

namespace catoptra::examples {
namespace {

constexpr Rgba kWhite{245, 245, 240, 255}, kBlack{20, 20, 22, 255}, kBlue{18, 70, 150, 255},
    kRed{190, 22, 28, 255}, kYellow{240, 200, 40, 255}, kGreen{20, 95, 60, 255}, kMortar{196, 190, 178, 255},
    kGlass{52, 66, 80, 255};

Pixmap bricks(const Rgba& color, int seed) {
  // One square metre: 4 bricks by 12 courses, in stretcher bond.
  Pixmap picture(256, 256, kMortar);
  for (int course = 0; course < 12; ++course)
    for (int i = 0; i <= 4; ++i) {
      const int x = i * 64 - (course % 2) * 32, y = course * 256 / 12, next = (course + 1) * 256 / 12;
      const Rgba shade = mix(color, kBlack, 0.3f * noise(i % 4, course, seed));
      picture.rectangle(x + 2, y + 2, x + 62, next - 2, shade);
    }
  picture.grain(0.08f, 2, seed);
  return picture;
}

Pixmap speckled(int size, const Rgba& color, float fine, float coarse, int seed) {
  Pixmap picture(size, size, color);
  picture.grain(coarse, size / 16, seed);
  picture.grain(fine, 1, seed + 1);
  return picture;
}

Pixmap paving() {
  // Two metres square: slabs of half a metre, every other row moved by half a slab.
  Pixmap picture(256, 256, {112, 110, 106, 255});
  for (int row = 0; row < 4; ++row)
    for (int i = 0; i <= 4; ++i) {
      const int x = i * 64 - (row % 2) * 32;
      const Rgba shade = mix({176, 172, 164, 255}, {146, 142, 136, 255}, noise(i % 4, row, 5));
      picture.rectangle(x + 1, row * 64 + 1, x + 63, row * 64 + 63, shade);
    }
  picture.grain(0.06f, 1, 6);
  return picture;
}

Pixmap roof_tiles() {
  Pixmap picture(128, 128, {120, 58, 44, 255});
  for (int row = 0; row < 8; ++row)
    for (int x = 0; x < 128; ++x) {
      const int across = (x + (row % 2) * 8) % 16;
      const float round = 1 - std::abs(float(across) - 7.5f) / 8;
      for (int y = 0; y < 16; ++y)
        picture.set(x, row * 16 + y,
                    mix({70, 32, 26, 255}, {170, 84, 60, 255},
                        std::min(1.0f, round * 1.4f) * (0.5f + float(y) / 30)));
    }
  picture.grain(0.08f, 4, 9);
  return picture;
}

Pixmap window(bool curtains) {
  Pixmap picture(128, 192, kWhite);
  for (int y = 8; y < 184; ++y)
    for (int x = 8; x < 120; ++x) {
      const bool bar = std::abs(x - 64) < 4 || std::abs(y - 64) < 4;
      if (bar) continue;
      Rgba shade = mix(mix(kGlass, {120, 150, 178, 255}, 0.6f * float(184 - y) / 176), kBlack, 0.15f);
      if (curtains && std::abs(x - 64) > 28 + (184 - y) / 20)
        shade = mix({226, 216, 196, 255}, {176, 160, 138, 255}, 0.5f + 0.5f * std::sin(float(x) * 0.7f));
      picture.set(x, y, shade);
    }
  return picture;
}

Pixmap door(const Rgba& color) {
  Pixmap picture(96, 192, color);
  for (const auto& [y0, y1] : {std::array{14, 66}, {82, 120}, {134, 182}})
    for (const int x0 : {12, 54}) {
      picture.rectangle(x0, y0, x0 + 30, y1, mix(color, kBlack, 0.35f));
      picture.rectangle(x0 + 3, y0 + 3, x0 + 30, y1, mix(color, kWhite, 0.12f));
    }
  picture.rectangle(12, 14, 84, 66, kGlass);
  picture.rectangle(45, 14, 51, 66, color);
  picture.disc({86, 104}, 4, kYellow);
  return picture;
}

Pixmap shop_window() {
  Pixmap picture(256, 192, {40, 48, 56, 255});
  for (int i = 0; i < 9; ++i)
    picture.disc({20 + 27 * float(i), 60 + 16 * noise(i, 0, 3)}, 11, mix(kYellow, kWhite, noise(i, 1, 3)));
  for (int i = 0; i < 12; ++i)
    picture.rectangle(10 + 20 * i, 150 - int(40 * noise(i, 2, 3)), 24 + 20 * i, 180,
                      mix(kRed, {70, 140, 170, 255}, noise(i, 4, 3)));
  for (const int x : {0, 82, 168, 250}) picture.rectangle(x, 0, x + 6, 192, {60, 40, 28, 255});
  return picture;
}

Pixmap leaves(int seed, const Rgba& light, const Rgba& dark) {
  Pixmap picture(128, 128, {dark[0], dark[1], dark[2], 0});
  for (int i = 0; i < 150; ++i) {
    const float angle = 6.2831853f * noise(i, 0, seed), reach = 56 * std::sqrt(noise(i, 1, seed));
    const glm::vec2 centre = 64.0f + reach * glm::vec2(std::cos(angle), std::sin(angle));
    const float turn = 6.2831853f * noise(i, 2, seed), size = 5 + 4 * noise(i, 3, seed);
    const glm::vec2 along = size * glm::vec2(std::cos(turn), std::sin(turn)),
                    across = glm::vec2(-along.y, along.x) * 0.5f;
    const Rgba shade = mix(dark, light, noise(i, 4, seed));
    for (int y = int(centre.y) - 10; y < int(centre.y) + 10; ++y)
      for (int x = int(centre.x) - 10; x < int(centre.x) + 10; ++x) {
        const glm::vec2 p = glm::vec2(x, y) - centre;
        const float a = glm::dot(p, along) / glm::dot(along, along),
                    b = glm::dot(p, across) / glm::dot(across, across);
        if (a * a + b * b < 1) picture.set(x, y, shade);
      }
  }
  return picture;
}

Pixmap framed(int width, int height, const Rgba& ground, const Rgba& frame, int border) {
  Pixmap picture(width, height, frame);
  picture.rectangle(border, border, width - border, height - border, ground);
  return picture;
}

void arrow(Pixmap& picture, glm::vec2 foot, float length, float heading_deg, const Rgba& color) {
  const float angle = glm::radians(heading_deg);
  const glm::vec2 along(std::sin(angle), -std::cos(angle)), across(-along.y, along.x);
  const glm::vec2 neck = foot + along * length * 0.6f;
  const float half = length * 0.09f, head = length * 0.3f;
  picture.polygon({foot - across * half, foot + across * half, neck + across * half, neck - across * half},
                  color);
  picture.polygon({neck - across * head, neck + across * head, foot + along * length}, color);
}

Pixmap direction_sign(const Font& font) {
  Pixmap picture = framed(1024, 512, kBlue, kWhite, 14);
  arrow(picture, {115, 215}, 150, 0, kWhite);
  picture.text(font, "Velmora", {470, 140}, 105, 540, kWhite);
  picture.text(font, "12", {890, 140}, 105, 180, kWhite);
  picture.rectangle(30, 252, 994, 260, kWhite);
  arrow(picture, {45, 380}, 150, 90, kWhite);
  picture.text(font, "Quillford", {500, 370}, 105, 540, kWhite);
  picture.text(font, "7", {890, 370}, 105, 180, kWhite);
  return picture;
}

Pixmap board(const Font& font, const char* text, int width, int height, const Rgba& ground,
             const Rgba& letters) {
  Pixmap picture = framed(width, height, ground, letters, height / 24);
  picture.text(font, text, {float(width) / 2, float(height) / 2}, float(height) * 0.45f, float(width) * 0.88f,
               letters);
  return picture;
}

/// A round or eight-sided sign on a transparent ground.
Pixmap octagon(const Font& font) {
  Pixmap picture(256, 256, {190, 22, 28, 0});
  const auto ring = [](float radius) {
    std::vector<glm::vec2> corners;
    for (int i = 0; i < 8; ++i) {
      const float angle = glm::radians(22.5f + 45 * float(i));
      corners.push_back(128.0f + radius * glm::vec2(std::cos(angle), std::sin(angle)));
    }
    return corners;
  };
  picture.polygon(ring(127), kWhite);
  picture.polygon(ring(117), kRed);
  picture.text(font, "STOP", {128, 128}, 74, 190, kWhite);
  return picture;
}

Pixmap speed_limit(const Font& font) {
  Pixmap picture(256, 256, {190, 22, 28, 0});
  picture.disc({128, 128}, 126, kRed);
  picture.disc({128, 128}, 98, kWhite);
  picture.text(font, "30", {128, 128}, 92, 150, kBlack);
  return picture;
}

Pixmap clock_face(const Font& font) {
  Pixmap picture(512, 512, {40, 44, 60, 0});
  picture.disc({256, 256}, 250, {40, 44, 60, 255});
  picture.disc({256, 256}, 228, kWhite);
  const auto hand = [&](float angle_deg, float length, float width) {
    const float angle = glm::radians(angle_deg);
    const glm::vec2 along(std::sin(angle), -std::cos(angle)), across(-along.y, along.x);
    const glm::vec2 tail = 256.0f - along * 30.0f, tip = 256.0f + along * length;
    picture.polygon({tail - across * width, tail + across * width, tip + across * width * 0.4f,
                     tip - across * width * 0.4f},
                    kBlack);
  };
  for (int hour = 1; hour <= 12; ++hour) {
    const float angle = glm::radians(30 * float(hour));
    picture.text(font, std::to_string(hour), 256.0f + 186.0f * glm::vec2(std::sin(angle), -std::cos(angle)),
                 50, 80, kBlack);
  }
  hand(30 * (4 + 10 / 60.0f), 110, 12);  // ten past four: unmistakable in a mirror
  hand(60, 165, 8);
  return picture;
}

void add_signs(Palette& palette, const Font& font) {
  const auto picture = [&](const std::string& name, Pixmap pixmap, float cutoff = 0) {
    palette.textures.insert_or_assign(name, std::move(pixmap));
    palette.paints[name] = {glm::vec3(1), name, cutoff};
  };
  picture("direction sign", direction_sign(font));
  picture("stop sign", octagon(font), 0.5f);
  picture("speed limit", speed_limit(font), 0.5f);
  picture("clock", clock_face(font), 0.5f);
  picture("street name", board(font, "CATOPTRIC ROAD", 512, 96, {240, 240, 232, 255}, {20, 60, 40, 255}));
  picture("shop optician", board(font, "FOCAL & SON", 512, 128, kGreen, kYellow));
  picture("shop baker", board(font, "BAKERY", 512, 128, {110, 30, 40, 255}, kWhite));
  picture("shop books", board(font, "BOOKS & MAPS", 512, 128, {24, 40, 80, 255}, kWhite));
  // Inside the shops, where little light comes.
  constexpr Rgba kDim{58, 52, 48, 255}, kDimInk{190, 172, 128, 255};
  picture("dim board optician", board(font, "SPECTACLES", 512, 128, kDim, kDimInk));
  picture("dim board baker", board(font, "FRESH BREAD", 512, 128, kDim, kDimInk));
  picture("dim board books", board(font, "OLD MAPS", 512, 128, kDim, kDimInk));
  for (int i = 0; i < 10; ++i) {
    const std::string number = std::to_string(i);
    picture("dim board number " + number, board(font, number.c_str(), 128, 128, kDim, kDimInk));
  }
  picture("hanging sign", board(font, "CAFÉ", 256, 192, {70, 40, 24, 255}, {250, 220, 150, 255}));
  picture("notice", board(font, "MARKET SQUARE", 512, 128, kWhite, kBlack));
  for (int i = 0; i < 6; ++i)
    picture("plate " + std::to_string(i), board(font, plate_text(i).c_str(), 256, 56, kWhite, kBlack));
}

void add_masonry(Palette& palette) {
  palette.textures.insert_or_assign("bricks", bricks({178, 92, 66, 255}, 1));
  palette.textures.insert_or_assign("pale bricks", bricks({206, 176, 122, 255}, 2));
  palette.textures.insert_or_assign("plaster", speckled(128, {228, 226, 220, 255}, 0.05f, 0.03f, 11));
  palette.textures.insert_or_assign("asphalt", speckled(256, {92, 92, 96, 255}, 0.22f, 0.06f, 21));
  palette.textures.insert_or_assign("lane paint", speckled(64, {226, 226, 220, 255}, 0.10f, 0.06f, 23));
  palette.textures.insert_or_assign("grass", speckled(128, {104, 128, 76, 255}, 0.25f, 0.12f, 25));
  palette.textures.insert_or_assign("bark", speckled(64, {104, 84, 66, 255}, 0.25f, 0.2f, 27));
  palette.textures.insert_or_assign("paving", paving());
  palette.textures.insert_or_assign("roof tiles", roof_tiles());
  palette.textures.insert_or_assign("window", window(false));
  palette.textures.insert_or_assign("window with curtains", window(true));
  palette.textures.insert_or_assign("shop window", shop_window());
  palette.textures.insert_or_assign("green door", door({40, 88, 66, 255}));
  palette.textures.insert_or_assign("red door", door({140, 40, 36, 255}));
  palette.textures.insert_or_assign("leaves", leaves(31, {146, 178, 74, 255}, {54, 92, 36, 255}));
  palette.textures.insert_or_assign("autumn leaves", leaves(33, {222, 164, 60, 255}, {150, 84, 34, 255}));
  for (const auto& [name, picture] : palette.textures) palette.paints[name] = {glm::vec3(1), name, 0};
  palette.paints["leaves"].alpha_cutoff = palette.paints["autumn leaves"].alpha_cutoff = 0.5f;
  palette.paints["plaster yellow"] = {{0.95f, 0.80f, 0.50f}, "plaster", 0};
  palette.paints["plaster blue"] = {{0.62f, 0.76f, 0.88f}, "plaster", 0};
  palette.paints["plaster rose"] = {{0.92f, 0.66f, 0.58f}, "plaster", 0};
}

void add_plain_paints(Palette& palette) {
  const auto plain = [&](const char* name, glm::vec3 color) { palette.paints[name] = {color, "", 0}; };
  plain("stone", {0.55f, 0.52f, 0.47f});
  plain("metal", {0.34f, 0.36f, 0.38f});
  plain("lamp", {0.95f, 0.92f, 0.80f});
  plain("sign back", {0.42f, 0.43f, 0.44f});
  plain("dark wood", {0.10f, 0.055f, 0.03f});
  plain("contact shade", {0.030f, 0.030f, 0.033f});
  plain("dim wall", {0.050f, 0.045f, 0.040f});
  plain("dim floor", {0.060f, 0.040f, 0.025f});
  plain("dim ceiling", {0.070f, 0.070f, 0.065f});
  plain("goods red", {0.28f, 0.04f, 0.03f});
  plain("goods blue", {0.04f, 0.10f, 0.25f});
  plain("goods yellow", {0.32f, 0.22f, 0.03f});
  plain("goods white", {0.32f, 0.32f, 0.30f});
  plain("car glass", {0.045f, 0.060f, 0.075f});
  plain("tyre", {0.022f, 0.022f, 0.024f});
  plain("rim", {0.50f, 0.51f, 0.53f});
  plain("trim", {0.030f, 0.030f, 0.034f});
  plain("headlight", {0.92f, 0.93f, 0.95f});
  plain("tail light", {0.60f, 0.02f, 0.02f});
  plain("indicator", {0.90f, 0.36f, 0.03f});
  plain("car red", {0.52f, 0.035f, 0.030f});
  plain("car blue", {0.040f, 0.13f, 0.40f});
  plain("car silver", {0.52f, 0.54f, 0.56f});
  plain("car yellow", {0.80f, 0.50f, 0.04f});
  plain("car white", {0.80f, 0.80f, 0.78f});
  plain("own car", {0.035f, 0.22f, 0.14f});
  plain("own car shade", {0.012f, 0.075f, 0.048f});
  plain("upholstery", {0.10f, 0.09f, 0.085f});
}

}  // namespace

std::string plate_text(int index) {
  constexpr std::array kPlates{"CO 1200 NV", "CO 300 CX", "PV 49 RR", "ME 6371 K", "SN 1621 L", "FR 1818 E"};
  return kPlates.at(static_cast<std::size_t>(index));
}

Palette make_palette(const std::filesystem::path& font_file) {
  const Font font(font_file);
  Palette palette;
  add_masonry(palette);
  add_plain_paints(palette);
  add_signs(palette, font);
  return palette;
}

}  // namespace catoptra::examples
