#include <Interface_InterfaceModel.hxx>
#include <STEPCAFControl_ExternFile.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_ConnectedFaceSet.hxx>
#include <StepShape_Face.hxx>
#include <StepShape_SolidModel.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cctype>

#include "cad_import/src/document_tree.h"
#include "cad_import/src/file_checks.h"
#include "cad_import/src/kernel_document.h"

namespace catoptra::cad_import {
namespace {

void read_units(STEPCAFControl_Reader& reader, KernelDocument& document) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  std::string first;
  for (const TCollection_AsciiString& length : lengths) {
    const std::string name = length.ToCString();
    if (first.empty()) first = name;
    if (normalized_unit(name) != normalized_unit(first))
      document.warnings.push_back("parts of the file are in different length units (" + first + ", " + name +
                                  ")");
  }
  if (first.empty()) return;
  document.unit = normalized_unit(first);
  document.unit_mm = file_unit_in_mm(document.unit);
}

// Names of faces, shells and solids live on their STEP entities; the kernel's document keeps those of parts
// only.
void read_entity_names(const Handle(XSControl_WorkSession) & session, KernelDocument& document) {
  const Handle(Transfer_TransientProcess) transfer = session->TransferReader()->TransientProcess();
  const Handle(Interface_InterfaceModel) model = session->Model();
  for (Standard_Integer i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    const bool face = entity->IsKind(STANDARD_TYPE(StepShape_Face));
    if (!face && !entity->IsKind(STANDARD_TYPE(StepShape_SolidModel)) &&
        !entity->IsKind(STANDARD_TYPE(StepShape_ConnectedFaceSet)))
      continue;
    const auto item = Handle(StepRepr_RepresentationItem)::DownCast(entity);
    if (item.IsNull() || item->Name().IsNull() || item->Name()->IsEmpty()) continue;
    const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer, entity);
    if (shape.IsNull()) continue;
    const std::string name = decoded_step_string(item->Name()->ToCString());
    if (name == "NONE") continue;  // what some exporters write for "no name"
    if (!face) {
      document.names.try_emplace(shape.TShape().get(), name);
      continue;
    }
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())  // healing may have split it
      document.names.try_emplace(it.Current().TShape().get(), name);
  }
}

// Systems also note the native document that a part was exported from, though its faces are in this file; the
// kernel follows references to STEP files only.
bool is_step_reference(const std::string& name) {
  std::string suffix = std::filesystem::path(name).extension().string();
  std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return suffix == ".step" || suffix == ".stp" || suffix == ".p21";
}

void check_external_files(const STEPCAFControl_Reader& reader, const std::string& file,
                          KernelDocument& document) {
  std::string names;
  int count = 0;
  for (NCollection_DataMap<TCollection_AsciiString, Handle(STEPCAFControl_ExternFile)>::Iterator it(
           reader.ExternFiles());
       it.More(); it.Next()) {
    const std::string other = it.Key().ToCString();
    if (it.Value()->GetTransferStatus() || (!document.bodies.empty() && !is_step_reference(other))) continue;
    ++count;
    if (count <= 3) names += (count > 1 ? ", " : "") + other;
  }
  if (count == 0) return;
  const std::string reason =
      "refers to " + std::to_string(count) + " other file(s) that could not be read: " + names;
  if (document.bodies.empty())
    throw ImportError(file, "", reason, "export it as one file, or put the parts beside it");
  document.warnings.push_back(reason);
}

}  // namespace

KernelDocument read_step(const std::filesystem::path& file, ImportProgress& progress) {
  const std::string name = file.string();
  KernelDocument document;
  document.format = "STEP";
  STEPCAFControl_Reader reader;
  reader.SetLayerMode(false);
  reader.SetPropsMode(false);
  reader.SetGDTMode(false);
  reader.SetMatMode(false);
  reader.SetViewMode(false);
  progress.stage("reading", 0.0, 0.4);
  if (reader.ReadFile(name.c_str()) != IFSelect_RetDone)
    throw ImportError(name, "", why_step_failed(file), "export the file again");
  read_units(reader, document);
  progress.stage("converting", 0.4, 0.8);
  Handle(TDocStd_Document) target = new TDocStd_Document("BinXCAF");
  const bool done = reader.Transfer(target, progress.Start());
  progress.check();
  if (done) {
    read_entity_names(reader.Reader().WS(), document);
    collect_bodies(target, document);
  }
  check_external_files(reader, name, document);
  return document;
}

}  // namespace catoptra::cad_import
