// Walks an XDE document: assemblies, instances, names and colours, down to bodies.
#pragma once

#include <TDocStd_Document.hxx>

#include "cad_import/src/kernel_document.h"

namespace catoptra::cad_import {

/// Appends the document's bodies, each instance with its placement applied, and the colours of sub-shapes.
/// `document.names` (filled by the reader) names solids and shells where a part holds several.
void collect_bodies(const Handle(TDocStd_Document) & source, KernelDocument& document);

}  // namespace catoptra::cad_import
