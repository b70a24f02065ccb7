#include "examples/plates/stage.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

#include "examples/street/shapes.h"

namespace catoptra::examples {
namespace {

constexpr float kBar = 0.03f;  // thickness of a frame

/// A sphere of 48 x 24 faces: its outline is off by 0.2 % of the radius.
void add_sphere(Model& model, const std::string& paint, const glm::vec3& centre, float radius) {
  constexpr int kRings = 24;
  std::vector<glm::vec2> profile;
  for (int i = 0; i <= kRings; ++i) {
    const float angle = glm::pi<float>() * (float(i) / kRings - 0.5f);
    const bool pole = i == 0 || i == kRings;
    profile.emplace_back(pole ? 0.0f : radius * std::cos(angle), radius * std::sin(angle));
  }
  add_lathe(model, paint, centre, profile, 48);
}

/// A frame of `size` around an opening whose middle is at the origin, in the plane y = 0; its bars leave the
/// opening free.
Model make_frame(glm::vec2 size) {
  Model frame;
  const glm::vec2 half = size / 2.0f, out = half + kBar;
  const auto bar = [&](float x0, float x1, float z0, float z1) {
    add_box(frame, "stage frame", {x0, -kBar / 2, z0}, {x1, kBar / 2, z1});
  };
  bar(-out.x, -half.x, -out.y, out.y);
  bar(half.x, out.x, -out.y, out.y);
  bar(-half.x, half.x, half.y, out.y);
  bar(-half.x, half.x, -out.y, -half.y);
  return frame;
}

/// ... with two feet down to z = 0 where its middle is `height` above it.
Model make_standing_frame(glm::vec2 size, float height) {
  Model frame = make_frame(size);
  const float x = size.x / 2, low = -height, high = -size.y / 2 - kBar;
  for (const float side : {-x, x})
    add_box(frame, "stage frame", {side - kBar / 2, -kBar / 2, low}, {side + kBar / 2, kBar / 2, high});
  return frame;
}

/// Floor squares of 0.2 m.
void add_floor(Model& model, float x0, float x1, float y0, float y1) {
  add_tiled_quad(model, "stage floor", {x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}, 0.4f);
}

void add_cube(Model& model, const std::string& paint, const glm::vec3& middle_of_foot, float side) {
  const glm::vec3 half(side / 2, side / 2, 0);
  add_box(model, paint, middle_of_foot - half, middle_of_foot + half + glm::vec3(0, 0, side));
}

void add_stage_objects(Model& model, const LightStage& stage) {
  add_box(model, "stage red", glm::vec3(stage.cube_low), glm::vec3(stage.cube_high));
  add_sphere(model, "stage green", glm::vec3(stage.sphere_centre), float(stage.sphere_radius));
}

}  // namespace

Model make_refraction_stage() {
  Model model;
  add_floor(model, -2, 2, -1.2f, float(kPlate1Wall_m));
  const auto y = float(kPlate1Wall_m);
  add_quad(model, "named squares", {-2, y, 0}, {2, y, 0}, {2, y, 2.4f}, {-2, y, 2.4f});
  for (const float x : {-1.0f, 0.0f, 1.0f}) {
    model.add(make_standing_frame({0.7f, 0.9f}, 1.0f), place({x, 0, 1.0f}, x * kPlate1Turn_deg));
    add_cube(model, "stage red", {x - 0.1f, 0.9f, 0}, 0.5f);
  }
  return model;
}

Model make_mirror_room() {
  constexpr float kX = 2, kY = 1.5f, kHeight = 2.4f, kBefore = 0.01f;
  Model room;
  add_floor(room, -kX, kX, -kY, kY);
  add_quad(room, "stage white", {-kX, kY, kHeight}, {kX, kY, kHeight}, {kX, -kY, kHeight},
           {-kX, -kY, kHeight});
  const auto wall = [&](glm::vec2 left, glm::vec2 right) {
    add_tiled_quad(room, "stage wall", {left, 0}, {right, 0}, {right, kHeight}, {left, kHeight}, 0.4f);
  };
  wall({-kX, kY}, {kX, kY});
  wall({kX, kY}, {kX, -kY});
  wall({kX, -kY}, {-kX, -kY});
  wall({-kX, -kY}, {-kX, kY});
  const Model frame = make_frame({2.2f, 1.5f});
  room.add(frame, place({0, kY - kBefore, 1.2f}));
  room.add(frame, place({kX - kBefore, 0, 1.2f}, 90));
  room.add(frame, place({-kX + kBefore, 0, 1.2f}, 90));
  add_cube(room, "stage red", {0.55f, 0.35f, 0}, 0.5f);
  add_panel(room, "letters FROG", {0.25f, -0.1f, 0.9f}, 180, {0.6f, 0.3f});
  add_panel(room, "letters PLUG", {0.25f, -0.08f, 0.9f}, 0, {0.6f, 0.3f});
  add_bar(room, "stage frame", {0.25f, -0.09f, 0}, {0.25f, -0.09f, 0.75f}, 0.015f, 8);
  add_sphere(room, "stage green", {0.55f, 0.35f, 0.72f}, 0.22f);
  add_lathe(room, "stage blue", {-0.7f, 0.6f, 0},
            {{0.12f, 0}, {0.20f, 0.15f}, {0.22f, 0.35f}, {0.08f, 0.60f}, {0.11f, 0.70f}}, 24);
  return room;
}

Model make_light_stage(const LightStage& stage) {
  Model model;
  const glm::vec2 low(stage.floor_low), high(stage.floor_high);
  add_quad(model, stage.mirror ? "regions reflection" : "regions refraction", {low.x, low.y, 0},
           {high.x, low.y, 0}, {high.x, high.y, 0}, {low.x, high.y, 0});
  add_stage_objects(model, stage);
  return model;
}

Model make_caustic_stage(const LightStage& stage) {
  Model model;
  add_floor(model, -1.6f, 3.2f, -1.4f, 1.2f);
  add_tiled_quad(model, "stage wall", {-1.6f, 1.2f, 0}, {3.2f, 1.2f, 0}, {3.2f, 1.2f, 1.6f},
                 {-1.6f, 1.2f, 1.6f}, 0.4f);
  add_stage_objects(model, stage);
  return model;
}

Model make_translucency_stage() {
  Model model;
  add_floor(model, -1.8f, 1.8f, -1.6f, 1.4f);
  add_tiled_quad(model, "stage wall", {-1.8f, 1.4f, 0}, {1.8f, 1.4f, 0}, {1.8f, 1.4f, 1.4f},
                 {-1.8f, 1.4f, 1.4f}, 0.4f);
  for (const float x : {-1.0f, 0.0f, 1.0f}) {
    model.add(make_standing_frame({0.8f, 1.0f}, 0.6f), place({x, 0, 0.6f}));
    add_cube(model, "stage red", {x - 0.22f, 0.05f + 0.12f, 0}, 0.24f);
    add_sphere(model, "stage green", {x + 0.12f, 0.35f + 0.16f, 0.16f}, 0.16f);
    add_panel(model, "letters FROG", {x, 0.95f, 0.80f}, 180, {0.5f, 0.25f});
    for (const float side : {-0.2f, 0.2f})
      add_bar(model, "stage frame", {x + side, 0.96f, 0}, {x + side, 0.96f, 0.85f}, 0.012f, 8);
  }
  return model;
}

Model make_combined_stage() {
  Model model;
  add_floor(model, -2.2f, 2.2f, -1.6f, 1.8f);
  add_tiled_quad(model, "stage wall", {-2.2f, 1.8f, 0}, {2.2f, 1.8f, 0}, {2.2f, 1.8f, 2}, {-2.2f, 1.8f, 2},
                 0.4f);
  add_tiled_quad(model, "stage wall", {-2.2f, -1.6f, 0}, {-2.2f, 1.8f, 0}, {-2.2f, 1.8f, 2},
                 {-2.2f, -1.6f, 2}, 0.4f);
  model.add(make_standing_frame({1.6f, 1.2f}, 0.85f), place({-0.3f, 1.5f, 0.85f}));
  model.add(make_standing_frame({0.9f, 0.8f}, 0.6f), place({0.75f, 0.1f, 0.6f}, 45));
  model.add(make_standing_frame({0.8f, 0.7f}, 0.55f), place({-1.1f, -0.3f, 0.55f}, -20));
  add_cube(model, "stage red", {-0.25f, 0.45f, 0}, 0.36f);
  add_sphere(model, "stage green", {1.25f, -0.25f, 0.16f}, 0.16f);
  add_lathe(model, "stage blue", {-1.05f, 0.25f, 0},
            {{0.10f, 0}, {0.16f, 0.12f}, {0.18f, 0.30f}, {0.07f, 0.48f}, {0.09f, 0.56f}}, 24);
  add_panel(model, "letters FROG", {-0.95f, 0.9f, 0.75f}, 180, {0.6f, 0.3f});
  add_panel(model, "letters PLUG", {-0.95f, 0.92f, 0.75f}, 0, {0.6f, 0.3f});
  add_bar(model, "stage frame", {-0.95f, 0.91f, 0}, {-0.95f, 0.91f, 0.6f}, 0.015f, 8);
  return model;
}

Model make_mirror_stand() {
  Model model;
  model.add(make_standing_frame({2.4f, 1.6f}, kStandMiddle), place({0, 0, kStandMiddle}));
  add_box(model, "sign back", {-1.2f, -0.03f, kStandMiddle - 0.8f}, {1.2f, -0.012f, kStandMiddle + 0.8f});
  return model;
}

}  // namespace catoptra::examples
