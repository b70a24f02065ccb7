#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <array>
#include <fstream>
#include <string_view>

#include "cad_import/src/kernel_document.h"

namespace catoptra::cad_import {
namespace {

// Headings of the text form in their order. Source: Open CASCADE, BRep Format.
constexpr std::array<std::string_view, 8> kSections{
    "Locations", "Curve2ds",       "Curves", "Polygon3D", "PolygonOnTriangulations",
    "Surfaces",  "Triangulations", "TShapes"};

// The text form names itself a drawable or writes "CASCADE Topology" first; the binary one "Open CASCADE
// Topology".
bool is_binary(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string begin(64, '\0');
  in.read(begin.data(), std::streamsize(begin.size()));
  return begin.find("Open CASCADE Topology") != std::string::npos;
}

// The kernel reads on past a missing section and talks about it on standard output; so it is looked for
// first.
void check_sections(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::size_t found = 0;
  for (std::string line; found < kSections.size() && std::getline(in, line);)
    if (line.starts_with(kSections[found])) ++found;
  if (found < kSections.size())
    throw ImportError(file.string(), "",
                      "is cut off or damaged: the section " + std::string(kSections[found]) + " is missing",
                      "save the shape again");
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
    check_sections(file);
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
