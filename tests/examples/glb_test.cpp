// The GLB writer, judged by an importer that others wrote.
#include "examples/street/glb.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cstring>
#include <limits>

#include "examples/street/palette.h"
#include "examples/street/shapes.h"
#include "examples/street/street.h"

namespace catoptra::examples {
namespace {

const Palette& palette() {
  static const Palette made = make_palette(CATOPTRA_SIGN_FONT);
  return made;
}

const aiScene* read(Assimp::Importer& importer, const std::vector<std::byte>& glb) {
  return importer.ReadFileFromMemory(glb.data(), glb.size(), aiProcess_ValidateDataStructure, "glb");
}

TEST(Glb, StreetReadsBackWithEveryTriangleAndMaterial) {
  const Model street = make_street();
  Assimp::Importer importer;
  const aiScene* scene = read(importer, write_glb(street, palette(), "street"));
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  std::size_t triangles = 0;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    triangles += scene->mMeshes[i]->mNumFaces;
    EXPECT_TRUE(scene->mMeshes[i]->HasNormals());
    EXPECT_TRUE(scene->mMeshes[i]->HasTextureCoords(0));
  }
  EXPECT_EQ(triangles, street.triangle_count());
  EXPECT_EQ(scene->mNumMeshes, street.surfaces.size());
  ASSERT_GT(scene->mNumTextures, 10u);
  for (unsigned i = 0; i < scene->mNumTextures; ++i) {
    ASSERT_EQ(scene->mTextures[i]->mHeight, 0u);  // still encoded
    EXPECT_EQ(std::memcmp(scene->mTextures[i]->pcData, "\x89PNG", 4), 0);
  }
}

TEST(Glb, UpBecomesPlusYAndForwardMinusZ) {
  Model model;
  add_box(model, "stone", {0, 0, 0}, {1, 2, 3});
  Assimp::Importer importer;
  const aiScene* scene = read(importer, write_glb(model, palette(), "box"));
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  const aiMesh& mesh = *scene->mMeshes[0];
  aiVector3D low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i)
    for (unsigned k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], mesh.mVertices[i][k]);
      high[k] = std::max(high[k], mesh.mVertices[i][k]);
    }
  EXPECT_EQ(low, aiVector3D(0, 0, -2));
  EXPECT_EQ(high, aiVector3D(1, 3, 0));
}

TEST(Glb, SameModelGivesTheSameBytes) {
  EXPECT_EQ(write_glb(make_street(), make_palette(CATOPTRA_SIGN_FONT), "street"),
            write_glb(make_street(), make_palette(CATOPTRA_SIGN_FONT), "street"));
}

TEST(Glb, LengthInTheHeaderIsTheFiles) {
  Model model;
  add_box(model, "bricks", {0, 0, 0}, {1, 1, 1});
  const auto glb = write_glb(model, palette(), "box");
  ASSERT_GE(glb.size(), 12u);
  std::size_t length = 0;
  for (std::size_t i = 0; i < 4; ++i) length |= std::to_integer<std::size_t>(glb[8 + i]) << (8 * i);
  EXPECT_EQ(length, glb.size());
  EXPECT_EQ(glb.size() % 4, 0u);
}

TEST(Glb, UnknownMaterialIsRefused) {
  Model model;
  add_box(model, "unobtainium", {0, 0, 0}, {1, 1, 1});
  EXPECT_THROW((void)write_glb(model, palette(), "box"), std::out_of_range);
}

}  // namespace
}  // namespace catoptra::examples
