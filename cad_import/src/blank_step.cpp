// Writes a solid as STEP and reads it again before anyone else may.
#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepData_StepModel.hxx>
#include <StepShape_AdvancedFace.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <system_error>

#include "cad_import/src/blank_parts.h"
#include "cad_import/src/kernel_session.h"

namespace catoptra::cad_import {
namespace {

/// A file beside `target` that replaces it in one step, or goes away with this object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target) : target_(target), path_(target) {
    path_ += ".part";
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void commit() const {
    std::error_code error;
    std::filesystem::rename(path_, target_, error);
    if (error) throw Error(target_.string(), "", "cannot be written: " + error.message());
  }

 private:
  std::filesystem::path target_, path_;
};

/// A label tree with the solid and the names of its faces.
Handle(TDocStd_Document) document_of(const NamedSolid& made) {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const TDF_Label solid = shapes->AddShape(made.solid, false);
  TDataStd_Name::Set(solid, made.name.c_str());
  for (const NamedFace& named : made.faces)
    TDataStd_Name::Set(shapes->AddSubShape(solid, named.face), named.name.c_str());
  return document;
}

void write_step(const NamedSolid& made, const std::filesystem::path& file, const std::string& title) {
  KernelSession session;
  STEPCAFControl_Controller::Init();  // defines the parameter that follows
  session.set("write.stepcaf.subshapes.name", "1");
  const Handle(TDocStd_Document) document = document_of(made);
  STEPCAFControl_Writer writer;
  const bool transferred = writer.Transfer(document);
  XCAFApp_Application::GetApplication()->Close(document);
  if (!transferred) throw Error(file.string(), "", "the solid could not be turned into STEP");
  APIHeaderSection_MakeHeader header(writer.ChangeWriter().Model());
  header.SetName(new TCollection_HAsciiString(title.c_str()));
  header.SetOriginatingSystem(new TCollection_HAsciiString("Catoptra"));
  if (writer.Write(file.string().c_str()) != IFSelect_RetDone)
    throw Error(file.string(), "", "cannot be written");
}

/// What a reader will find: one valid solid whose faces carry the names they were given.
void check_written(const std::filesystem::path& file, const NamedSolid& made) {
  const KernelSession session;
  STEPControl_Reader reader;
  if (reader.ReadFile(file.string().c_str()) != IFSelect_RetDone)
    throw Error(file.string(), "", "cannot be read back");
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  int solids = 0;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) ++solids;
  if (solids != 1 || !BRepCheck_Analyzer(shape).IsValid())
    throw Error(file.string(), "", "does not read back as one valid solid");
  std::vector<std::string> expected, found;
  for (const NamedFace& named : made.faces) expected.push_back(named.name);
  const Handle(StepData_StepModel) model = reader.StepModel();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto face = Handle(StepShape_AdvancedFace)::DownCast(model->Value(i));
    if (!face.IsNull()) found.emplace_back(face->Name().IsNull() ? "" : face->Name()->ToCString());
  }
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  if (found != expected) throw Error(file.string(), "", "the face names were lost in writing");
}

}  // namespace

void write_named_solid(const NamedSolid& solid, const std::filesystem::path& file) try {
  const TemporaryFile temporary(file);
  write_step(solid, temporary.path(), file.filename().string());
  check_written(temporary.path(), solid);
  temporary.commit();
} catch (const Standard_Failure& failure) {
  throw Error(file.string(), "", std::string("the kernel failed: ") + failure.GetMessageString());
}

}  // namespace catoptra::cad_import
