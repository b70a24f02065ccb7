#include "tessellate/src/face_fill.h"

namespace catoptra::tessellate {

std::string fill_face(const cad_import::Face&, int, const Borders&, const FaceSizing&, const StepLimits&,
                      MeshDraft&) {
  return "its border is not a rectangle in (u, v)";
}

}  // namespace catoptra::tessellate
