// CAD files made on the spot by the kernel's own writers.
#pragma once

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <IGESCAFControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "cad_import/src/kernel_session.h"
#include "tests/cad_import/mesh_files.h"

namespace catoptra::test {

inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// An XDE document that is filled through its tools and written as STEP or IGES.
class CadDocument {
 public:
  CadDocument() : document_(new TDocStd_Document("BinXCAF")) {
    shapes = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
    colors = XCAFDoc_DocumentTool::ColorTool(document_->Main());
  }

  TDF_Label add(const TopoDS_Shape& shape, const char* name) {
    const TDF_Label label = shapes->AddShape(shape, false);
    TDataStd_Name::Set(label, name);
    return label;
  }
  void name_face(const TDF_Label& part, const TopoDS_Shape& face, const char* name) {
    TDataStd_Name::Set(shapes->AddSubShape(part, face), name);
  }
  void color(const TDF_Label& label, double r, double g, double b) {
    colors->SetColor(label, Quantity_Color(r, g, b, Quantity_TOC_RGB), XCAFDoc_ColorSurf);
  }
  void color_face(const TDF_Label& part, const TopoDS_Shape& face, double r, double g, double b) {
    color(shapes->AddSubShape(part, face), r, g, b);
  }

  /// `unit`: MM, M, INCH, ... `external`: parts go into files of their own beside it.
  void write_step(const std::filesystem::path& file, const char* unit = "MM", bool external = false) {
    shapes->UpdateAssemblies();
    cad_import::KernelSession session;
    STEPCAFControl_Controller::Init();
    session.set("write.step.unit", unit);
    session.set("write.stepcaf.subshapes.name", "1");
    STEPCAFControl_Writer writer;
    if (!writer.Transfer(document_, STEPControl_AsIs, external ? "part_" : nullptr) ||
        writer.Write(file.string().c_str()) != IFSelect_RetDone)
      throw std::runtime_error("the test could not write " + file.string());
  }
  void write_iges(const std::filesystem::path& file, const char* unit = "MM") {
    cad_import::KernelSession session;
    session.set("write.iges.unit", unit);
    IGESCAFControl_Writer writer;
    if (!writer.Transfer(document_) || !writer.Write(file.string().c_str()))
      throw std::runtime_error("the test could not write " + file.string());
  }

  Handle(XCAFDoc_ShapeTool) shapes;
  Handle(XCAFDoc_ColorTool) colors;

 private:
  Handle(TDocStd_Document) document_;
};

/// A box of 10 x 20 x 30 mm from the origin, written in `unit`.
inline void write_box(const std::filesystem::path& file, const char* unit = "MM") {
  CadDocument document;
  document.add(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "Box");
  document.write_step(file, unit);
}

}  // namespace catoptra::test
