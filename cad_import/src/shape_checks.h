// What is wrong with an imported file though it could be read.
#pragma once

#include <TopoDS_Face.hxx>
#include <span>
#include <string>
#include <vector>

#include "cad_import/cad_model.h"
#include "cad_import/src/kernel_document.h"

namespace catoptra::cad_import {

/// One line for each kind of defect: open shells, faces the kernel calls invalid (named by id). `faces`: the
/// kernel's, by index in `model`.
[[nodiscard]] std::vector<std::string> shape_warnings(const KernelDocument& document,
                                                      std::span<const TopoDS_Face> faces,
                                                      const CadModel& model);

/// "38.4 m long: is the unit right?" above 10 m and below 1 mm; empty in between.
[[nodiscard]] std::string size_warning(const BoundingBox& bounds);

}  // namespace catoptra::cad_import
