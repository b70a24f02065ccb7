#include "examples/room/room.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "examples/room/room_palette.h"
#include "examples/street/shapes.h"

namespace catoptra::examples {
namespace {

constexpr float kLeft = -2.4f, kRight = 2.4f, kBack = -2.0f, kFront = 4.0f, kHeight = 2.6f;

/// Floor, ceiling and walls, seen from inside; the front wall has a hole for the window.
constexpr float kWindowLeft = -1.9f, kWindowRight = -0.3f, kSill = 0.9f, kLintel = 2.2f;

/// A piece of the front wall.
void add_front_wall(Model& room, float x0, float x1, float z0, float z1) {
  add_tiled_quad(room, "wallpaper", {x0, kFront, z0}, {x1, kFront, z0}, {x1, kFront, z1}, {x0, kFront, z1},
                 0.8f);
}

void add_shell(Model& room) {
  for (float y = kBack; y < kFront - 0.1f; y += 1) {  // short pieces: see the street's ground
    add_tiled_quad(room, "floorboards", {kLeft, y, 0}, {kRight, y, 0}, {kRight, y + 1, 0}, {kLeft, y + 1, 0},
                   0.6f);
    add_quad(room, "ceiling", {kLeft, y + 1, kHeight}, {kRight, y + 1, kHeight}, {kRight, y, kHeight},
             {kLeft, y, kHeight});
    add_tiled_quad(room, "wallpaper", {kLeft, y, 0}, {kLeft, y + 1, 0}, {kLeft, y + 1, kHeight},
                   {kLeft, y, kHeight}, 0.8f);
    add_tiled_quad(room, "wallpaper", {kRight, y + 1, 0}, {kRight, y, 0}, {kRight, y, kHeight},
                   {kRight, y + 1, kHeight}, 0.8f);
  }
  add_tiled_quad(room, "wallpaper", {kRight, kBack, 0}, {kLeft, kBack, 0}, {kLeft, kBack, kHeight},
                 {kRight, kBack, kHeight}, 0.8f);
  add_front_wall(room, kLeft, kWindowLeft, 0, kHeight);
  add_front_wall(room, kWindowRight, kRight, 0, kHeight);
  add_front_wall(room, kWindowLeft, kWindowRight, 0, kSill);
  add_front_wall(room, kWindowLeft, kWindowRight, kLintel, kHeight);
}

/// Dark bars before the bright sky: the edges at which colours part.
void add_window(Model& room) {
  const auto bar = [&](float x0, float x1, float z0, float z1) {
    add_box(room, "window frame", {x0, kFront - 0.03f, z0}, {x1, kFront + 0.05f, z1});
  };
  bar(kWindowLeft, kWindowRight, kSill, kSill + 0.06f);
  bar(kWindowLeft, kWindowRight, kLintel - 0.06f, kLintel);
  for (int i = 0; i <= 3; ++i) {
    const float x = kWindowLeft + (kWindowRight - kWindowLeft - 0.06f) * float(i) / 3;
    bar(x, x + 0.06f, kSill, kLintel);
  }
  bar(kWindowLeft, kWindowRight, 1.68f, 1.72f);
  add_quad(room, "daylight", {kWindowLeft, kFront + 0.2f, kSill}, {kWindowRight, kFront + 0.2f, kSill},
           {kWindowRight, kFront + 0.2f, kLintel}, {kWindowLeft, kFront + 0.2f, kLintel});
  add_box(room, "porcelain", {kWindowLeft - 0.1f, kFront - 0.22f, kSill - 0.04f},
          {kWindowRight + 0.1f, kFront, kSill});
  for (const float left : {kWindowLeft - 0.35f, kWindowRight - 0.05f})
    add_sheet(
        room, 33, 7,
        [&](int i, int j) {
          const float s = float(i) / 32;
          return glm::vec3(left + 0.4f * s, kFront - 0.12f + 0.035f * std::sin(s * 44),
                           0.1f + 2.25f * float(j) / 6);
        },
        [](int, int) { return std::string("curtain"); });
}

void add_picture(Model& room, const std::string& paint, glm::vec3 centre, glm::vec2 size) {
  const glm::vec3 half(size.x / 2 + 0.05f, 0, size.y / 2 + 0.05f);
  add_box(room, "gilt", centre - half, centre + half + glm::vec3(0, 0.03f, 0));
  add_panel(room, paint, centre - glm::vec3(0, 0.004f, 0), 180, size);
}

/// A standing book whose back looks towards -y, its title from top to bottom.
void add_standing_book(Model& room, int title, glm::vec3 foot, glm::vec3 size) {
  const std::string cloth = "cloth " + std::to_string(title % 6), back = "book " + std::to_string(title);
  const glm::vec3 top = foot + size;
  add_box(room, cloth, foot + glm::vec3(0, 0.002f, 0), top);
  add_box(room, "pages", foot + glm::vec3(0.004f, 0.01f, 0.004f),
          {top.x - 0.004f, top.y - 0.006f, top.z + 0.001f});
  add_quad(room, back, {foot.x, foot.y, top.z}, foot, {top.x, foot.y, foot.z}, {top.x, foot.y, top.z});
}

void add_lying_book(Model& room, int title, glm::vec3 foot, glm::vec3 size) {
  const glm::vec3 top = foot + size;
  add_box(room, "cloth " + std::to_string(title % 6), foot + glm::vec3(0, 0.002f, 0), top);
  add_quad(room, "book " + std::to_string(title), foot, {top.x, foot.y, foot.z}, {top.x, foot.y, top.z},
           {foot.x, foot.y, top.z});
}

/// An open bookcase, its front in the plane y = 1.5.
void add_bookcase(Model& room) {
  constexpr float kX0 = 0.10f, kX1 = 1.00f, kY0 = 1.50f, kY1 = 1.78f, kBoard = 0.022f, kStep = 0.36f;
  for (const float x : {kX0, kX1 - kBoard})
    add_box(room, "shelf wood", {x, kY0, 0}, {x + kBoard, kY1, 5 * kStep + kBoard});
  for (int shelf = 0; shelf <= 5; ++shelf)
    add_box(room, "shelf wood", {kX0, kY0, kStep * float(shelf)}, {kX1, kY1, kStep * float(shelf) + kBoard});
  add_box(room, "shelf wood", {kX0, kY1 - 0.01f, 0}, {kX1, kY1, 5 * kStep});
  int title = 0;
  for (int shelf = 0; shelf < 5; ++shelf) {
    const float z = kStep * float(shelf) + kBoard;
    float x = kX0 + kBoard + 0.01f;
    const float end = kX1 - kBoard - (shelf % 2 ? 0.30f : 0.02f);
    for (int i = 0; x < end - 0.06f; ++i, ++title) {
      const float thick = 0.042f + 0.018f * noise(i, shelf, 61), high = 0.24f + 0.07f * noise(i, shelf, 62);
      add_standing_book(room, title % int(kBookTitles.size()), {x, kY0 + 0.03f, z}, {thick, 0.18f, high});
      x += thick + 0.002f;
    }
    if (shelf % 2)
      for (int i = 0; i < 3; ++i, ++title)
        add_lying_book(room, title % int(kBookTitles.size()),
                       {end + 0.01f, kY0 + 0.02f, z + 0.052f * float(i)}, {0.27f, 0.2f, 0.05f});
  }
  add_lathe(room, "blue glaze", {kX0 + 0.25f, kY0 + 0.14f, 5 * kStep + kBoard},
            {{0.05f, 0}, {0.09f, 0.06f}, {0.10f, 0.13f}, {0.05f, 0.22f}, {0.06f, 0.27f}}, 20);
}

void add_lamp(Model& room, const glm::vec3& foot) {
  add_lathe(room, "brass", foot,
            {{0.09f, 0}, {0.08f, 0.015f}, {0.02f, 0.04f}, {0.03f, 0.10f}, {0.015f, 0.16f}, {0.012f, 0.30f}},
            20);
  add_lathe(room, "lamp shade", foot, {{0.16f, 0.26f}, {0.15f, 0.30f}, {0.09f, 0.46f}, {0.0f, 0.465f}}, 28);
}

void add_cup(Model& room, const glm::vec3& foot) {
  add_lathe(room, "porcelain", foot, {{0.065f, 0}, {0.075f, 0.012f}, {0.02f, 0.010f}}, 24);
  add_lathe(
      room, "porcelain", foot + glm::vec3(0, 0, 0.01f),
      {{0.025f, 0}, {0.038f, 0.02f}, {0.045f, 0.07f}, {0.041f, 0.069f}, {0.036f, 0.02f}, {0.0f, 0.012f}}, 24);
}

/// A table of 1.3 x 0.7 m with turned legs, left of the middle.
void add_table(Model& room) {
  constexpr float kX0 = -1.15f, kX1 = 0.15f, kY0 = 0.85f, kY1 = 1.45f, kTop = 0.86f;
  add_box(room, "table wood", {kX0, kY0, kTop - 0.035f}, {kX1, kY1, kTop});
  for (const float x : {kX0 + 0.07f, kX1 - 0.07f})
    for (const float y : {kY0 + 0.07f, kY1 - 0.07f})
      add_lathe(
          room, "table wood", {x, y, 0},
          {{0.025f, 0}, {0.035f, 0.10f}, {0.022f, 0.16f}, {0.04f, 0.45f}, {0.03f, 0.70f}, {0.04f, 0.82f}},
          12);
  add_lamp(room, {-0.62f, 1.25f, kTop});
  add_cup(room, {-0.05f, 1.0f, kTop});
  for (int i = 0; i < 3; ++i)
    add_lying_book(room, 1 + 3 * i, {-0.42f + 0.012f * float(i), 0.92f, kTop + 0.046f * float(i)},
                   {0.26f, 0.19f, 0.045f});
}

/// The letter chart on an easel, 2.6 m away, left of the bookcase.
void add_chart(Model& room) {
  const glm::vec3 centre(-0.25f, 2.6f, 1.45f);
  add_panel(room, "letter chart", centre, 180, {0.40f, 0.60f});
  add_box(room, "shelf wood", centre + glm::vec3(-0.21f, 0.004f, -0.31f),
          centre + glm::vec3(0.21f, 0.02f, 0.31f));
  for (const float x : {-0.18f, 0.18f})
    add_bar(room, "shelf wood", {centre.x + 1.5f * x, 2.6f, 0}, {centre.x + 0.6f * x, 2.63f, 1.85f}, 0.018f,
            8);
  add_bar(room, "shelf wood", {centre.x, 3.0f, 0}, {centre.x, 2.63f, 1.80f}, 0.018f, 8);
}

/// A chair with its back to the window, right of the bookcase's far side.
void add_armchair(Model& room) {
  add_box(room, "cloth 2", {1.35f, 2.4f, 0.15f}, {2.15f, 3.2f, 0.45f});
  add_box(room, "cloth 2", {1.35f, 3.05f, 0.45f}, {2.15f, 3.25f, 1.05f});
  for (const float x : {1.30f, 2.05f}) add_box(room, "cloth 2", {x, 2.4f, 0.15f}, {x + 0.15f, 3.2f, 0.65f});
  for (const float x : {1.4f, 2.1f})
    for (const float y : {2.5f, 3.15f}) add_bar(room, "shelf wood", {x, y, 0}, {x, y, 0.16f}, 0.02f, 8);
}

}  // namespace

Model make_room() {
  Model room;
  add_shell(room);
  add_window(room);
  add_picture(room, "landscape", {1.35f, kFront - 0.035f, 1.75f}, {1.0f, 0.62f});
  add_bookcase(room);
  add_table(room);
  add_chart(room);
  add_armchair(room);
  add_tiled_quad(room, "rug", {-1.2f, 1.9f, 0.008f}, {1.0f, 1.9f, 0.008f}, {1.0f, 3.4f, 0.008f},
                 {-1.2f, 3.4f, 0.008f}, 2.2f);
  return room;
}

}  // namespace catoptra::examples
