#include "cad_import/src/model_builder.h"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepLib.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <map>

#include "cad_import/src/face_loops.h"
#include "cad_import/src/face_measure.h"
#include "cad_import/src/face_trim.h"
#include "cad_import/src/shape_checks.h"
#include "cad_import/src/surface_factory.h"

namespace catoptra::cad_import {
namespace {

// A whole sphere or torus may come without any boundary: the kernel makes the natural one.
TopoDS_Face with_boundary(const TopoDS_Face& face) {
  if (TopExp_Explorer(face, TopAbs_WIRE).More()) return face;
  BRepBuilderAPI_MakeFace maker(BRep_Tool::Surface(face), BRep_Tool::Tolerance(face));
  if (!maker.IsDone()) return face;
  return TopoDS::Face(maker.Face().Oriented(face.Orientation()));
}

ParameterRange range_of(const TopoDS_Face& face) {
  ParameterRange range;
  BRepTools::UVBounds(face, range.u_min, range.u_max, range.v_min, range.v_max);
  return range;
}

class Builder {
 public:
  Builder(const KernelDocument& document, const std::string& file, const glm::dmat4& placement,
          ImportProgress& progress)
      : document_(document),
        placement_(placement),
        progress_(progress),
        shapes_(std::make_shared<KernelShapes>()) {
    shapes_->placement = placement;
    model_.file = file;
    model_.format = document.format;
    model_.unit = document.unit;
    model_.warnings = document.warnings;
  }

  CadModel build() {
    progress_.stage("analysing", 0.8, 1.0);
    for (const KernelBody& body : document_.bodies) list_faces(body);
    const std::size_t count = listed_.size();
    for (std::size_t i = 0; i < count; ++i) {
      add_face(listed_[i]);
      progress_.step(double(i + 1) / double(count));
    }
    number_equal_ids();
    report();
    for (const Face& face : model_.faces) extend(model_.bounds, face.bounds);
    model_.kernel_shapes = shapes_;
    return std::move(model_);
  }

 private:
  struct Listed {
    TopoDS_Face face;
    int body;
  };

  void list_faces(const KernelBody& kernel_body) {
    BRepLib::SameParameter(kernel_body.shape, kSameParameterMm);
    Body body;
    body.name = kernel_body.name;
    body.color = kernel_body.color;
    body.solid = kernel_body.solid;
    body.placement = to_glm(kernel_body.placement.Transformation());
    const int body_index = int(model_.bodies.size());
    for (TopExp_Explorer it(kernel_body.shape, TopAbs_FACE); it.More(); it.Next()) {
      const TopoDS_Face face = with_boundary(TopoDS::Face(it.Current()));
      TopExp::MapShapes(face, TopAbs_EDGE, index_.edges);
      TopExp::MapShapes(face, TopAbs_VERTEX, index_.vertices);
      listed_.push_back({face, body_index});
    }
    model_.bodies.push_back(std::move(body));
  }

  void add_face(const Listed& listed) {
    const std::string place = std::string("face ").append(std::to_string(shapes_->faces.size()));
    try {
      Face face = make_face(listed);
      face.index = int(model_.faces.size());
      model_.bodies[listed.body].faces.push_back(face.index);
      model_.faces.push_back(std::move(face));
      shapes_->faces.push_back(listed.face);
    } catch (const Standard_Failure& failure) {
      model_.warnings.push_back(place + " left out: " + failure.GetMessageString());
    } catch (const Error& error) {
      model_.warnings.push_back(place + " left out: " + error.reason());
    }
  }

  Face make_face(const Listed& listed) {
    Face face;
    face.body = listed.body;
    TopLoc_Location location;
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(listed.face, location);
    if (surface.IsNull()) throw ImportError(model_.file, "", "it has no surface");
    const AffineMap map(placement_ * to_glm(location.Transformation())), whole(placement_);
    face.surface =
        make_surface(surface, map, range_of(listed.face), listed.face.Orientation() == TopAbs_REVERSED);
    FaceLoops boundary = face_loops(listed.face, whole, index_, face.surface);
    if (boundary.loops.empty()) throw ImportError(model_.file, "", "it has no boundary");
    const ParameterDomain domain = face.surface->domain();
    face.trim =
        std::make_shared<PolygonTrim>(boundary.polygons, glm::dvec2(domain.u_period, domain.v_period));
    face.bounds = face_bounds(*face.surface, *face.trim, boundary.polygons);
    face.loops = std::move(boundary.loops);
    const FaceMass mass = face_mass(listed.face);
    face.area_mm2 = mass.area * whole.scale() * whole.scale();
    face.id = face_id(face.surface->kind(), mass);
    face.planar = face.surface->kind() == SurfaceKind::plane || is_planar(listed.face);
    const TopoDS_TShape* key = listed.face.TShape().get();
    if (const auto name = document_.names.find(key); name != document_.names.end()) face.name = name->second;
    if (const auto color = document_.colors.find(key); color != document_.colors.end())
      face.color = color->second;
    if (!face.color) face.color = model_.bodies[listed.body].color;
    if (!boundary.problem.empty()) boundary_problems_[boundary.problem].push_back(face.id);
    return face;
  }

  void number_equal_ids() {
    std::map<std::string, int> seen;
    for (Face& face : model_.faces)
      if (const int n = ++seen[face.id]; n > 1) face.id.append("-").append(std::to_string(n));
  }

  void report() {
    for (const auto& [problem, ids] : boundary_problems_)
      model_.warnings.push_back(std::to_string(ids.size()) + " face(s) with " + problem +
                                ", the first: " + ids.front());
    for (std::string& warning : shape_warnings(document_, shapes_->faces, model_))
      model_.warnings.push_back(std::move(warning));
  }

  static constexpr double kSameParameterMm = 1e-7;

  const KernelDocument& document_;
  glm::dmat4 placement_;
  ImportProgress& progress_;
  std::shared_ptr<KernelShapes> shapes_;
  TopologyIndex index_;
  std::vector<Listed> listed_;
  std::map<std::string, std::vector<std::string>> boundary_problems_;
  CadModel model_;
};

}  // namespace

CadModel build_model(const KernelDocument& document, const std::string& file, const glm::dmat4& placement,
                     ImportProgress& progress) {
  return Builder(document, file, placement, progress).build();
}

}  // namespace catoptra::cad_import
