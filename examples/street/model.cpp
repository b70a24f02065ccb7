#include "examples/street/model.h"

#include <glm/gtc/matrix_transform.hpp>

namespace catoptra::examples {

std::size_t Model::triangle_count() const {
  std::size_t indices = 0;
  for (const auto& [name, surface] : surfaces) indices += surface.indices.size();
  return indices / 3;
}

void Model::add(const Model& part, const glm::mat4& placement) {
  for (const auto& [name, from] : part.surfaces) {
    Surface& to = surfaces[name];
    const auto first = static_cast<std::uint32_t>(to.vertices.size());
    for (const Vertex& v : from.vertices)
      to.vertices.push_back({glm::vec3(placement * glm::vec4(v.position, 1)),
                             glm::vec3(placement * glm::vec4(v.normal, 0)), v.texture});
    for (const std::uint32_t index : from.indices) to.indices.push_back(first + index);
  }
}

glm::mat4 place(const glm::vec3& origin, float heading_deg) {
  return glm::rotate(glm::translate(glm::mat4(1), origin), glm::radians(heading_deg), glm::vec3(0, 0, 1));
}

}  // namespace catoptra::examples
