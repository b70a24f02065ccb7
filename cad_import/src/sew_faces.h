// Joins faces that a file lists one by one, as IGES does, along the borders where they touch.
#pragma once

#include "cad_import/src/kernel_document.h"

namespace catoptra::cad_import {

/// Lets the loose faces of each body share edges where their borders lie within 1e-5 of the body's size of
/// each other, and face the same side there: that of most of them in the file. Faces keep their order,
/// surfaces, names and colours; solids, shells and what already shares all its edges stay as they are. A body
/// that the kernel cannot sew is left as it is, with a warning.
void sew_loose_faces(KernelDocument& document);

}  // namespace catoptra::cad_import
