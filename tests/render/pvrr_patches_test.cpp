// Adaptive patches (design 2.8; paper 4.1): fewer wrong occlusions, shared border vertices, no seams, no
// flicker.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "optics/placement.h"
#include "render/comparison.h"
#include "render/renderer.h"
#include "render/src/patch_mesh.h"
#include "render/src/patch_tree.h"
#include "render/src/pvrr_atlas.h"
#include "render/src/wrong_share.h"
#include "tests/render/lens_pvrr_scene.h"
#include "tests/render/raster_test_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

/// A convex mirror, with posts near it before a wall: what the posts hide depends on where it is seen from.
Scene posts_before(optics::Optic optic, int max_patches) {
  Scene scene = room();
  scene.camera.eye_mm = {-150, 60, 800};
  scene.camera.fov_rad = 0.25;
  scene.camera.resolution = {480, 360};
  scene.surroundings.clear();
  cad_import::TriangleMesh mesh;
  add_quad(mesh, {20000, -20000, 6000}, {-40000, 0, 0}, {0, 40000, 0}, glm::vec3(0.7f));
  for (int i = -3; i <= 3; ++i)
    add_box(mesh, {300.0f * float(i) + 100, -2000, 500}, {300.0f * float(i) + 160, 2000, 560}, kGreen);
  scene.surroundings.push_back(std::move(mesh));
  scene.optics.push_back(std::move(optic));
  scene.settings.max_error_px = 0.25;
  scene.settings.max_patches = max_patches;
  return scene;
}

RenderResult drawn(const Scene& scene) {
  Renderer renderer(scene);
  return renderer.render(Mode::pvrr, scene.camera, picture_of(scene));
}

std::size_t patches_of(const RenderResult& result) {
  return result.stats.optics.at(0).patches.size();
}

struct Outcome {
  RenderResult picture, exact;
  OpticError error;
};

Outcome outcome(const Scene& scene) {
  Renderer renderer(scene);
  Outcome found;
  found.picture = renderer.render(Mode::pvrr, scene.camera, picture_of(scene));
  found.exact = renderer.render(Mode::raytrace, scene.camera, picture_of(scene));
  found.error = compare(found.exact.frame, found.picture.frame, scene).optics.at(0);
  return found;
}

TEST(Patches, EachMirrorSeesNoMoreThanItsLimit) {
  Scene scene = posts_before(conic_mirror(200, 0, 170, 110, 25, 17), 64);
  scene.surroundings[0] = {};
  add_quad(scene.surroundings[0], {1e5f, -1e5f, 5000}, {-2e5f, 0, 0}, {0, 2e5f, 0}, glm::vec3(0.7f));
  std::size_t last = 0;
  for (const double limit : {2.0, 1.0, 0.6}) {
    scene.settings.patch_fov_rad = limit;
    const auto result = drawn(scene);
    for (const PatchStats& patch : result.stats.optics.at(0).patches)
      EXPECT_LE(std::max(patch.fov_rad[0], patch.fov_rad[1]),
                1.15 * limit)  // refinement may widen a map a little
          << patches_of(result);
    EXPECT_GT(patches_of(result), last);
    last = patches_of(result);
  }
}

TEST(Patches, OcclusionFallsAsTheyAreSplit) {
  double last = 1;
  for (const int most : {1, 2, 4}) {
    const Outcome found = outcome(posts_before(conic_mirror(300, 0, 170, 110, 25, 17), most));
    const double share = double(found.error.occlusion_pixels) / double(found.error.pixels);
    EXPECT_EQ(patches_of(found.picture), std::size_t(most));
    std::printf("%d patches: %.2f %% of the pixels show another surface\n", most, 100 * share);
    EXPECT_LT(share, 0.85 * last) << most << " patches";
    EXPECT_LT(found.error.visible_px.median, 0.25);
    last = share;
  }
}

TEST(Patches, NoneWhereAllIsEquallyFarAndNarrow) {
  Scene scene = posts_before(conic_mirror(1200, 0, 170, 110, 13, 9), 16);
  scene.surroundings[0] = {};
  add_quad(scene.surroundings[0], {1e5f, -1e5f, 5000}, {-2e5f, 0, 0}, {0, 2e5f, 0}, glm::vec3(0.7f));
  EXPECT_EQ(patches_of(drawn(scene)), 1u);
}

TEST(Patches, APlaneMirrorIsOne) {
  Scene scene = posts_before(conic_mirror(0, 0, 600, 400, 13, 9), 16);
  scene.settings.patch_fov_rad = 0.02;
  scene.camera.fov_rad = 0.6;
  EXPECT_EQ(patches_of(drawn(scene)), 1u);
}

/// Largest step of the point shown from a pixel to the next, over pairs that the border crosses and over the
/// others, on the mirror alone and within the wall.
struct Steps {
  double across = 0, inside = 0;
  std::size_t crossings = 0;
};

/// The patch that a surface point lies in: that of the nearest triangle's centre.
std::uint32_t patch_at(const tessellate::OpticArrays& mesh, const PatchLabels& labels,
                       const glm::dvec3& point) {
  std::size_t best = 0;
  double nearest = 1e30;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t].vertices;
    const double d = glm::distance(point, (mesh.vertices[v[0]].position_mm + mesh.vertices[v[1]].position_mm +
                                           mesh.vertices[v[2]].position_mm) /
                                              3.0);
    if (d < nearest) {
      nearest = d;
      best = t;
    }
  }
  return labels.of_triangle[best];
}

PatchLabels labels_of(const Scene& scene, const RenderResult& result) {
  optics::RayScene rays;
  for (const auto& mesh : scene.surroundings) rays.add_surroundings(mesh, {});
  rays.commit();
  const auto& optic = scene.optics[0];
  const auto hits = optics::trace_vertices(optic, scene.camera.eye_mm, rays);
  cad_import::BoundingBox box{{-2e5, -2e5, -100}, {2e5, 2e5, 6000}};
  PatchTree tree;
  auto labels = tree.choose({optic, optic.mesh, hits, box, scene.settings.patch_fov_rad,
                             0.5 * scene.camera.resolution.y / std::tan(0.5 * scene.camera.fov_rad),
                             std::size_t(scene.settings.max_patches), false});
  EXPECT_EQ(labels.count, patches_of(result));
  return labels;
}

TEST(Patches, StepAcrossABorderIsBelowTheStepInside) {
  Scene scene = posts_before(conic_mirror(300, 0, 170, 110, 25, 17), 16);
  scene.surroundings[0] = {};
  // A wall alone: what steps is the picture, not the depth.
  add_quad(scene.surroundings[0], {1e5f, -1e5f, 5000}, {-2e5f, 0, 0}, {0, 2e5f, 0}, glm::vec3(0.7f));
  scene.settings.patch_fov_rad = 0.35;
  const auto result = drawn(scene);
  ASSERT_GE(patches_of(result), 8u);
  const PatchLabels labels = labels_of(scene, result);
  const Frame& f = result.frame;
  Steps steps;
  std::vector<int> patch(f.color.size(), -1);
  for (std::size_t i = 0; i < patch.size(); ++i)
    if (f.optic_id[i] == 0 && f.position[i].w == 1)
      patch[i] = int(patch_at(scene.optics[0].mesh, labels, glm::dvec3(f.surface[i])));
  const auto width = std::size_t(f.width);
  for (const std::size_t stride : {std::size_t(1), width})
    for (std::size_t i = 0; i + stride < patch.size(); ++i) {
      if (patch[i] < 0 || patch[i + stride] < 0 || (stride == 1 && (i + 1) % width == 0)) continue;
      // Per step on the exact surface: as a direction at the mirror, since the wall's points run away to the
      // sides.
      const glm::dvec3 a = glm::dvec3(f.position[i]) - glm::dvec3(f.surface[i]),
                       b = glm::dvec3(f.position[i + stride]) - glm::dvec3(f.surface[i + stride]);
      const double step = angle_arcmin(a, b);
      if (patch[i] == patch[i + stride]) {
        steps.inside = std::max(steps.inside, step);
      } else {
        steps.across = std::max(steps.across, step);
        ++steps.crossings;
      }
    }
  EXPECT_GT(steps.crossings, 300u);
  EXPECT_LT(steps.across, steps.inside) << "arcmin";
}

/// Whether the exact picture shows one surface at pixels i and i + stride and around them.
bool away_from_occlusion(const Frame& exact, std::size_t i, std::size_t stride) {
  const auto width = std::size_t(exact.width);
  const auto x = i % width, y = i / width;
  if (x < 3 || x + 4 >= width || y < 3 || y + 4 >= std::size_t(exact.height)) return false;
  for (const std::size_t center : {i, i + stride})
    for (int v = -2; v <= 2; ++v)
      for (int u = -2; u <= 2; ++u) {
        const std::size_t k = center + std::size_t(v * exact.width + u);
        // The wall lies at z = 6000, the posts' faces at 500 and 560.
        if (exact.optic_id[k] != 0 || exact.position[k].w != 1 ||
            std::abs(exact.position[k].z - exact.position[i].z) > 1)
          return false;
      }
  return true;
}

// Near posts before a far wall, where each patch's viewpoint hides something else: on either surface, away
// from its outlines, the point shown steps across a border by no more than inside, as it is and against the
// exact step.
TEST(Patches, WorldPositionStepsAcrossABorderNoMoreThanInside) {
  Scene scene = posts_before(conic_mirror(300, 0, 170, 110, 25, 17), 16);
  scene.settings.patch_fov_rad = 0.35;
  const Outcome found = outcome(scene);
  ASSERT_GE(patches_of(found.picture), 8u);
  const PatchLabels labels = labels_of(scene, found.picture);
  const Frame &f = found.picture.frame, &exact = found.exact.frame;
  std::vector<int> patch(f.color.size(), -1);
  for (std::size_t i = 0; i < patch.size(); ++i)
    if (f.optic_id[i] == 0 && f.position[i].w == 1)
      patch[i] = int(patch_at(scene.optics[0].mesh, labels, glm::dvec3(f.surface[i])));
  Steps on_wall, on_posts, excess;
  for (const std::size_t stride : {std::size_t(1), std::size_t(f.width)})
    for (std::size_t i = 0; i + stride < patch.size(); ++i) {
      if (patch[i] < 0 || patch[i + stride] < 0 || !away_from_occlusion(exact, i, stride)) continue;
      const double step = glm::distance(glm::dvec3(f.position[i]), glm::dvec3(f.position[i + stride])),
                   right =
                       glm::distance(glm::dvec3(exact.position[i]), glm::dvec3(exact.position[i + stride]));
      const bool across = patch[i] != patch[i + stride];
      const auto add = [&](Steps& steps, double value) {
        double& most = across ? steps.across : steps.inside;
        most = std::max(most, value);
        steps.crossings += across;
      };
      add(exact.position[i].z > 1000 ? on_wall : on_posts, step);
      add(excess, step / right);
    }
  std::printf("wall %.1f across %.1f inside mm; posts %.2f, %.2f; over the exact %.3f, %.3f\n",
              on_wall.across, on_wall.inside, on_posts.across, on_posts.inside, excess.across, excess.inside);
  EXPECT_GT(on_wall.crossings, 200u);
  EXPECT_GT(on_posts.crossings, 50u);
  EXPECT_LT(on_wall.across, on_wall.inside);
  EXPECT_LT(on_posts.across, on_posts.inside);
  EXPECT_LT(excess.across, excess.inside);
}

TEST(Patches, BorderVerticesAreSharedWithTheirHits) {
  const auto optic = conic_mirror(300, 0, 170, 110, 5, 3);
  std::vector<std::uint32_t> labels;
  for (const auto& t : optic.mesh.triangles)
    labels.push_back(optic.mesh.vertices[t.vertices[0]].position_mm.x < -1 ? 0 : 1);
  const PatchMesh cut = cut_into_patches(optic.mesh, labels, 2);
  ASSERT_EQ(cut.ranges.size(), 2u);
  EXPECT_EQ(cut.mesh.triangles.size(), optic.mesh.triangles.size());
  std::multiset<std::uint32_t> sources(cut.source.begin(), cut.source.end());
  std::size_t twice = 0;
  for (std::uint32_t v = 0; v < optic.mesh.vertices.size(); ++v) {
    EXPECT_GE(sources.count(v), 1u);
    twice += sources.count(v) == 2;
  }
  EXPECT_EQ(cut.mesh.vertices.size(), optic.mesh.vertices.size() + twice);
  EXPECT_GE(twice, 3u);
  for (std::size_t i = 0; i < cut.source.size(); ++i)
    EXPECT_EQ(cut.mesh.vertices[i].position_mm, optic.mesh.vertices[cut.source[i]].position_mm);
  // A refined mirror in patches has no more rays than vertices: those on borders are traced once.
  const auto result = drawn(posts_before(conic_mirror(300, 0, 170, 110, 13, 9), 8));
  EXPECT_EQ(patches_of(result), 8u);
  EXPECT_GT(result.stats.optics.at(0).vertices, 13u * 9u);
  EXPECT_EQ(result.stats.optics.at(0).scene_rays, result.stats.optics.at(0).vertices);
}

TEST(Patches, AMovingEyeDoesNotFlipThem) {
  Scene scene = posts_before(conic_mirror(300, 0, 170, 110, 25, 17), 16);
  scene.surroundings[0] = {};
  add_quad(scene.surroundings[0], {1e5f, -1e5f, 5000}, {-2e5f, 0, 0}, {0, 2e5f, 0}, glm::vec3(0.7f));
  scene.camera.resolution = {80, 60};
  // Halfway between one patch and two: the whole's field of view itself is the limit.
  scene.settings.patch_fov_rad = 3;
  const auto whole = drawn(scene).stats.optics.at(0).patches.at(0);
  scene.settings.patch_fov_rad = std::max(whole.fov_rad[0], whole.fov_rad[1]);
  Renderer renderer(scene);
  const auto options = picture_of(scene);
  std::set<std::size_t> without;
  int changes = 0;
  std::size_t last = 0;
  for (int i = 0; i < 12; ++i) {
    Camera camera = scene.camera;
    camera.eye_mm.z += i % 2 ? 30 : -30;
    FrameOptions anew = options;
    anew.reuse_static = false;
    Renderer fresh(scene);
    without.insert(patches_of(fresh.render(Mode::pvrr, camera, anew)));
    const std::size_t now = patches_of(renderer.render(Mode::pvrr, camera, options));
    changes += i > 0 && now != last;
    last = now;
  }
  EXPECT_GT(without.size(), 1u) << "the eye is to pass the limit";
  EXPECT_LE(changes, 1);
}

TEST(Patches, SameCallSameBytesAndAfterAnotherWayWithoutMemory) {
  const Scene scene = posts_before(conic_mirror(300, 0, 170, 110, 25, 17), 16);
  auto options = picture_of(scene);
  options.reuse_static = false;
  Renderer renderer(scene);
  const auto first = renderer.render(Mode::pvrr, scene.camera, options);
  Camera other = scene.camera;
  other.eye_mm *= 0.7;
  static_cast<void>(renderer.render(Mode::pvrr, other, options));
  const auto again = renderer.render(Mode::pvrr, scene.camera, options);
  EXPECT_EQ(again.frame.color, first.frame.color);
  EXPECT_EQ(again.frame.position, first.frame.position);
  // What is kept changes nothing either.
  options.reuse_static = true;
  Renderer keeping(scene);
  static_cast<void>(keeping.render(Mode::pvrr, scene.camera, options));
  EXPECT_EQ(keeping.render(Mode::pvrr, scene.camera, options).frame.color, first.frame.color);
  EXPECT_EQ(keeping.render(Mode::pvrr, scene.camera, options).stats.rays, 0u);
}

TEST(Patches, ALensWithWavelengthsInPatchesShowsTheSame) {
  Scene scene = wall_behind_lens(60, 0.5, 3000);
  scene.optics.push_back(lens_of(100, 200, 6, 60, 17, 3));
  scene.settings.max_error_px = 0.1;
  scene.settings.patch_fov_rad = 0.3;
  const Outcome cut = outcome(scene);
  scene.settings.max_patches = 1;
  const Outcome whole = outcome(scene);
  EXPECT_GE(patches_of(cut.picture), 4u);
  EXPECT_EQ(cut.error.pixels, whole.error.pixels);
  EXPECT_LT(cut.error.screen_px.median, 0.1);
  EXPECT_LT(cut.error.screen_px.p99, 1.2 * whole.error.screen_px.p99);
  EXPECT_TRUE(cut.picture.warnings.empty());
}

TEST(Patches, MoveWithTheOptic) {
  Scene scene = posts_before(conic_mirror(300, 0, 170, 110, 25, 17), 16);
  Renderer renderer(scene), moving(scene);
  glm::dmat4 placement(1);
  placement[3] = {40, -20, 10, 1};
  const auto options = picture_of(scene);
  static_cast<void>(moving.render(Mode::pvrr, scene.camera, options));
  moving.place_optic(0, placement);
  const auto there = moving.render(Mode::pvrr, scene.camera, options);
  const auto exact = moving.render(Mode::raytrace, scene.camera, options);
  EXPECT_GT(patches_of(there), 1u);
  EXPECT_LT(compare(exact.frame, there.frame, scene).optics.at(0).visible_px.median, 0.25);
}

TEST(Patches, ModeExactIsRightWithThem) {
  const Scene scene = posts_before(conic_mirror(300, 0, 170, 110, 25, 17), 16);
  Renderer renderer(scene);
  const auto exact = renderer.render(Mode::exact, scene.camera, picture_of(scene));
  const auto traced = renderer.render(Mode::raytrace, scene.camera, picture_of(scene));
  const auto error = compare(traced.frame, exact.frame, scene).optics.at(0);
  EXPECT_LT(error.screen_px.p999, 0.5);
  EXPECT_EQ(wrong_share(traced.frame, exact.frame), 0);
  // The comparison takes the normal of what is met from the pixels beside it: at a crease it is another
  // face's.
  EXPECT_LT(double(error.occlusion_pixels), 0.002 * double(error.pixels));
}

TEST(Atlas, MapsAndTheirGuardsDoNotOverlap) {
  const std::vector<glm::ivec2> sizes{{96, 32}, {32, 160}, {64, 64}, {16, 16}, {160, 96}};
  const AtlasLayout layout = lay_out(sizes);
  std::vector<int> used(std::size_t(layout.texels.x) * std::size_t(layout.texels.y), 0);
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const AtlasPlace& place = layout.places[k];
    EXPECT_EQ(place.texels, sizes[k]);
    for (int y = 0; y < place.texels.y + 2 * place.guard; ++y)
      for (int x = 0; x < place.texels.x + 2 * place.guard; ++x)
        ++used.at(std::size_t(place.corner.y + y) * std::size_t(layout.texels.x) +
                  std::size_t(place.corner.x + x));
  }
  EXPECT_LE(*std::max_element(used.begin(), used.end()), 1);
  const AtlasLayout single = lay_out(std::vector<glm::ivec2>{{96, 32}});
  EXPECT_EQ(single.places[0].guard, 0);
  EXPECT_EQ(single.texels, glm::ivec2(96, 32));
  const AtlasLayout limited = lay_out(sizes, 200);
  EXPECT_LE(std::max(limited.texels.x, limited.texels.y), 200);
}

/// Texels that a map needs for as many to a pixel with its up vector turned by `turn_rad`, against as made.
double texels_turned(const optics::Optic& optic, double turn_rad) {
  const glm::dvec3 eye(-150, 60, 800);
  const auto hits = optics::reflect_vertices(optic, eye);
  const auto view = optics::make_virtual_view(optic, hits, {{-5000, -5000, 0}, {5000, 5000, 5000}});
  // The same volume's sides about axes turned: what holds every ray's direction and start.
  const auto area = [&](double angle) {
    const glm::dvec3 right = std::cos(angle) * view.right + std::sin(angle) * view.up,
                     up = std::cos(angle) * view.up - std::sin(angle) * view.right;
    glm::dvec2 low(1e30), high(-1e30);
    for (const auto& hit : hits)
      for (const glm::dvec3& v :
           {hit.direction, hit.surface_point_mm + 5000.0 * hit.direction - view.viewpoint_mm}) {
        const glm::dvec2 at(glm::dot(v, right) / glm::dot(v, view.direction),
                            glm::dot(v, up) / glm::dot(v, view.direction));
        low = glm::min(low, at);
        high = glm::max(high, at);
      }
    return (high.x - low.x) * (high.y - low.y);
  };
  return area(turn_rad) / area(0);
}

// The table of docs/decisions/0010: up along a principal direction against up 45 degrees and `turn` off it
// (paper 4.3, Fig. 10).
TEST(UpVector, PrincipalDirectionSavesTexels) {
  struct Case {
    const char* name;
    double k1, k2;
    double least;
  };
  for (const Case& c : {Case{"cylinder", 1.0 / 300, 0, 1.5}, Case{"saddle", 1.0 / 300, -1.0 / 1200, 1.5}}) {
    for (const double turn : {0.0, 0.4, 0.7854}) {
      const auto surface = std::make_shared<TwoCurvatureSurface>(c.k1, c.k2, turn, 60, 60);
      const auto optic = rectangular_mirror(surface, 120, 120, 13, 13);
      const double saving = texels_turned(optic, 0.25 * 3.14159265358979);
      RecordProperty(std::string(c.name) + "_" + std::to_string(int(100 * turn)), std::to_string(saving));
      std::printf("%s, axes turned by %.2f rad: %.2f times the texels at 45 degrees\n", c.name, turn, saving);
      EXPECT_GT(saving, c.least) << c.name << " " << turn;
    }
  }
}

}  // namespace
}  // namespace catoptra::render
