// Planar optics in the ray tracer, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "optics/planar_glass.h"
#include "optics/refraction.h"
#include "render/src/ray_tracer_planar.h"
#include "tests/render/ray_planar_scenes.h"

namespace catoptra {
namespace {

using namespace test;
using optics::OpticKind;

constexpr int kSize = 5;

/// The middle pixel of what `scene` shows, with geometry.
struct Middle {
  render::Frame frame;
  explicit Middle(const render::Scene& scene, int samples = 1)
      : frame(TracedScene(scene).render(kSize, kSize, samples)) {}
  glm::vec3 color() const { return glm::vec3(frame.color[middle_of(kSize)]); }
  glm::dvec3 direction() const { return glm::dvec3(frame.direction[middle_of(kSize)]); }
  glm::dvec3 surface() const { return glm::dvec3(frame.surface[middle_of(kSize)]); }
  glm::dvec4 position() const { return glm::dvec4(frame.position[middle_of(kSize)]); }
  std::uint32_t path() const { return frame.path[middle_of(kSize)]; }
  int optic() const { return frame.optic_id[middle_of(kSize)]; }
};

/// A dark scene with one planar optic at the origin facing +z, seen from `angle_rad` to its normal.
render::Scene single(OpticKind kind, double angle_rad, int depth = 3) {
  render::Scene scene = dark_scene(depth);
  scene.optics.push_back(planar_optic(kind, {0, 0, 0}, {0, 0, 1}, 2000));
  scene.camera = camera_at_angle(angle_rad, 800);
  return scene;
}

/// Radiance `front` from everything before the plane z = 0 and `back` from everything behind it, by a box
/// around it all.
void add_half_spaces(render::Scene& scene, float front, float back) {
  for (const bool upper : {true, false}) {
    cad_import::TriangleMesh mesh = empty_mesh();
    mesh.materials[0].base_color = glm::vec3(0);
    mesh.materials[0].emissive = glm::vec3(upper ? front : back);
    constexpr float kHalf = 60000;
    const float z = upper ? 0.01f : -0.01f - kHalf;
    add_box(mesh, {-kHalf, -kHalf, z}, {2 * kHalf, 2 * kHalf, kHalf});
    // Of the box's six sides, those within the plane of the optic must not be seen.
    std::erase_if(mesh.triangles, [&](const auto& t) {
      const auto in_plane = [&](std::uint32_t vertex) { return std::abs(mesh.positions[vertex].z) < 1; };
      return in_plane(t[0]) && in_plane(t[1]) && in_plane(t[2]);
    });
    mesh.triangle_material.resize(mesh.triangles.size());
    scene.surroundings.push_back(mesh);
  }
}

// ---- Mirrors ----

TEST(PlanarMirror, BothSidesReflectUnlessOneSided) {
  for (const double degrees : {25.0, 155.0}) {
    render::Scene scene = single(OpticKind::mirror, radians(degrees));
    scene.environment.color = glm::vec3(1);
    scene.optics[0].reflectance = {0.9f, 0.6f, 0.3f};
    const Middle both(scene);
    EXPECT_LT(glm::length(both.color() - scene.optics[0].reflectance), 1e-6f);
    EXPECT_EQ(both.optic(), 0);
    const glm::dvec3 d = -glm::normalize(scene.camera.eye_mm);
    EXPECT_LT(glm::length(both.direction() - glm::dvec3(d.x, d.y, -d.z)), 1e-6);
    scene.optics[0].two_sided = false;
    const Middle one(scene);
    EXPECT_EQ(one.optic(), degrees < 90 ? 0 : -1);
  }
}

// Between parallel two-sided mirrors that are met from behind the object's images stand where those of a
// hall of mirrors do.
TEST(PlanarMirror, HallOfMirrorsMetFromBehindHasItsImages) {
  constexpr double kLength = 1000, kAt = 300;
  constexpr int kDepth = 5;
  render::Scene scene = dark_scene(kDepth);
  scene.optics.push_back(planar_optic(OpticKind::mirror, {0, 0, 0}, {0, 0, -1}, 3000));
  scene.optics.push_back(planar_optic(OpticKind::mirror, {0, 0, kLength}, {0, 0, 1}, 3000));
  for (auto& optic : scene.optics) optic.reflectance = glm::vec3(0.9f);
  const glm::dvec3 object(200, 0, kAt);
  add_shining_cube(scene, object, 16, glm::vec3(1));
  scene.camera = {{-150, 40, 600}, {-100, 20, 0}, {0, 1, 0}, 1.2, {640, 480}};
  const render::Frame frame = TracedScene(scene).render(640, 480);
  for (int n = 1; n <= kDepth; ++n) {
    const double z = (n % 2 == 1 ? -kAt : kAt) - 2 * (n / 2) * kLength;
    const std::size_t i = pixel_of(scene.camera, 640, 480, {object.x, object.y, z});
    ASSERT_EQ(frame.position[i].w, 1) << n;
    EXPECT_LT(glm::length(glm::dvec3(frame.position[i]) - object), 0.5 * 16 * std::sqrt(3.0)) << n;
    EXPECT_EQ(frame.bounces[i], n);
    EXPECT_NEAR(frame.color[i].g, std::pow(0.9, n), 1e-6) << n;
  }
}

// Two two-sided mirrors at 60 degrees: five images in a ring, all of them seen at once by their paths.
TEST(PlanarMirror, KaleidoscopeHasFiveImages) {
  render::Scene scene = dark_scene(5);
  const double angle = radians(60);
  const glm::dvec3 along[2]{{1, 0, 0}, {std::cos(angle), std::sin(angle), 0}};
  const glm::dvec3 normal[2]{{0, -1, 0}, {-std::sin(angle), std::cos(angle), 0}};  // away from the object
  for (int k = 0; k < 2; ++k)
    scene.optics.push_back(planar_optic(OpticKind::mirror, 2000.0 * along[k], normal[k], 4000));
  for (auto& optic : scene.optics) optic.reflectance = glm::vec3(0.8f);
  const glm::dvec3 object(420, 150, 30);
  add_shining_cube(scene, object, 20, glm::vec3(1));
  scene.camera = {{900, 500, 60}, {}, {0, 0, 1}, 0.02, {kSize, kSize}};
  for (const std::vector<int>& path : std::vector<std::vector<int>>{{0}, {1}, {0, 1}, {1, 0}, {0, 1, 0}}) {
    glm::dvec3 image = object;
    for (auto k = path.rbegin(); k != path.rend(); ++k) image = mirrored(image, {0, 0, 0}, normal[*k]);
    scene.camera.target_mm = image;
    const Middle middle(scene);
    EXPECT_EQ(middle.path(), path_by(path));
    EXPECT_LT(glm::length(glm::dvec3(middle.position()) - object), 10 * std::sqrt(3.0));
    EXPECT_NEAR(middle.color().r, std::pow(0.8, double(path.size())), 1e-6);
  }
}

// ---- Refractors ----

// From the air and from within, at many angles: the direction by Snell, from the point that the eye looks at.
TEST(Refractor, TurnsLightAsSnellSays) {
  constexpr double kIor = 1.5;
  for (int degrees = 0; degrees < 90; degrees += 4)
    for (const bool from_behind : {false, true}) {
      render::Scene scene =
          single(OpticKind::refractor, from_behind ? radians(180 - degrees) : radians(degrees));
      scene.optics[0].material.ior = kIor;
      const Middle middle(scene);
      const double sine = std::sin(radians(degrees)) * (from_behind ? kIor : 1 / kIor);
      const double side = from_behind ? 1 : -1, a = radians(degrees);
      const glm::dvec3 wanted = sine < 1 ? glm::dvec3(0, -sine, side * std::sqrt(1 - sine * sine))
                                         : glm::dvec3(0, -std::sin(a), -side * std::cos(a));
      EXPECT_LT(glm::length(middle.direction() - wanted), 2e-7) << degrees << ' ' << from_behind;
      EXPECT_LT(glm::length(middle.surface()), 1e-4);
      EXPECT_EQ(middle.path(), path_by({0}));
    }
}

// A point at depth h below the surface is seen from above at h / n.
TEST(Refractor, ShowsApparentDepth) {
  constexpr double kIor = 1.33, kDepth = 400;
  render::Scene scene = single(OpticKind::refractor, 0);
  scene.optics[0].material.ior = kIor;
  scene.surroundings.push_back(empty_mesh());
  add_quad(scene.surroundings[0], {-2000, -2000, float(-kDepth)}, {4000, 0, 0}, {0, 4000, 0});
  scene.camera.fov_rad = 0.01;
  const render::Frame frame = TracedScene(scene).render(101, 101);
  const auto shown = [&](int row) { return frame.position[std::size_t(row * 101 + 50)]; };
  // A pixel's step on the floor is that of a floor at h / n.
  const double tangent = 2 * std::tan(0.005) / 101 * 100,
               step = glm::length(glm::dvec3(shown(100)) - glm::dvec3(shown(0)));
  EXPECT_NEAR(step / tangent - 800, kDepth / kIor, kDepth * 1e-4) << "marginal rays: sin^2 0.005";
}

TEST(Refractor, ReflectsByFresnelAtNormalIncidenceAndAtBrewstersAngle) {
  constexpr double kIor = 1.6;
  for (const double degrees : {0.0, degrees_of(std::atan(kIor))}) {
    render::Scene scene = single(OpticKind::refractor, radians(degrees));
    scene.optics[0].material.ior = kIor;
    add_half_spaces(scene, 1, 0);
    // At Brewster's angle only light across the plane of incidence is reflected: ((n^2 - 1) / (n^2 + 1))^2.
    const double n2 = kIor * kIor, wanted = degrees == 0 ? std::pow((kIor - 1) / (kIor + 1), 2)
                                                         : 0.5 * std::pow((n2 - 1) / (n2 + 1), 2);
    EXPECT_NEAR(Middle(scene).color().r, wanted, 1e-7) << degrees;
  }
}

TEST(Refractor, ReflectsAllBeyondTheCriticalAngle) {
  constexpr double kIor = 1.5;
  const double critical = degrees_of(std::asin(1 / kIor));
  for (const double off : {-0.01, 0.01}) {
    render::Scene scene = single(OpticKind::refractor, radians(180 - critical - off));
    scene.optics[0].material.ior = kIor;
    add_half_spaces(scene, 0, 1);  // the glass's side shines
    const Middle middle(scene);
    if (off > 0) {
      EXPECT_EQ(middle.color().r, 1);
      EXPECT_LT(middle.direction().z, 0) << "follows the reflected light";
    } else {
      EXPECT_LT(middle.color().r, 0.96) << "Fresnel falls steeply: 5 % pass at 0.01 degrees";
      EXPECT_GT(middle.direction().z, 0);
    }
  }
}

// ---- Panes ----

TEST(Pane, DisplacesLightAcrossItself) {
  constexpr double kIor = 1.5, kThickness = 40;
  for (const double degrees : {0.0, 20.0, 45.0, 70.0, 85.0, 110.0, 160.0}) {
    render::Scene scene = single(OpticKind::pane, radians(degrees));
    scene.optics[0].material.ior = kIor;
    scene.optics[0].material.thickness_mm = kThickness;
    const Middle middle(scene);
    const glm::dvec3 d = -glm::normalize(scene.camera.eye_mm);
    EXPECT_LT(glm::length(middle.direction() - d), 1e-7);
    const double a = std::min(radians(degrees), radians(180 - degrees)),
                 cos_b = std::sqrt(1 - std::pow(std::sin(a) / kIor, 2));
    const glm::dvec3 across = glm::cross(middle.surface(), d);
    EXPECT_NEAR(glm::length(across), kThickness * std::sin(a) * (1 - std::cos(a) / (kIor * cos_b)), 1e-4)
        << degrees;
    EXPECT_NEAR(middle.surface().z, 0, 1e-6);
    // The line leaves on the side of the eye, as an object behind glass seems nearer to the normal.
    EXPECT_LT(middle.surface().y * d.y, 1e-9);
  }
}

TEST(Pane, ReflectsTwoBordersWithTheirInternalReflections) {
  render::Scene scene = single(OpticKind::pane, 0);
  scene.optics[0].material.thickness_mm = 5;
  add_half_spaces(scene, 1, 0);
  EXPECT_NEAR(Middle(scene).color().r, 2 * 0.04 / 1.04, 1e-7) << "n = 1.5: 0.04 a border";
}

// ---- Both ----

// In surroundings of radiance 1 what is reflected and what passes add up to 1, at every angle, from both
// sides.
TEST(PlanarGlass, IsInvisibleInWhiteSurroundings) {
  for (const OpticKind kind : {OpticKind::refractor, OpticKind::pane})
    for (const double ior : {1.0, 1.33, 2.5})
      for (double degrees = 0; degrees <= 180; degrees += 3.7) {
        if (std::abs(degrees - 90) < 0.5) continue;
        render::Scene scene = single(kind, radians(degrees));
        scene.environment.color = glm::vec3(1);
        scene.optics[0].material.ior = ior;
        scene.optics[0].material.thickness_mm = 6;
        const Middle middle(scene);
        EXPECT_NEAR(middle.color().g, 1, 1e-6) << degrees << ' ' << ior;
        EXPECT_EQ(middle.optic(), 0);
      }
}

TEST(PlanarGlass, TintColoursWhatPassesAlone) {
  for (const OpticKind kind : {OpticKind::refractor, OpticKind::pane}) {
    render::Scene scene = single(kind, 0);
    scene.environment.color = glm::vec3(1);
    scene.optics[0].material.tint = {0.5f, 0.25f, 0};
    const float r = kind == OpticKind::pane ? 0.08f / 1.04f : 0.04f;
    const glm::vec3 wanted = r + (1 - r) * scene.optics[0].material.tint;
    EXPECT_LT(glm::length(Middle(scene).color() - wanted), 1e-6f);
  }
}

// 1 - (1 - f)^s of fog, s in m from the face to the wall, or to the mirror that is met next.
TEST(PlanarGlass, FogGrowsWithTheWayBehindIt) {
  for (const bool mirror : {false, true}) {
    render::Scene scene = single(OpticKind::refractor, 0);
    optics::PlanarMaterial& glass = scene.optics[0].material;
    glass.ior = 1;  // nothing is reflected
    glass.translucency = 0.4;
    glass.color = {0.9f, 0.5f, 0.1f};
    scene.environment.ambient = 0.6f;
    if (mirror) {
      scene.optics.push_back(planar_optic(OpticKind::mirror, {0, 0, -1700}, {0, 0, 1}, 3000));
      scene.optics[1].reflectance = glm::vec3(1);
    } else {
      scene.surroundings.push_back(empty_mesh());
      add_quad(scene.surroundings[0], {-3000, -3000, -1700}, {6000, 0, 0}, {0, 6000, 0});
    }
    const float share = float(1 - std::pow(0.6, 1.7));
    // The mirror shows the way back through the glass, without a wall: fog all over.
    const glm::vec3 fog = 0.6f * glass.color, behind = mirror ? fog : glm::vec3(0.6f);
    EXPECT_LT(glm::length(Middle(scene).color() - ((1 - share) * behind + share * fog)), 1e-6f) << mirror;
  }
}

TEST(PlanarGlass, MaterialAlphaMixesInTheLitSurface) {
  for (const OpticKind kind : {OpticKind::mirror, OpticKind::refractor, OpticKind::pane})
    for (const double degrees : {30.0, 150.0}) {
      render::Scene scene = single(kind, radians(degrees));
      scene.environment.color = glm::vec3(1);
      scene.environment.ambient = 0.25f;
      scene.optics[0].reflectance = glm::vec3(1);
      scene.optics[0].material.material_alpha = 0.3;
      scene.optics[0].material.color = {0.8f, 0.4f, 0.2f};
      render::Light light;
      light.direction = glm::normalize(glm::dvec3(0, 0.6, -0.8));  // on the front
      light.intensity = 2;
      scene.lights.push_back(light);
      const float irradiance = 0.25f + (degrees < 90 ? 2 * 0.8f : 0);
      const glm::vec3 wanted = 0.7f + 0.3f * irradiance * scene.optics[0].material.color;
      EXPECT_LT(glm::length(Middle(scene).color() - wanted), 2e-6f) << degrees;
    }
}

TEST(PlanarGlass, OneSidedIsNotThereFromBehind) {
  for (const OpticKind kind : {OpticKind::refractor, OpticKind::pane}) {
    render::Scene scene = single(kind, radians(150));
    scene.optics[0].one_sided = true;
    scene.optics[0].material.tint = glm::vec3(0);
    scene.environment.color = glm::vec3(1);
    const Middle behind(scene);
    EXPECT_EQ(behind.optic(), -1);
    EXPECT_EQ(behind.color().r, 1);
    scene.camera = camera_at_angle(radians(30), 800);
    EXPECT_LT(Middle(scene).color().r, 0.1);
  }
}

// A path has two optics at depth 2: the second pane reflects no more, and the third is absent.
TEST(PlanarGlass, IsAbsentWhereTheDepthIsUsedUp) {
  constexpr float kTint = 0.5f;
  for (const int depth : {1, 2, 3}) {
    render::Scene scene = dark_scene(depth);
    for (const double z : {0.0, -300.0, -600.0}) {
      scene.optics.push_back(planar_optic(OpticKind::pane, {0, 0, z}, {0, 0, 1}, 3000));
      scene.optics.back().material.ior = 1;
      scene.optics.back().material.tint = glm::vec3(kTint);
    }
    scene.environment.color = glm::vec3(1);
    scene.camera = camera_at_angle(0.1, 800);
    const Middle middle(scene);
    EXPECT_NEAR(middle.color().r, std::pow(kTint, depth), 1e-6);
    EXPECT_EQ(middle.frame.bounces[middle_of(kSize)], depth);
  }
}

// A pane before a mirror, and a mirror before a pane: the path goes through both, and reflects.
TEST(PlanarGlass, IsMetByChainsFromMirrorsAndLenses) {
  constexpr double kIor = 1.5, kThickness = 30;
  render::Scene scene = dark_scene(4);
  scene.optics.push_back(plane_mirror({0, 0, 0}, {0, 0, 1}, 2000));
  scene.optics[0].reflectance = glm::vec3(1);
  scene.optics.push_back(planar_optic(OpticKind::pane, {0, -600, 500}, {0, 0, 1}, 800));
  scene.optics[1].material.ior = kIor;
  scene.optics[1].material.thickness_mm = kThickness;
  scene.camera = camera_at_angle(radians(45), 500);
  scene.environment.color = glm::vec3(1);
  const Middle by_mirror(scene);
  EXPECT_EQ(by_mirror.path(), path_by({0, 1}));
  EXPECT_NEAR(by_mirror.color().r, 1, 1e-6);
  const double a = radians(45),
               shift = kThickness * (1 - std::sin(a) / kIor / std::sqrt(1 - std::pow(std::sin(a) / kIor, 2)));
  EXPECT_NEAR(by_mirror.surface().y, -500 + shift, 1e-3);
  scene.optics[0] = spherical_lens(400, 400, 3, 60, 15);
  scene.optics[1] = planar_optic(OpticKind::refractor, {0, 0, -200}, {0, 0, 1}, 800);
  scene.optics[1].material.ior = kIor;
  scene.camera = camera_at_angle(0, 300);
  EXPECT_EQ(Middle(scene).path(), path_by({0, 1}));
}

// ---- Rough ----

TEST(NormalSequence, HasMeanZeroAndVarianceOne) {
  EXPECT_EQ(render::normal_pair(0), glm::dvec2(0));
  constexpr int kCount = 4096;
  glm::dvec2 sum(0), squares(0);
  double mixed = 0, fourth = 0;
  for (int k = 1; k <= kCount; ++k) {
    const glm::dvec2 pair = render::normal_pair(k);
    sum += pair;
    squares += pair * pair;
    mixed += pair.x * pair.y;
    fourth += std::pow(pair.x, 4);
  }
  EXPECT_LT(glm::length(sum) / kCount, 1e-12);
  EXPECT_NEAR(squares.x / kCount, 1, 0.01);
  EXPECT_NEAR(squares.y / kCount, 1, 0.01);
  EXPECT_NEAR(mixed / kCount, 0, 0.01);
  EXPECT_NEAR(fourth / kCount, 3, 0.1);
}

// A rough mirror before a wall that is dark below y = e and bright above: the mean is the normal
// distribution's integral, since a tilt by w turns the reflected ray by 2 w.
TEST(RoughPlanar, MeanOfManySamplesIsTheNormalDistributions) {
  constexpr double kSigma = 0.02;
  for (const OpticKind kind : {OpticKind::mirror, OpticKind::refractor})
    for (const double edge_in_sigma : {-1.0, 0.5}) {
      render::Scene scene = single(kind, 0);
      const float full = kind == OpticKind::mirror ? 1 : 0.04f;
      scene.optics[0].reflectance = glm::vec3(1);
      scene.optics[0].material.tint = glm::vec3(0);
      scene.optics[0].material.first_edge = {0, 1, 0};
      scene.optics[0].material.roughness_rad = {kSigma, 0};
      cad_import::TriangleMesh wall = empty_mesh();
      wall.materials[0].base_color = glm::vec3(0);
      wall.materials[0].emissive = glm::vec3(1);
      const float edge = float(2000 * std::tan(2 * kSigma * edge_in_sigma));
      add_quad(wall, {-3000, edge, 2000}, {6000, 0, 0}, {0, 3000, 0});
      scene.surroundings.push_back(wall);
      scene.camera.fov_rad = 1e-5;  // all samples of the pixel look at the centre
      const double share = 0.5 * std::erfc(edge_in_sigma / std::sqrt(2));
      EXPECT_NEAR(Middle(scene, 2048).color().r / full, share, 0.005) << edge_in_sigma;
      // Across the edge nothing is rough.
      scene.optics[0].material.first_edge = {1, 0, 0};
      EXPECT_NEAR(Middle(scene, 64).color().r / full, edge_in_sigma < 0 ? 1 : 0, 1e-6);
    }
}

// ---- Any plane ----

/// What a ray meets behind random glass, computed by itself: the whole optic's line and share by vectors.
TEST(PlanarGlassProperty, RandomPlanesObeySnellAndFresnel) {
  constexpr std::uint32_t kSeed = 20260;
  RecordProperty("seed", int(kSeed));
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto direction = [&] { return glm::normalize(glm::dvec3(any(random), any(random), any(random))); };
  for (int k = 0; k < 200; ++k) {
    const glm::dvec3 normal = direction(), pole = 500.0 * direction();
    glm::dvec3 d = direction();
    if (std::abs(glm::dot(d, normal)) < 0.05) continue;
    const bool pane = k % 2 == 0;
    render::Scene scene = dark_scene(2);
    scene.optics.push_back(planar_optic(pane ? OpticKind::pane : OpticKind::refractor, pole, normal, 300));
    optics::PlanarMaterial& glass = scene.optics[0].material;
    glass.ior = 1.2 + 0.5 * (any(random) + 1);
    glass.thickness_mm = 10;
    const double distance = 400 + 200 * any(random);
    scene.camera = {pole - distance * d, pole, glm::normalize(glm::cross(d, direction())), 0.01, {5, 5}};
    const Middle middle(scene);
    d = ray_of(scene.camera, kSize, kSize, middle_of(kSize));
    const bool front = glm::dot(d, normal) < 0;
    const glm::dvec3 against = front ? normal : -normal;
    glm::dvec3 wanted = d, from = pole;
    if (pane) {
      const glm::dvec3 inside = *optics::refract(d, against, 1 / glass.ior);
      const glm::dvec3 out = pole + glass.thickness_mm / -glm::dot(inside, against) * inside;
      from = out - glm::dot(out - pole, normal) / glm::dot(d, normal) * d;
    } else {
      const auto through = optics::refract(d, against, front ? 1 / glass.ior : glass.ior);
      wanted = through ? *through : d - 2 * glm::dot(d, normal) * normal;
    }
    EXPECT_LT(glm::length(middle.direction() - wanted), 3e-7) << k;
    EXPECT_LT(glm::length(middle.surface() - from), 3e-4) << k << ": floats hold 500 mm to 3e-5";
  }
}

// The area of a pixel behind glass is that of the neighbours' rays: the level of detail of a texture.
TEST(PlanarGlass, CarriesRayDifferentials) {
  for (const OpticKind kind : {OpticKind::refractor, OpticKind::pane}) {
    render::Scene scene = single(kind, radians(60));
    scene.optics[0].material.thickness_mm = 80;
    const render::TracedPlanars planars(scene);
    const render::CameraRays camera = render::camera_rays(scene.camera, 1000, 1000);
    constexpr double kStep = 1e-3;
    const auto beams_at = [&](double column, double row, render::PassedBeams& passed) {
      double columns[16], rows[16], stretch[16];
      int optic[16];
      std::fill(std::begin(columns), std::end(columns), column);
      std::fill(std::begin(rows), std::end(rows), row);
      std::fill(std::begin(optic), std::end(optic), 0);
      render::BeamLanes eye;
      render::aim_beams(camera, columns, rows, stretch, eye);
      render::MetLanes at{};
      planars.meet(eye, optic, at);
      planars.pass(eye, at, optic, passed);
    };
    render::PassedBeams here, right, down;
    beams_at(500, 510, here);
    beams_at(500 + kStep, 510, right);
    beams_at(500, 510 + kStep, down);
    const auto check = [&](const render::LaneVectors& a, const render::LaneVectors& b,
                           const render::LaneVectors& change) {
      const glm::dvec3 wanted = (b.at(0) - a.at(0)) / kStep;
      EXPECT_LT(glm::length(change.at(0) - wanted), 1e-6 * glm::length(wanted) + 1e-9);
    };
    check(here.beams.point, right.beams.point, here.beams.point_right);
    check(here.beams.point, down.beams.point, here.beams.point_down);
    check(here.beams.direction, right.beams.direction, here.beams.direction_right);
    check(here.beams.direction, down.beams.direction, here.beams.direction_down);
  }
}

}  // namespace
}  // namespace catoptra
