#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <array>
#include <fstream>
#include <istream>
#include <string_view>

#include "cad_import/src/kernel_document.h"

namespace catoptra::cad_import {
namespace {

void rewind(std::istream& in) {
  in.clear();
  in.seekg(0);
}

// Headings of the text form in their order. Source: Open CASCADE, BRep Format.
constexpr std::array<std::string_view, 8> kSections{
    "Locations", "Curve2ds",       "Curves", "Polygon3D", "PolygonOnTriangulations",
    "Surfaces",  "Triangulations", "TShapes"};

// The text form names itself a drawable or writes "CASCADE Topology" first; the binary one "Open CASCADE
// Topology".
bool is_binary(std::istream& in) {
  std::string begin(64, '\0');
  in.read(begin.data(), std::streamsize(begin.size()));
  rewind(in);
  return begin.find("Open CASCADE Topology") != std::string::npos;
}

// The kernel reads on past a missing section and talks about it on standard output; so it is looked for
// first.
void check_sections(std::istream& in, const std::string& file, const std::string& entry) {
  std::size_t found = 0;
  for (std::string line; found < kSections.size() && std::getline(in, line);)
    if (line.starts_with(kSections[found])) ++found;
  if (found < kSections.size())
    throw ImportError(file, entry,
                      "is cut off or damaged: the section " + std::string(kSections[found]) + " is missing",
                      "save the shape again");
  rewind(in);
}

}  // namespace

TopoDS_Shape read_brep_shape(std::istream& in, const std::string& file, const std::string& entry,
                             ImportProgress& progress) {
  TopoDS_Shape shape;
  if (is_binary(in)) {
    BinTools::Read(shape, in, progress.Start());
  } else {
    check_sections(in, file, entry);
    const BRep_Builder builder;
    BRepTools::Read(shape, in, builder, progress.Start());
  }
  progress.check();
  if (shape.IsNull())
    throw ImportError(file, entry, "the BREP parser could not read it", "save the shape again");
  return shape;
}

KernelDocument read_brep(const std::filesystem::path& file, ImportProgress& progress) {
  KernelDocument document;
  document.format = "BREP";
  progress.stage("reading", 0.0, 0.8);
  std::ifstream in(file, std::ios::binary);
  document.bodies = split_into_bodies(read_brep_shape(in, file.string(), "", progress), "", std::nullopt);
  return document;
}

}  // namespace catoptra::cad_import
