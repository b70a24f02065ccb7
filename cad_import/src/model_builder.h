// From the kernel's bodies to a CadModel.
#pragma once

#include <TopoDS_Face.hxx>
#include <glm/mat4x4.hpp>
#include <vector>

#include "cad_import/cad_model.h"
#include "cad_import/src/kernel_document.h"

namespace catoptra::cad_import {

/// Behind CadModel::kernel_shapes.
struct KernelShapes {
  std::vector<TopoDS_Face> faces;  // by index in CadModel::faces
  glm::dmat4 placement{1};         // from kernel coordinates to the model's
};

/// `placement`: from kernel coordinates (mm as the file says) to the model's; a similarity.
[[nodiscard]] CadModel build_model(const KernelDocument& document, const std::string& file,
                                   const glm::dmat4& placement, ImportProgress& progress);

}  // namespace catoptra::cad_import
