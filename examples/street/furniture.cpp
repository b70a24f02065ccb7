#include "examples/street/furniture.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "examples/street/shapes.h"

namespace catoptra::examples {

Model make_lamp_post() {
  Model post;
  add_lathe(post, "metal", {0, 0, 0}, {{0.14f, 0}, {0.14f, 0.7f}, {0.08f, 0.9f}, {0.05f, 6.0f}, {0.0f, 6.1f}},
            10);
  add_bar(post, "metal", {0, 0, 5.9f}, {-1.3f, 0, 6.15f}, 0.035f, 8);
  add_lathe(post, "metal", {-1.3f, 0, 6.0f}, {{0.26f, 0.0f}, {0.24f, 0.12f}, {0.10f, 0.22f}, {0.0f, 0.24f}},
            12);
  add_lathe(post, "lamp", {-1.3f, 0, 5.86f}, {{0.0f, 0.0f}, {0.12f, 0.02f}, {0.20f, 0.08f}, {0.23f, 0.14f}},
            12);
  return post;
}

namespace {

/// The picture and, 1 cm behind it, its grey back.
void add_plate(Model& sign, const std::string& picture, glm::vec3 centre, glm::vec2 size) {
  add_panel(sign, picture, centre, 0, size);
  add_panel(sign, "sign back", centre - glm::vec3(0, 0.01f, 0), 180, size * 0.7f);
}

}  // namespace

Model make_sign(const std::string& picture, float width, float height, float top) {
  Model sign;
  add_bar(sign, "metal", {0, -0.06f, 0}, {0, -0.06f, top - 0.02f}, 0.038f, 8);
  add_plate(sign, picture, {0, 0, top - height / 2}, {width, height});
  return sign;
}

Model make_board(const std::string& picture, float width, float height, float top) {
  Model sign;
  for (const float x : {-width * 0.36f, width * 0.36f})
    add_bar(sign, "metal", {x, -0.09f, 0}, {x, -0.09f, top - 0.05f}, 0.055f, 8);
  add_box(sign, "sign back", {-width / 2, -0.035f, top - height}, {width / 2, -0.005f, top});
  add_panel(sign, picture, {0, 0, top - height / 2}, 0, {width, height});
  return sign;
}

Model make_tree(float height, const std::string& leaves, int seed) {
  constexpr int kCards = 46;
  Model tree;
  add_lathe(tree, "bark", {0, 0, 0},
            {{0.22f, 0}, {0.15f, 0.4f}, {0.11f, height * 0.45f}, {0.03f, height * 0.8f}}, 8);
  for (int i = 0; i < 4; ++i) {
    const float angle = glm::half_pi<float>() * (float(i) + 0.5f * noise(i, 0, seed));
    const float from = height * (0.38f + 0.05f * float(i));
    add_bar(tree, "bark", {0, 0, from},
            {0.9f * std::cos(angle), 0.9f * std::sin(angle), from + 0.25f * height}, 0.045f, 5);
  }
  // Cards on an egg-shaped crown, turned at random; the golden angle spreads them evenly.
  for (int i = 0; i < kCards; ++i) {
    const float up = 1 - 2 * (float(i) + 0.5f) / kCards, around = 2.3999632f * float(i);
    const float reach = 0.55f + 0.45f * noise(i, 1, seed), ring = std::sqrt(1 - up * up);
    const glm::vec3 out(ring * std::cos(around), ring * std::sin(around), up);
    const glm::vec3 centre =
        glm::vec3(0, 0, height * 0.66f) + out * reach * glm::vec3(0.24f, 0.24f, 0.33f) * height;
    const float turn = glm::two_pi<float>() * noise(i, 2, seed), tilt = 0.7f * noise(i, 3, seed) - 0.2f;
    const glm::vec3 right = 0.17f * height * glm::vec3(std::cos(turn), std::sin(turn), 0);
    const glm::vec3 rise = 0.17f * height * glm::vec3(-std::sin(turn) * tilt, std::cos(turn) * tilt, 1);
    add_quad(tree, leaves, centre - right - rise, centre + right - rise, centre + right + rise,
             centre - right + rise);
  }
  // One normal per card would make it flicker from light to dark: shade the crown like a ball instead.
  for (Vertex& v : tree.surfaces[leaves].vertices)
    v.normal = glm::normalize(v.position - glm::vec3(0, 0, height * 0.55f));
  return tree;
}

}  // namespace catoptra::examples
