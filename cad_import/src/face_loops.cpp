#include "cad_import/src/face_loops.h"

#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gp_Pnt2d.hxx>

#include "cad_import/src/face_trim.h"

namespace catoptra::cad_import {
namespace {

/// Kernel curves keep no cache, so that many threads may evaluate them.
class KernelTrimCurve final : public TrimCurve {
 public:
  KernelTrimCurve(Handle(Geom2d_Curve) uv, Handle(Geom_Curve) space, const AffineMap& map,
                  std::shared_ptr<const ExactSurface> surface)
      : uv_(std::move(uv)), space_(std::move(space)), map_(map), surface_(std::move(surface)) {}

  [[nodiscard]] glm::dvec2 uv(double t) const override {
    const gp_Pnt2d p = uv_->Value(t);
    return {p.X(), p.Y()};
  }
  [[nodiscard]] glm::dvec3 point(double t) const override {
    if (!space_.IsNull()) return map_.point(space_->Value(t).XYZ());
    const glm::dvec2 p = uv(t);
    return surface_->point(p.x, p.y);
  }

 private:
  Handle(Geom2d_Curve) uv_;
  Handle(Geom_Curve) space_;
  AffineMap map_;
  std::shared_ptr<const ExactSurface> surface_;
};

bool bounds_the_face(const TopoDS_Shape& edge) {
  return edge.Orientation() == TopAbs_FORWARD || edge.Orientation() == TopAbs_REVERSED;
}

// Edges in the order of the loop. The explorer stops where a wire is torn; what it left out follows as the
// file has it.
std::vector<TopoDS_Edge> ordered_edges(const TopoDS_Wire& wire, const TopoDS_Face& face, bool& torn) {
  std::vector<TopoDS_Edge> edges, listed;
  for (BRepTools_WireExplorer it(wire, face); it.More(); it.Next())
    if (bounds_the_face(it.Current())) edges.push_back(it.Current());
  for (TopoDS_Iterator it(wire); it.More(); it.Next())
    if (bounds_the_face(it.Value())) listed.push_back(TopoDS::Edge(it.Value()));
  if (edges.size() == listed.size()) return edges;
  torn = true;
  return listed;
}

class LoopReader {
 public:
  LoopReader(const TopoDS_Face& face, const AffineMap& placement, const TopologyIndex& index,
             std::shared_ptr<const ExactSurface> surface)
      : face_(face), placement_(placement), index_(index), surface_(std::move(surface)) {}

  TrimLoop read(const TopoDS_Wire& wire, std::string& problem) const {
    TrimLoop loop;
    bool torn = false;
    for (const TopoDS_Edge& edge : ordered_edges(wire, face_, torn)) {
      EdgeUse use = read(edge);
      if (use.curve)
        loop.edges.push_back(std::move(use));
      else
        problem = "an edge without a curve on the surface";
    }
    if (torn) problem = "a boundary that is torn";
    return loop;
  }

 private:
  EdgeUse read(const TopoDS_Edge& edge) const {
    EdgeUse use;
    const Handle(Geom2d_Curve) uv = BRep_Tool::CurveOnSurface(edge, face_, use.t_begin, use.t_end);
    if (uv.IsNull() || !(use.t_begin < use.t_end)) return use;
    TopLoc_Location location;
    double first = 0, last = 0;
    const Handle(Geom_Curve) space = BRep_Tool::Curve(edge, location, first, last);
    const AffineMap map(glm::dmat4(placement_.linear) * to_glm(location.Transformation()));
    AffineMap placed = map;
    placed.shift += placement_.shift;
    use.curve = std::make_shared<KernelTrimCurve>(uv, space, placed, surface_);
    use.edge = index_.edges.FindIndex(edge) - 1;
    const TopoDS_Vertex start = TopExp::FirstVertex(edge, true), end = TopExp::LastVertex(edge, true);
    use.start_vertex = start.IsNull() ? -1 : index_.vertices.FindIndex(start) - 1;
    use.end_vertex = end.IsNull() ? -1 : index_.vertices.FindIndex(end) - 1;
    use.reversed = edge.Orientation() == TopAbs_REVERSED;
    use.degenerate = BRep_Tool::Degenerated(edge);
    use.seam = BRep_Tool::IsClosed(edge, face_);
    use.tolerance_mm = std::max(BRep_Tool::Tolerance(edge) * placement_.scale(), gap(use));
    return use;
  }

  // Files understate the distance of their curves from the surface; a mesh that shares the curve must know
  // it.
  double gap(const EdgeUse& use) const {
    constexpr int kSamples = 8;
    double greatest = 0;
    for (int i = 0; i <= kSamples; ++i) {
      const double t = use.t_begin + (use.t_end - use.t_begin) * i / kSamples;
      const glm::dvec2 uv = use.curve->uv(t);
      greatest = std::max(greatest, glm::distance(surface_->point(uv.x, uv.y), use.curve->point(t)));
    }
    return greatest;
  }

  const TopoDS_Face& face_;
  const AffineMap& placement_;
  const TopologyIndex& index_;
  std::shared_ptr<const ExactSurface> surface_;
};

void reverse(TrimLoop& loop) {
  std::ranges::reverse(loop.edges);
  for (EdgeUse& use : loop.edges) {
    use.reversed = !use.reversed;
    std::swap(use.start_vertex, use.end_vertex);
  }
}

// Two passes: the first, coarse, finds the extent that the chord error is a share of.
std::vector<glm::dvec2> polygon_of(const TrimLoop& loop, glm::dvec2 extent) {
  return sample_loop(loop, extent * PolygonTrim::kChord);
}

glm::dvec2 extent_of(const std::vector<TrimLoop>& loops) {
  glm::dvec2 low(1e300), high(-1e300);
  for (const TrimLoop& loop : loops)
    for (const glm::dvec2& p : sample_loop(loop, glm::dvec2(1e300))) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  return glm::max(high - low, glm::dvec2(1e-9));
}

}  // namespace

FaceLoops face_loops(const TopoDS_Face& face, const AffineMap& placement, const TopologyIndex& index,
                     const std::shared_ptr<const ExactSurface>& surface) {
  FaceLoops result;
  const TopoDS_Face forward = TopoDS::Face(face.Oriented(TopAbs_FORWARD));
  const LoopReader reader(forward, placement, index, surface);
  for (TopoDS_Iterator it(forward); it.More(); it.Next()) {
    if (it.Value().ShapeType() != TopAbs_WIRE || !bounds_the_face(it.Value())) continue;
    TrimLoop loop = reader.read(TopoDS::Wire(it.Value()), result.problem);
    if (!loop.edges.empty()) result.loops.push_back(std::move(loop));
  }
  if (result.loops.empty()) return result;

  const glm::dvec2 extent = extent_of(result.loops);
  std::vector<double> areas;
  for (TrimLoop& loop : result.loops) {
    result.polygons.push_back(polygon_of(loop, extent));
    areas.push_back(signed_area2(result.polygons.back()));
    loop.outer = areas.back() >= 0;
  }
  // The greatest loop is an outer one, whatever the file says; sound files say so too.
  const auto greatest =
      std::ranges::max_element(areas, {}, [](double a) { return std::abs(a); }) - areas.begin();
  if (areas[greatest] < 0) {
    for (std::size_t i = 0; i < result.loops.size(); ++i) {
      reverse(result.loops[i]);
      std::ranges::reverse(result.polygons[i]);
      result.loops[i].outer = !result.loops[i].outer;
    }
    result.problem = "a boundary that runs the wrong way round";
  }
  return result;
}

}  // namespace catoptra::cad_import
