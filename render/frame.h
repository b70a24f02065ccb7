// A rendered picture with the geometry it shows.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/mode.h"

namespace catoptra::render {

/// Row-major, top row first, left pixel first; every array that is not empty has width * height entries.
struct Frame {
  int width = 0, height = 0;
  std::vector<glm::vec4> color;  ///< linear RGB, alpha = 1

  // Geometry of the pixel's centre (sample 0), filled only where asked for, and only where an optic shows
  // (optic_id >= 0), except `position`, which is there for every pixel.
  std::vector<glm::vec4> position;     ///< xyz, w = 1: world point shown, mm; w = 0: a direction (the sky)
  std::vector<glm::vec3> surface;      ///< last point on the last optic, mm
  std::vector<glm::vec3> direction;    ///< unit outgoing direction of the exact ray where the mode knows it
  std::vector<std::int32_t> optic_id;  ///< index in Scene::optics of the first optic seen; -1: no optic
  std::vector<std::uint8_t> bounces;   ///< optics along the path; empty: 1 wherever an optic shows
  std::vector<std::uint32_t> path;     ///< which ones, in order: see path_after(); empty: optic_id alone

  std::vector<std::uint8_t>
      retraced;  ///< mode exact: 1 where an optic shows what no map knows and was traced
};

/// The number of a path that goes on by optic `optic` after the path numbered `path`; 0 is a path without
/// optics. Two paths with the same number meet the same optics in the same order. Source: FNV-1a.
[[nodiscard]] constexpr std::uint32_t path_after(std::uint32_t path, std::int32_t optic) {
  return (path ^ static_cast<std::uint32_t>(optic + 1)) * 16777619u;
}

/// Number of the path of pixel `i`, for frames without `path` too.
[[nodiscard]] inline std::uint32_t path_of(const Frame& frame, std::size_t i) {
  if (!frame.path.empty()) return frame.path[i];
  return frame.optic_id[i] < 0 ? 0u : path_after(0, frame.optic_id[i]);
}

struct PatchStats {
  glm::dvec3 viewpoint_mm{0};
  double residual_mm = 0;
  double fov_rad[2] = {0, 0};
  int texels[2] = {0, 0};  ///< of its map
};

struct OpticStats {
  std::string name;
  std::string kind;          ///< "mirror" or "lens"
  std::size_t vertices = 0;  ///< mode pvrr: of the mesh drawn, refined where it had to be
  std::size_t rays = 0;      ///< reflected or refracted for this optic in this frame
  std::size_t scene_rays =
      0;  ///< mode pvrr: sent into the scene from there, which kept rays are too where the optic moves
  std::vector<PatchStats> patches;
  std::size_t refinement_rays =
      0;  ///< mode pvrr: of `rays`, those at the middles of edges and in new vertices
  /// Mode exact: pixels that show the optic in any sample, and those of them that were traced anew.
  std::size_t shown_pixels = 0, retraced_pixels = 0;
};

/// Mode pvrr: one optic's reflection or refraction maps, of an optic in the picture or in another one's map.
struct MapStats {
  std::string way;     ///< names of the optics from the eye on, joined by " > "; the map is the last one's
  int level = 1;       ///< number of optics on that way
  bool drawn = false;  ///< in this frame; false: kept
  std::size_t texels = 0;
  std::size_t rays = 0;        ///< reflected or refracted for it in this frame
  std::size_t scene_rays = 0;  ///< sent into the scene from there
  std::size_t draws = 0;       ///< draw calls for surroundings and bodies in its maps, in this frame
};

/// Raster modes: what shadows have cost, over all views of a frame. All 0 where no light casts any.
struct ShadowStats {
  std::size_t views = 0;             ///< the picture and the maps drawn
  std::size_t volumes = 0;           ///< drawn, of connected bodies
  std::size_t silhouette_edges = 0;  ///< of the volumes drawn
  std::size_t stencil_draws = 0;     ///< that count
  std::size_t folds = 0;             ///< from the count into the light's bit
  double time_ms = 0;                ///< a part of the passes' times; the key "shadow" of FrameStats::time_ms
};

/// What a frame cost. Times in ms; keys: "total", "trace", "pass1", "pass2", "verify", "readback",
/// "raster", "map" as they apply.
struct FrameStats {
  std::vector<OpticStats> optics;
  std::map<std::string, double> time_ms;
  std::size_t rays = 0;  ///< all rays of the frame
  int samples = 1;       ///< per pixel in the picture; above 1, all counts and times are sums over them
  std::vector<MapStats> maps;  ///< mode pvrr: all maps, level by level
  /// Mode pvrr: optics in maps of others that were found not to be seen there, so that no map was made.
  std::size_t maps_pruned = 0;
  ShadowStats shadows;
};

struct RenderResult {
  Frame frame;
  FrameStats stats;
  std::vector<std::string> warnings;
  std::optional<ModeChoice> choice;  ///< mode automatic: which mode drew, and why
};

/// Options of one frame.
struct FrameOptions {
  int width = 1280, height = 720;
  int samples = 1;                ///< per pixel; sample 0 is the pixel's centre
  bool geometry = false;          ///< fill Frame::position, surface, direction, optic_id
  std::size_t threads = 0;        ///< CPU threads; 0: all
  bool read_back = true;          ///< false: leave the picture on the GPU (bench)
  bool overlay_vertices = false;  ///< red balls at the exact hits, and the optic's mesh in white
  bool overlay_rays = false;      ///< the vertex rays as lines
  bool overlay_patches = false;   ///< mode pvrr: each patch tinted, its border, and a line to its viewpoint
  /// Keep from the last frame what cannot have changed: vertex rays, viewpoints and maps while eye and optic
  /// stay, the rays alone while they move together (PVRR paper, 5). Changes no picture by more than
  /// rounding, only its cost; false: everything anew in every frame.
  bool reuse_static = true;
  /// Mode pvrr: planar optics get maps of what is seen of them alone. false, to measure what that saves: of the
  /// whole view, for every face that is turned to the eye, as in Diefenbach and Badler 1994, formula (5).
  bool check_visibility = true;
  /// Hardware multisampling of outlines, 1, 2, 4 or 8 times: the cheap way while things move. Less where the
  /// driver cannot, which a warning tells. Not in mode raytrace, and not in pictures of several samples,
  /// which have better.
  int multisample = 1;

  bool operator==(const FrameOptions&) const = default;
};

}  // namespace catoptra::render
