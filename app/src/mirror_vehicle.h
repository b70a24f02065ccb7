// The vehicle around a mirror, from the scene: eyes, planes, and what is in the way.
#pragma once

#include <memory>

#include "app/src/mirror_evaluation.h"
#include "optics/ray_scene.h"

namespace catoptra::app {

struct MirrorVehicle {
  VehicleSummary summary;
  std::unique_ptr<optics::RayScene> body;      ///< committed; null where nothing is in the way
  std::unique_ptr<optics::RayScene> attached;  ///< what turns with the mirror; null where there is nothing
  std::vector<std::filesystem::path> files;    ///< that what is in the way was read from
  std::vector<std::string> notes;
};

/// Takes the vehicle from the scene's [evaluation] and fills in what it leaves out: forward +y (-z where y is
/// up), the camera's eye, all surroundings, and a side plane at the outermost place of the named vehicle's
/// body behind the mirror, else at the mirror's inner end; each with a note, but for the eye. Throws
/// catoptra::Error that names the key at fault.
[[nodiscard]] MirrorVehicle make_mirror_vehicle(const SceneFile& scene, std::size_t optic,
                                                const optics::MirrorGlass& glass,
                                                const MirrorEvaluationOptions& options);

}  // namespace catoptra::app
