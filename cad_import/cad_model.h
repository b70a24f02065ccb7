// What a CAD file holds after import: bodies, named faces with exact surfaces and trimming, all in mm.
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cad_import/exact_surface.h"

namespace catoptra::cad_import {

/// Axis-aligned box, mm. Empty until something is put in: min > max.
struct BoundingBox {
  glm::dvec3 min{1e300}, max{-1e300};
  [[nodiscard]] bool empty() const { return min.x > max.x; }
};

/// The curve of an edge as one face uses it. Safe to call from many threads.
class TrimCurve {
 public:
  virtual ~TrimCurve() = default;
  /// Parameters on the face's surface; `t` in [t_begin, t_end] of the edge use.
  [[nodiscard]] virtual glm::dvec2 uv(double t) const = 0;
  /// The edge's own space curve, mm. The two faces at an edge see the same curve with the same `t`.
  [[nodiscard]] virtual glm::dvec3 point(double t) const = 0;
};

/// One edge of a loop. Faces that share an edge hold the same `edge` number, so that a mesh can share its
/// vertices.
struct EdgeUse {
  int edge = -1;          ///< index of the topological edge within the CadModel
  int start_vertex = -1;  ///< index of the topological vertex where this use starts, within the CadModel
  int end_vertex = -1;    ///< ... and where it ends
  double t_begin = 0;     ///< parameter range of the curve, t_begin < t_end
  double t_end = 1;
  bool reversed = false;    ///< the loop runs from t_end to t_begin
  bool degenerate = false;  ///< a curve in (u, v) that is one point in space (pole of a sphere)
  bool seam = false;        ///< used twice by this face (closed surface); each use has its own uv curve
  double tolerance_mm =
      0;  ///< how far the space curve is from the surface: what the file says or, if more, what was measured
  std::shared_ptr<const TrimCurve> curve;
};

/// A closed boundary in (u, v): counter-clockwise for the outer one and clockwise for holes, as seen with du
/// x dv towards the viewer (whatever the face's orientation).
struct TrimLoop {
  std::vector<EdgeUse> edges;
  bool outer = true;
};

/// The trimmed region of a face in (u, v), for point-in-face tests. Immutable, thread-safe.
class FaceTrim {
 public:
  virtual ~FaceTrim() = default;
  /// True inside or within `margin_uv` of the boundary. Periodic parameters may be given in any period.
  [[nodiscard]] virtual bool contains(double u, double v) const = 0;
};

struct Face {
  std::string id;    ///< stable over re-imports of the same geometry: hash of surface kind, area and position
  int index = 0;     ///< position in CadModel::faces, as `catoptra info` prints it
  std::string name;  ///< as the file has it; empty where it has none
  std::optional<glm::dvec3> color;  ///< linear RGB, 0..1
  int body = 0;                     ///< index in CadModel::bodies
  std::shared_ptr<const ExactSurface> surface;
  std::shared_ptr<const FaceTrim> trim;
  std::vector<TrimLoop> loops;
  double area_mm2 = 0;
  bool planar = false;  ///< flat, whatever its surface kind (within 1e-7 mm)
  BoundingBox bounds;
};

struct Body {
  std::string name;
  std::optional<glm::dvec3> color;
  bool solid = false;  ///< closed solid; else open shell or loose faces
  std::vector<int> faces;
  glm::dmat4 placement{1};  ///< already applied to the faces; kept for the report
};

/// An imported CAD file. Cheap to copy: surfaces are shared.
struct CadModel {
  std::string file;
  std::string format;  ///< "STEP", "IGES", "BREP", "FreeCAD"
  std::string
      unit;  ///< the file's length unit as recognised: "mm", "m", "in", ...; "unknown" where it has none
  std::vector<Body> bodies;
  std::vector<Face> faces;
  BoundingBox bounds;
  std::vector<std::string> warnings;

  /// The CAD kernel's own shapes, opaque: used by cad_import itself to mesh surroundings.
  std::shared_ptr<const void> kernel_shapes;
};

}  // namespace catoptra::cad_import
