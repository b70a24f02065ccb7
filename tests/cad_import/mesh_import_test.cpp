// Mesh import, judged by files small enough to know every number of.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "cad_import/import.h"
#include "tests/cad_import/mesh_files.h"

namespace catoptra::cad_import {
namespace {

constexpr std::string_view kQuadObj =
    "mtllib quad.mtl\n"
    "v -10 -10 0\nv 10 -10 0\nv 10 10 0\nv -10 10 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl sign\nf 1/1 2/2 3/3 4/4\n";

/// The vertex of `mesh` nearest to `place`.
std::size_t vertex_at(const TriangleMesh& mesh, const glm::vec3& place) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (glm::distance(mesh.positions[i], place) < glm::distance(mesh.positions[best], place)) best = i;
  return best;
}

void expect_consistent(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
  ASSERT_EQ(mesh.triangle_material.size(), mesh.triangles.size());
  ASSERT_FALSE(mesh.materials.empty());
  for (const std::uint32_t material : mesh.triangle_material) ASSERT_LT(material, mesh.materials.size());
  for (const glm::vec3& normal : mesh.normals) ASSERT_NEAR(glm::length(normal), 1, 1e-5);
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ASSERT_LT(t[k], mesh.positions.size());
    const glm::vec3 a = mesh.positions[t.x],
                    face = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
    EXPECT_GT(glm::dot(face, mesh.normals[t.x]), 0) << "winding and normal disagree";
  }
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TEST(MeshImport, ObjImageIsUpright) {
  const ScratchFolder folder;
  folder.write("quad.mtl", "newmtl sign\nKd 1 0.5 0\nmap_Kd letters.png\n");
  folder.write("letters.png", "not decoded here");
  const TriangleMesh mesh = import_mesh(folder.write("quad.obj", kQuadObj));
  expect_consistent(mesh);
  EXPECT_EQ(mesh.format, "OBJ");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  // MTL's vt has t up: its (0, 0) is the image's lower left corner, which is (0, 1) with t down.
  EXPECT_EQ(mesh.texture_coordinates[vertex_at(mesh, {-10, -10, 0})], glm::vec2(0, 1));
  EXPECT_EQ(mesh.texture_coordinates[vertex_at(mesh, {10, 10, 0})], glm::vec2(1, 0));
  const Material& material = mesh.materials.at(mesh.triangle_material[0]);
  EXPECT_EQ(material.name, "sign");
  EXPECT_NEAR(material.base_color.y, 0.21404, 1e-4);  // sRGB 0.5 by IEC 61966-2-1
  ASSERT_EQ(material.texture, 0);
  EXPECT_EQ(mesh.textures[0].path, (folder / "letters.png").string());
  EXPECT_TRUE(mesh.warnings.empty()) << joined(mesh.warnings);
}

TEST(MeshImport, MissingTextureIsAWarning) {
  const ScratchFolder folder;
  folder.write("quad.mtl", "newmtl sign\nmap_Kd nowhere.png\n");
  const TriangleMesh mesh = import_mesh(folder.write("quad.obj", kQuadObj));
  EXPECT_EQ(mesh.materials.at(mesh.triangle_material[0]).texture, -1);
  EXPECT_EQ(joined(mesh.warnings), "material \"sign\": texture \"nowhere.png\" was not found\n");
}

TEST(MeshImport, MissingMaterialLibraryIsAWarning) {
  const ScratchFolder folder;
  const TriangleMesh mesh = import_mesh(folder.write("quad.obj", kQuadObj));
  EXPECT_EQ(joined(mesh.warnings), "material library \"quad.mtl\" was not found\n");
}

TEST(MeshImport, ObjDissolveIsCutAtTheHalf) {
  const ScratchFolder folder;
  folder.write("quad.mtl", "newmtl sign\nKd 1 1 1\nd 0.3\n");
  const TriangleMesh mesh = import_mesh(folder.write("quad.obj", kQuadObj));
  const Material& material = mesh.materials.at(mesh.triangle_material[0]);
  EXPECT_FLOAT_EQ(material.alpha, 0.3f);
  EXPECT_FLOAT_EQ(material.alpha_cutoff, 0.5f);
}

TEST(MeshImport, GltfIsInMetresWithTextureDown) {
  const ScratchFolder folder;
  const TriangleMesh mesh = import_mesh(folder.write(
      "a.gltf", gltf_triangle(R"("translation": [1, 2, 3],)",
                              R"("pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 1]},)")));
  expect_consistent(mesh);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.bounds.min, glm::dvec3(1000, 2000, 3000));
  EXPECT_EQ(mesh.bounds.max, glm::dvec3(2000, 3000, 3000));
  EXPECT_EQ(mesh.texture_coordinates[vertex_at(mesh, {1000, 2000, 3000})], glm::vec2(0, 0));
  EXPECT_EQ(mesh.texture_coordinates[vertex_at(mesh, {1000, 3000, 3000})], glm::vec2(0, 1));
  EXPECT_EQ(mesh.materials.at(mesh.triangle_material[0]).base_color,
            glm::vec3(0.5f, 0.25f, 0.125f));  // linear
}

TEST(MeshImport, MirroredInstanceKeepsItsOutside) {
  const ScratchFolder folder;
  const std::string content = gltf_triangle(R"("scale": [-2, 1, 1],)", "");
  const TriangleMesh mesh = import_mesh(folder.write("a.gltf", content));
  expect_consistent(mesh);
  // A mirror image in x of a triangle that looks to +z still looks to +z.
  EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.bounds.min.x, -2000);
}

TEST(MeshImport, AlphaModesOfGltf) {
  const ScratchFolder folder;
  const std::string half = R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.25]},)";
  const auto cutoff = [&](const std::string& mode) {
    const TriangleMesh mesh = import_mesh(folder.write("a.gltf", gltf_triangle("", half + mode)));
    EXPECT_FLOAT_EQ(mesh.materials.at(mesh.triangle_material[0]).alpha, 0.25f);
    return mesh.materials.at(mesh.triangle_material[0]).alpha_cutoff;
  };
  EXPECT_EQ(cutoff(""), 0);
  EXPECT_EQ(cutoff(R"("alphaMode": "OPAQUE",)"), 0);
  EXPECT_EQ(cutoff(R"("alphaMode": "BLEND",)"), 0.5f);
  EXPECT_EQ(cutoff(R"("alphaMode": "MASK",)"), 0.5f);
  EXPECT_EQ(cutoff(R"("alphaMode": "MASK", "alphaCutoff": 0.75,)"), 0.75f);
}

TEST(MeshImport, EmbeddedTextureWithSamplerAndTransform) {
  const ScratchFolder folder;
  const std::vector<std::uint8_t> image{'p', 'n', 'g', '?'};
  const std::string material = R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions":
      {"KHR_texture_transform": {"offset": [0.25, 0.5], "rotation": 0.5, "scale": [2, 3]}}}},)";
  const std::string rest = R"("extensionsUsed": ["KHR_texture_transform"],
      "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33648, "wrapT": 33648}],
      "images": [{"mimeType": "image/png", "uri": ")" +
                           data_uri(image, "image/png") + R"("}],)";
  const TriangleMesh mesh = import_mesh(folder.write("a.gltf", gltf_triangle("", material, rest)));
  const Material& used = mesh.materials.at(mesh.triangle_material[0]);
  ASSERT_EQ(used.texture, 0);
  EXPECT_EQ(used.wrap, TextureWrap::mirror);
  ASSERT_EQ(mesh.textures[0].encoded.size(), image.size());
  EXPECT_TRUE(mesh.textures[0].path.empty());
  // offset + R * scale * (s, t), R turning counter-clockwise as seen with t down (KHR_texture_transform).
  const double c = std::cos(0.5), s = std::sin(0.5);
  const auto expect_at = [&](glm::vec3 place, double u, double v) {
    const glm::vec2 st = mesh.texture_coordinates[vertex_at(mesh, place)];
    EXPECT_NEAR(st.x, 0.25 + c * 2 * u + s * 3 * v, 1e-5);
    EXPECT_NEAR(st.y, 0.5 - s * 2 * u + c * 3 * v, 1e-5);
  };
  expect_at({0, 0, 0}, 0, 0);
  expect_at({1000, 0, 0}, 1, 0);
  expect_at({0, 1000, 0}, 0, 1);
}

// The example in the extension's text: the lower left quarter of the image, turned clockwise by 90 degrees.
TEST(MeshImport, TextureTransformExampleOfTheSpecification) {
  const ScratchFolder folder;
  folder.write("image.png", "not decoded here");
  const std::string material = R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions":
      {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5]}}}},)";
  const std::string rest = R"("extensionsUsed": ["KHR_texture_transform"], "textures": [{"source": 0}],
      "images": [{"uri": "image.png"}],)";
  const TriangleMesh mesh = import_mesh(folder.write("a.gltf", gltf_triangle("", material, rest)));
  const auto expect_at = [&](glm::vec3 place, glm::vec2 expected) {
    const glm::vec2 st = mesh.texture_coordinates[vertex_at(mesh, place)];
    EXPECT_NEAR(st.x, expected.x, 1e-6);
    EXPECT_NEAR(st.y, expected.y, 1e-6);
  };
  expect_at({0, 0, 0}, {0, 1});
  expect_at({1000, 0, 0}, {0, 0.5});
  expect_at({0, 1000, 0}, {0.5, 1});
}

TEST(MeshImport, CubeWithoutNormalsKeepsItsEdgesSharp) {
  const ScratchFolder folder;
  const TriangleMesh mesh =
      import_mesh(folder.write("cube.obj",
                               "v 0 0 0\nv 20 0 0\nv 20 20 0\nv 0 20 0\n"
                               "v 0 0 20\nv 20 0 20\nv 20 20 20\nv 0 20 20\n"
                               "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"));
  expect_consistent(mesh);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.positions.size(), 24u);  // eight corners with three normals each
  EXPECT_EQ(mesh.materials.at(mesh.triangle_material[0]).base_color, ImportOptions{}.color);
}

/// A closed cylinder about z without normals: `sides` flat sides, radius 50 mm.
std::string cylinder_obj(int sides) {
  std::string vertices, faces;
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * std::numbers::pi * i / sides;
    for (const int z : {0, 100})
      vertices += "v " + std::to_string(50 * std::cos(a)) + " " + std::to_string(50 * std::sin(a)) + " " +
                  std::to_string(z) + "\n";
    const int j = (i + 1) % sides;
    faces += "f " + std::to_string(2 * i + 1) + " " + std::to_string(2 * j + 1) + " " +
             std::to_string(2 * j + 2) + " " + std::to_string(2 * i + 2) + "\n";
  }
  return vertices + faces;
}

TEST(MeshImport, CylinderWithoutNormalsBecomesSmooth) {
  const ScratchFolder folder;
  const TriangleMesh mesh = import_mesh(folder.write("cylinder.obj", cylinder_obj(24)));
  expect_consistent(mesh);
  EXPECT_EQ(mesh.positions.size(), 48u);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 radial = glm::normalize(glm::vec3(mesh.positions[i].x, mesh.positions[i].y, 0));
    EXPECT_NEAR(glm::dot(mesh.normals[i], radial), 1, 1e-6);  // the angle weights make it exact by symmetry
  }
}

TEST(MeshImport, BadTrianglesAreLeftOutAndCounted) {
  const ScratchFolder folder;
  const TriangleMesh mesh =
      import_mesh(folder.write("bad.ply",
                               "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\n"
                               "property float y\nproperty float z\nelement face 4\n"
                               "property list uchar int vertex_indices\nend_header\n"
                               "0 0 0\n30 0 0\n0 30 0\n60 0 0\n0 nan 1\n"
                               "3 0 1 2\n3 0 1 3\n3 0 0 1\n3 0 1 4\n"));
  expect_consistent(mesh);
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_NE(joined(mesh.warnings).find("triangle(s) without area were left out"), std::string::npos)
      << joined(mesh.warnings);
  EXPECT_EQ(mesh.bounds.max, glm::dvec3(30, 30, 0));
}

TEST(MeshImport, UnitScaleAndPlacementInThatOrder) {
  const ScratchFolder folder;
  const auto file =
      folder.write("a.stl",
                   "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                   "endloop\nendfacet\nendsolid a\n");
  ImportOptions options;
  options.unit = "IN";
  options.scale = 2;
  options.placement = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 7));
  const TriangleMesh mesh = import_mesh(file, options);
  EXPECT_NEAR(mesh.bounds.max.x, 50.8, 1e-5);
  EXPECT_EQ(mesh.bounds.min.z, 7);
  options.unit = "furlong";
  EXPECT_THROW((void)import_mesh(file, options), ImportError);
}

std::string import_error(const std::filesystem::path& file) {
  try {
    (void)import_mesh(file);
  } catch (const ImportError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_EQ(line.rfind(file.string(), 0), 0u) << line;
    return line.substr(file.string().size() + 2);
  }
  return "no error";
}

TEST(MeshImport, SaysWhyAFileCannotBeRead) {
  const ScratchFolder folder;
  EXPECT_EQ(import_error(folder / "absent.obj"), "no such file");
  EXPECT_EQ(import_error(folder.path()), "is a folder, not a file");
  EXPECT_EQ(import_error(folder.write("a.glb", "")), "the file is empty");
  EXPECT_EQ(
      import_error(folder.write("a.step", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n")),
      "is a Git LFS pointer, not the file itself (run git lfs pull)");
  EXPECT_EQ(import_error(folder.write("a.obj", "\xFE\xFFtext")),
            "is UTF-16 text, which no CAD or mesh format allows (save it as UTF-8)");
  EXPECT_EQ(import_error(folder.write("a.txt", "hello")),
            "is no mesh or CAD file that can be read (glTF, OBJ, STL, PLY, STEP, IGES or BREP)");
  EXPECT_EQ(import_error(folder.write("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")),
            "holds no triangle (1 line(s) were left out)");
  EXPECT_NE(import_error(folder.write("a.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [")),
            "no error");
}

TEST(MeshImport, StopsWhenAskedTo) {
  const ScratchFolder folder;
  const auto file = folder.write("a.gltf", gltf_triangle("", ""));
  std::atomic<bool> cancel = true;
  ImportOptions options;
  options.cancel = &cancel;
  EXPECT_THROW((void)import_mesh(file, options), Cancelled);
  cancel = false;
  double last = 0;
  options.progress = [&](double share, std::string_view) {
    EXPECT_GE(share, last);
    last = share;
  };
  EXPECT_NO_THROW((void)import_mesh(file, options));
  EXPECT_EQ(last, 1);
}

}  // namespace
}  // namespace catoptra::cad_import
