// The two optical sides of a lens, cut out of its CAD files.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/src/mirror_faces.h"
#include "cad_import/cad_model.h"
#include "cad_import/lens_faces.h"
#include "optics/optic.h"

namespace catoptra::app {

/// Indices in the faces of the file(s) that the lens comes from.
struct LensFaceIndices {
  std::vector<int> front, back;
};

/// Front and back of a lens in one file. An empty list of selectors means: recognised. Throws
/// catoptra::Error(`model.file`, ...) where a selector matches nothing, and as cad_import::recognise_lens.
[[nodiscard]] LensFaceIndices lens_faces_of(const cad_import::CadModel& model,
                                            std::span<const FaceSelector> front,
                                            std::span<const FaceSelector> back);

/// The faces that are one side of a lens in a file of its own: those selected, or all. Throws
/// catoptra::Error(`model.file`, ...) where a selector matches nothing, or the file is a closed solid and
/// nothing was selected.
[[nodiscard]] std::vector<int> lens_side_of(const cad_import::CadModel& model,
                                            std::span<const FaceSelector> selectors);

[[nodiscard]] std::vector<cad_import::Face> faces_at(const cad_import::CadModel& model,
                                                     std::span<const int> indices);

/// Whether the file is a mirror glass as `catoptra mirror make` writes them: faces Glass, Back and Edge.
[[nodiscard]] bool is_mirror_glass(const cad_import::CadModel& model);

/// Why front and back look exchanged: a front called "back" or a back called "front", or a front concave and
/// a back convex as no spectacle lens has them. Nullopt where nothing says so.
[[nodiscard]] std::optional<std::string> exchanged_sides(std::span<const cad_import::Face> front,
                                                         std::span<const cad_import::Face> back,
                                                         const cad_import::LensGeometry& geometry);

/// Turns the normals of loose surfaces (which a file may have either way round) out of the glass: the front's
/// away from the back and the back's away from the front. Sides whose normals do so stay as they are. Returns
/// what the lens measures; throws as cad_import::measure_lens.
cad_import::LensGeometry turn_normals_outwards(std::vector<cad_import::Face>& front,
                                               std::vector<cad_import::Face>& back, const std::string& file);

/// Axis of a meshed lens, from back to front: the mean direction of the front's normals and of the opposite
/// of the back's; nullopt where they cancel.
[[nodiscard]] std::optional<glm::dvec3> lens_axis(const optics::Optic& lens);

/// Thickness of a meshed lens along its axis, at the vertices of the front that have back behind them.
struct LensThickness {
  double min_mm = 0, max_mm = 0;
};
/// Exact hits on the back; negative where the back lies before the front. Nullopt where no vertex has any
/// back behind it.
[[nodiscard]] std::optional<LensThickness> lens_thickness(const optics::Optic& lens);

}  // namespace catoptra::app
