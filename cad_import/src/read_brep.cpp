#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <array>
#include <fstream>
#include <istream>
#include <iterator>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <string_view>
#include <utility>

#include "cad_import/src/kernel_document.h"

namespace catoptra::cad_import {
namespace {

/// Text in memory as the kernel reads it. The kernel does not look at the state of its stream: at the end of
/// a file that is cut off it reads on for ever. So the end is some white space, which the last number of a
/// whole file may need behind it, and then an exception.
class GuardedText : public std::streambuf {
 public:
  explicit GuardedText(std::string text) : text_(std::move(text)) {
    text_.append(64, '\n');
    setg(text_.data(), text_.data(), text_.data() + text_.size());
  }

 protected:
  int_type underflow() override { throw std::out_of_range("the end of the shape"); }
  pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode) override {
    const off_type base = from == std::ios::beg   ? 0
                          : from == std::ios::cur ? gptr() - eback()
                                                  : egptr() - eback();
    const off_type to = base + offset;
    if (to < 0 || to > egptr() - eback()) return pos_type(off_type(-1));
    setg(eback(), eback() + to, egptr());
    return pos_type(to);
  }
  pos_type seekpos(pos_type to, std::ios::openmode which) override {
    return seekoff(off_type(to), std::ios::beg, which);
  }

 private:
  std::string text_;
};

// Headings of the text form in their order. Source: Open CASCADE, BRep Format.
constexpr std::array<std::string_view, 8> kSections{
    "Locations", "Curve2ds",       "Curves", "Polygon3D", "PolygonOnTriangulations",
    "Surfaces",  "Triangulations", "TShapes"};

// The text form names itself a drawable or writes "CASCADE Topology" first; the binary one "Open CASCADE
// Topology".
bool is_binary(std::string_view bytes) {
  return bytes.substr(0, 64).find("Open CASCADE Topology") != std::string_view::npos;
}

// The kernel reads on past a missing section and talks about it on standard output; so it is looked for
// first.
void check_sections(std::string_view text, const std::string& file, const std::string& entry) {
  for (const std::string_view section : kSections) {
    const std::size_t at = text.starts_with(section) ? 0 : text.find(std::string("\n").append(section));
    if (at == std::string_view::npos)
      throw ImportError(file, entry,
                        "is cut off or damaged: the section " + std::string(section) + " is missing",
                        "save the shape again");
    text.remove_prefix(at + section.size());
  }
}

}  // namespace

TopoDS_Shape read_brep_shape(std::string bytes, const std::string& file, const std::string& entry,
                             ImportProgress& progress) {
  const bool binary = is_binary(bytes);
  if (!binary) check_sections(bytes, file, entry);
  GuardedText text(std::move(bytes));
  std::istream in(&text);
  // Words where numbers belong end the reading as well.
  in.exceptions(std::ios::badbit | std::ios::failbit);
  TopoDS_Shape shape;
  try {
    if (binary)
      BinTools::Read(shape, in, progress.Start());
    else
      BRepTools::Read(shape, in, BRep_Builder(), progress.Start());
  } catch (const std::out_of_range&) {
    throw ImportError(file, entry, "is cut off or damaged: it ends too early", "save the shape again");
  } catch (const std::ios::failure&) {
    throw ImportError(file, entry, "is damaged: a number is missing", "save the shape again");
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
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  document.bodies =
      split_into_bodies(read_brep_shape(std::move(bytes), file.string(), "", progress), "", std::nullopt);
  return document;
}

}  // namespace catoptra::cad_import
