#include <IGESCAFControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <array>

#include "cad_import/src/document_tree.h"
#include "cad_import/src/file_checks.h"
#include "cad_import/src/kernel_document.h"

namespace catoptra::cad_import {
namespace {

// Unit flags of the global section, parameter 14; 3 means that parameter 15 holds the name. Source:
// IGES 5.3, 2.2.4.3.14.
constexpr std::array<const char*, 12> kUnitOfFlag{"",  "in", "mm",  "",   "ft", "mi",
                                                  "m", "km", "mil", "um", "cm", "uin"};

void read_unit(const Handle(IGESData_IGESModel) & model, KernelDocument& document) {
  const IGESData_GlobalSection& global = model->GlobalSection();
  const int flag = global.UnitFlag();
  if (flag == 3 && !global.UnitName().IsNull())
    document.unit = normalized_unit(global.UnitName()->ToCString());
  else if (flag > 0 && flag < int(kUnitOfFlag.size()))
    document.unit = kUnitOfFlag[std::size_t(flag)];
  document.unit_mm = file_unit_in_mm(document.unit);
}

// Entity labels: the name property (type 406, form 15) or the eight-letter label of the directory entry.
void read_entity_names(const Handle(XSControl_WorkSession) & session,
                       const Handle(IGESData_IGESModel) & model, KernelDocument& document) {
  const Handle(Transfer_TransientProcess) transfer = session->TransferReader()->TransientProcess();
  for (Standard_Integer i = 1; i <= model->NbEntities(); ++i) {
    const Handle(IGESData_IGESEntity) entity = model->Entity(i);
    if (!entity->HasName() && !entity->HasShortLabel()) continue;
    const Handle(TCollection_HAsciiString) text =
        entity->HasName() ? entity->NameValue() : entity->ShortLabel();
    if (text.IsNull() || text->IsEmpty()) continue;
    const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer, entity);
    if (shape.IsNull() || shape.ShapeType() > TopAbs_FACE) continue;
    TCollection_AsciiString name = text->String();
    name.LeftAdjust();
    name.RightAdjust();
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
      document.names.try_emplace(it.Current().TShape().get(), name.ToCString());
  }
}

}  // namespace

KernelDocument read_iges(const std::filesystem::path& file, ImportProgress& progress) {
  const std::string name = file.string();
  KernelDocument document;
  document.format = "IGES";
  IGESCAFControl_Reader reader;
  progress.stage("reading", 0.0, 0.4);
  if (reader.ReadFile(name.c_str()) != IFSelect_RetDone)
    throw ImportError(name, "", "the IGES parser could not read it", "export the file again");
  const Handle(IGESData_IGESModel) model = reader.IGESModel();
  read_unit(model, document);
  progress.stage("converting", 0.4, 0.8);
  Handle(TDocStd_Document) target = new TDocStd_Document("BinXCAF");
  const bool done = reader.Transfer(target, progress.Start());
  progress.check();
  if (done) {
    read_entity_names(reader.WS(), model, document);
    collect_bodies(target, document);
  }
  return document;
}

}  // namespace catoptra::cad_import
