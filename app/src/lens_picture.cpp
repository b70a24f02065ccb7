#include "app/src/lens_picture.h"

#include <cmath>
#include <glm/trigonometric.hpp>

#include "app/src/output_file.h"
#include "render/renderer.h"

namespace catoptra::app {
namespace {

/// Cornea to entrance pupil. Source: Atchison and Smith 2000 (3.05 mm for the relaxed schematic eye).
constexpr double kCorneaToPupil_mm = 3;

constexpr glm::vec3 kWall{0.86f, 0.86f, 0.83f}, kLine{0.16f, 0.2f, 0.27f}, kAxis{0.7f, 0.1f, 0.08f};

/// The wall straight ahead of the eye, its lines drawn as strips a little before it.
class Wall {
 public:
  Wall(const optics::LensFrame& wearer, const glm::dvec3& eye_mm, double distance_mm)
      : wearer_(wearer), eye_mm_(eye_mm), distance_mm_(distance_mm) {
    for (const glm::vec3& color : {kWall, kLine, kAxis}) {
      cad_import::Material material;
      material.base_color = color;
      mesh_.materials.push_back(material);
    }
  }

  /// A rectangle of the wall, in mm from the point straight ahead, `before_mm` in front of it.
  void add(glm::dvec2 low, glm::dvec2 high, std::uint32_t material, double before_mm) {
    const auto first = std::uint32_t(mesh_.positions.size());
    for (const glm::dvec2& c : {low, glm::dvec2(high.x, low.y), high, glm::dvec2(low.x, high.y)}) {
      const glm::dvec3 p =
          eye_mm_ + c.x * wearer_.x + c.y * wearer_.y + (distance_mm_ - before_mm) * wearer_.z;
      mesh_.positions.emplace_back(p);
      mesh_.normals.emplace_back(-wearer_.z);
      mesh_.texture_coordinates.emplace_back(0);
      mesh_.bounds.min = glm::min(mesh_.bounds.min, p);
      mesh_.bounds.max = glm::max(mesh_.bounds.max, p);
    }
    // x runs to the left of the eye's picture: counter-clockwise from there.
    mesh_.triangles.emplace_back(first, first + 2, first + 1);
    mesh_.triangles.emplace_back(first, first + 3, first + 2);
    mesh_.triangle_material.insert(mesh_.triangle_material.end(), 2, material);
  }

  [[nodiscard]] cad_import::TriangleMesh mesh() const { return mesh_; }

 private:
  const optics::LensFrame& wearer_;
  glm::dvec3 eye_mm_;
  double distance_mm_;
  cad_import::TriangleMesh mesh_;
};

/// Lines at multiples of `grid_deg`, equally far apart on the wall as the first two are.
cad_import::TriangleMesh grid_wall(const optics::LensFrame& wearer, const glm::dvec3& eye_mm,
                                   const LensPictureOptions& options) {
  constexpr int kLines = 24;  // to each side: beyond the picture's border through strong plus lenses
  constexpr double kLineWidth = 0.06, kAxisWidth = 0.1;  // of the distance between lines
  const double step = options.wall_mm * std::tan(glm::radians(options.grid_deg)), reach = (kLines + 1) * step;
  Wall wall(wearer, eye_mm, options.wall_mm);
  wall.add({-8 * reach, -8 * reach}, {8 * reach, 8 * reach}, 0, 0);
  for (int i = -kLines; i <= kLines; ++i) {
    const double half = 0.5 * step * (i == 0 ? kAxisWidth : kLineWidth), before_mm = i == 0 ? 2 : 1;
    const std::uint32_t material = i == 0 ? 2 : 1;
    wall.add({i * step - half, -reach}, {i * step + half, reach}, material, before_mm);
    wall.add({-reach, i * step - half}, {reach, i * step + half}, material, before_mm);
  }
  return wall.mesh();
}

}  // namespace

std::string lens_picture_png(const LensSource& source, const optics::WearingPosition& position,
                             const LensPictureOptions& options) {
  const optics::LensFrame wearer = optics::wearer_frame(source.frame, position);
  render::Scene scene;
  scene.file = "picture through the lens";
  scene.camera.eye_mm =
      source.frame.back_vertex_mm - (position.vertex_distance_mm + kCorneaToPupil_mm) * wearer.z;
  scene.camera.target_mm = scene.camera.eye_mm + wearer.z;
  scene.camera.up = wearer.y;
  scene.camera.fov_rad = glm::radians(options.fov_deg);
  scene.camera.resolution = {options.width, options.height};
  scene.environment.ambient = 1;
  scene.surroundings.push_back(grid_wall(wearer, scene.camera.eye_mm, options));
  scene.optics.push_back(source.lens);
  render::FrameOptions frame;
  frame.width = options.width;
  frame.height = options.height;
  frame.samples = options.samples;
  render::Renderer renderer(scene);
  return png_bytes(renderer.render(render::Mode::raytrace, scene.camera, frame).frame);
}

}  // namespace catoptra::app
