#include "tessellate/src/edge_use.h"

#include <glm/geometric.hpp>

namespace catoptra::tessellate {

using cad_import::EdgeUse;

const EdgeUse* find_use(const cad_import::Face& face, int cad_edge, double t, const glm::dvec2& uv) {
  const EdgeUse* best = nullptr;
  double best_distance = 0;
  for (const auto& loop : face.loops)
    for (const auto& use : loop.edges) {
      if (use.edge != cad_edge || use.degenerate) continue;
      const double distance = glm::distance(use.curve->uv(t), uv);
      if (!best || distance < best_distance) {
        best = &use;
        best_distance = distance;
      }
    }
  return best;
}

}  // namespace catoptra::tessellate
