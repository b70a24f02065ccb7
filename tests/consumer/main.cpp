// Imports a mirror R 1200 mm from STEP, traces one ray to its exact surface and compares with the sphere's
// closed form.
#include <cmath>
#include <cstdio>
#include <exception>
#include <glm/geometric.hpp>

#include "cad_import/import.h"
#include "optics/exact_hit.h"
#include "optics/ray_scene.h"
#include "optics/reflection.h"
#include "render/renderer.h"
#include "tessellate/optic_mesh.h"

int main(int argc, char** argv) try {
  using namespace catoptra;
  if (argc != 2) return 2;
  const cad_import::CadModel model = cad_import::import_cad(argv[1]);
  optics::Optic optic;
  for (const cad_import::Face& face : model.faces)
    if (face.name == "Glass") optic.faces.push_back(face);
  optic.mesh = tessellate::tessellate_optic(optic.faces).mesh.arrays();

  optics::RayScene scene;
  scene.add_optic(optic.mesh);
  scene.commit();
  const optics::Ray ray{{50, 20, 500}, {0, 0, -1}};
  const auto hit = optics::exact_hit(optic, ray, scene.intersect(ray));
  if (!hit) {
    std::puts("the ray misses the mirror");
    return 1;
  }
  const glm::dvec3 direction = optics::reflect(ray.direction, hit->normal);

  constexpr double kRadius_mm = 1200;
  const glm::dvec3 centre(0, 0, -kRadius_mm);
  const glm::dvec3 point(50, 20, std::sqrt(kRadius_mm * kRadius_mm - 50 * 50 - 20 * 20) - kRadius_mm);
  const glm::dvec3 expected = optics::reflect(ray.direction, (point - centre) / kRadius_mm);
  const double distance_mm = glm::distance(hit->position_mm, point),
               turn_rad = glm::distance(direction, expected);
  std::printf("%zu faces, mode %s, hit %.3g mm and direction %.3g rad from the sphere's\n",
              model.faces.size(), std::string(render::mode_name(render::Mode::pvrr)).c_str(), distance_mm,
              turn_rad);
  // mirror make promises 1e-6 mm; its slope is then right to about 1e-6 mm over a patch of some millimetres.
  return distance_mm < 2e-6 && turn_rad < 1e-6 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
