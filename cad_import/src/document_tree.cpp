#include "cad_import/src/document_tree.h"

#include <BRep_Builder.hxx>
#include <Quantity_Color.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

namespace catoptra::cad_import {
namespace {

std::string label_name(const TDF_Label& label) {
  Handle(TDataStd_Name) attribute;
  if (!label.FindAttribute(TDataStd_Name::GetID(), attribute)) return {};
  const TCollection_ExtendedString& text = attribute->Get();
  std::string utf8(std::size_t(text.LengthOfCString()) + 1, '\0');
  Standard_PCharacter buffer = utf8.data();
  utf8.resize(std::size_t(text.ToUTF8CString(buffer)));
  return utf8;
}

std::optional<glm::dvec3> label_color(const TDF_Label& label, const Handle(XCAFDoc_ColorTool) & tool) {
  Quantity_Color color;  // linear RGB, as ours
  for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen})
    if (tool->GetColor(label, type, color)) return glm::dvec3(color.Red(), color.Green(), color.Blue());
  return std::nullopt;
}

/// Depth-first through the assembly; a colour set on an instance covers what the part says.
class Walker {
 public:
  Walker(const Handle(TDocStd_Document) & source, KernelDocument& document)
      : colors_(XCAFDoc_DocumentTool::ColorTool(source->Main())),
        shapes_(XCAFDoc_DocumentTool::ShapeTool(source->Main())),
        document_(document) {}

  void walk_all() {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    for (const TDF_Label& root : roots) walk(root, TopLoc_Location(), std::nullopt, 0);
    flush_loose_faces();
  }

 private:
  static constexpr int kMaxDepth = 200;  // deeper is a cycle, not an assembly

  void walk(const TDF_Label& label, const TopLoc_Location& location, std::optional<glm::dvec3> instance_color,
            int depth) {
    if (depth > kMaxDepth) return;
    if (!instance_color && XCAFDoc_ShapeTool::IsReference(label))
      instance_color = label_color(label, colors_);
    TDF_Label part = label;
    TopLoc_Location placed = location;
    if (XCAFDoc_ShapeTool::GetReferredShape(label, part))
      placed = location * XCAFDoc_ShapeTool::GetLocation(label);
    if (XCAFDoc_ShapeTool::IsAssembly(part)) {
      TDF_LabelSequence components;
      XCAFDoc_ShapeTool::GetComponents(part, components);
      for (const TDF_Label& component : components) walk(component, placed, instance_color, depth + 1);
    } else {
      add_part(part, placed, instance_color, depth);
    }
  }

  void add_part(const TDF_Label& part, const TopLoc_Location& placed,
                const std::optional<glm::dvec3>& instance_color, int depth) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(part);
    if (shape.IsNull()) return;
    note_sub_shapes(part);
    const std::string name = label_name(part);
    const std::optional<glm::dvec3> color = instance_color ? instance_color : label_color(part, colors_);
    if (depth == 0 &&
        shape.ShapeType() == TopAbs_FACE) {  // a file of unsewn faces: together they are one body
      if (!name.empty()) document_.names.try_emplace(shape.TShape().get(), name);
      if (color) document_.colors.try_emplace(shape.TShape().get(), *color);
      loose_faces_.push_back(shape);
      return;
    }
    std::vector<KernelBody> bodies = split_into_bodies(shape, name, color);
    for (KernelBody& body : bodies) {
      if (const auto own = document_.names.find(body.shape.TShape().get());
          own != document_.names.end() && (bodies.size() > 1 || body.name.empty()))
        body.name = own->second;
      if (const auto own = document_.colors.find(body.shape.TShape().get());
          own != document_.colors.end() && !instance_color)
        body.color = own->second;
      body.shape.Move(placed);
      body.placement = placed;
      document_.bodies.push_back(std::move(body));
    }
  }

  void note_sub_shapes(const TDF_Label& part) {
    TDF_LabelSequence subs;
    XCAFDoc_ShapeTool::GetSubShapes(part, subs);
    for (const TDF_Label& sub : subs) {
      const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(sub);
      if (shape.IsNull()) continue;
      if (const auto color = label_color(sub, colors_))
        document_.colors.try_emplace(shape.TShape().get(), *color);
      if (const std::string name = label_name(sub); !name.empty())
        document_.names.try_emplace(shape.TShape().get(), name);
    }
  }

  void flush_loose_faces() {
    if (loose_faces_.empty()) return;
    TopoDS_Compound compound;
    BRep_Builder builder;
    builder.MakeCompound(compound);
    for (const TopoDS_Shape& face : loose_faces_) builder.Add(compound, face);
    document_.bodies.push_back({"", std::nullopt, false, TopLoc_Location(), compound});
  }

  Handle(XCAFDoc_ColorTool) colors_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  KernelDocument& document_;
  std::vector<TopoDS_Shape> loose_faces_;
};

}  // namespace

std::vector<KernelBody> split_into_bodies(const TopoDS_Shape& part, const std::string& name,
                                          const std::optional<glm::dvec3>& color) {
  std::vector<KernelBody> bodies;
  TopTools_MapOfShape seen;  // a file may list a shell or the faces of a solid once more beside it
  const auto see_all = [&seen](const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
    for (TopExp_Explorer it(shape, kind); it.More(); it.Next()) seen.Add(it.Current());
  };
  for (TopExp_Explorer it(part, TopAbs_SOLID); it.More(); it.Next()) {
    if (!seen.Add(it.Current())) continue;
    bodies.push_back({name, color, true, TopLoc_Location(), it.Current()});
    see_all(it.Current(), TopAbs_SHELL);
  }
  for (TopExp_Explorer it(part, TopAbs_SHELL, TopAbs_SOLID); it.More(); it.Next())
    if (seen.Add(it.Current())) bodies.push_back({name, color, false, TopLoc_Location(), it.Current()});
  for (const KernelBody& body : bodies) see_all(body.shape, TopAbs_FACE);

  TopoDS_Compound loose;
  BRep_Builder builder;
  builder.MakeCompound(loose);
  bool any = false;
  for (TopExp_Explorer it(part, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next()) {
    if (!seen.Add(it.Current())) continue;
    builder.Add(loose, it.Current());
    any = true;
  }
  if (any) bodies.push_back({name, color, false, TopLoc_Location(), loose});
  return bodies;
}

void collect_bodies(const Handle(TDocStd_Document) & source, KernelDocument& document) {
  Walker(source, document).walk_all();
}

}  // namespace catoptra::cad_import
