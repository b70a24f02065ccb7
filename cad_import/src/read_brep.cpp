#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <fstream>

#include "cad_import/src/kernel_document.h"

namespace catoptra::cad_import {
namespace {

// The text form names itself a drawable or writes "CASCADE Topology" first; the binary one "Open CASCADE
// Topology".
bool is_binary(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string begin(64, '\0');
  in.read(begin.data(), std::streamsize(begin.size()));
  return begin.find("Open CASCADE Topology") != std::string::npos;
}

}  // namespace

KernelDocument read_brep(const std::filesystem::path& file, ImportProgress& progress) {
  const std::string name = file.string();
  KernelDocument document;
  document.format = "BREP";
  progress.stage("reading", 0.0, 0.8);
  TopoDS_Shape shape;
  bool done;
  if (is_binary(file)) {
    done = BinTools::Read(shape, name.c_str(), progress.Start());
  } else {
    BRep_Builder builder;
    done = BRepTools::Read(shape, name.c_str(), builder, progress.Start());
  }
  progress.check();
  if (!done || shape.IsNull())
    throw ImportError(name, "", "the BREP parser could not read it", "save the shape again");
  document.bodies = split_into_bodies(shape, "", std::nullopt);
  return document;
}

}  // namespace catoptra::cad_import
