// Damaged mesh files are read or refused, never worse.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cad_import/import.h"
#include "tests/cad_import/mesh_files.h"

namespace catoptra::cad_import {
namespace {

constexpr unsigned kSeed = 20261122;

/// Cuts the text off, or overwrites up to eight of its bytes; digits often become other digits, as indices
/// do.
std::string damaged(std::string text, std::mt19937& random) {
  if (random() % 4 == 0) {
    text.resize(random() % text.size());
    return text;
  }
  for (unsigned n = 1 + random() % 8; n > 0; --n) {
    const std::size_t at = random() % text.size(), digit = text.find_first_of("0123456789", at);
    if (random() % 2 == 0 && digit != std::string::npos)
      text[digit] = "0123456789-."[random() % 12];
    else
      text[at] = static_cast<char>(random() % 256);
  }
  return text;
}

TEST(MeshDamage, IsReadOrRefusedInOneLine) {
  std::cout << "seed " << kSeed << "\n";
  std::mt19937 random(kSeed);
  const ScratchFolder folder;
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.gltf",
       gltf_triangle(R"("translation": [1, 2, 3],)", R"("alphaMode": "MASK", "alphaCutoff": 0.75,)")},
      {"a.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf -4 -2 -1\n"},
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n9 0 0\n0 9 0\n3 0 1 2\n"},
      {"a.stl",
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 "
       "0\nendloop\nendfacet\n"
       "endsolid a\n"}};
  int read = 0, refused = 0;
  for (int round = 0; round < 100; ++round)
    for (const auto& [name, content] : files) {
      try {
        const TriangleMesh mesh = import_mesh(folder.write(name, damaged(content, random)));
        ++read;
        for (const glm::uvec3& t : mesh.triangles)
          for (int k = 0; k < 3; ++k) ASSERT_LT(t[k], mesh.positions.size());
        for (const glm::vec3& p : mesh.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
      } catch (const ImportError& error) {
        ++refused;
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  EXPECT_GT(read, 0);
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace catoptra::cad_import
