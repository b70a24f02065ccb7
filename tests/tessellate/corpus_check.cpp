// Every CAD file of the corpus: all its faces as one optic. corpus_check FILE meshes one file; without
// argument it says that there is no corpus.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "cad_import/import.h"
#include "tests/tessellate/mesh_checks.h"

namespace {

using namespace catoptra;

constexpr int kSkipped = 77;

/// Complaints about the mesh of one model.
int check(const cad_import::CadModel& model, bool complete) {
  tessellate::TessellationOptions options;
  options.chord_mm = 0.1;
  options.max_vertices = 300000;
  const auto result = tessellate::tessellate_optic(model.faces, options);
  int wrong = 0;
  const auto expect = [&](bool holds, const char* what, double value) {
    std::printf("%s %s: %g\n", holds ? "  " : "x ", what, value);
    if (!holds) ++wrong;
  };
  for (const auto& face : result.unmeshed)
    std::printf("   face %d (%s) not meshed: %s\n", face.index, face.id.c_str(), face.reason.c_str());
  for (const auto& warning : result.warnings) std::printf("   warning: %s\n", warning.c_str());
  std::vector<char> named(model.faces.size(), 0), meshed(model.faces.size(), 0);
  for (const auto& face : result.unmeshed) named[static_cast<std::size_t>(face.index)] = 1;
  for (const auto face : result.mesh.half_edges().faces())
    meshed[static_cast<std::size_t>(result.mesh.half_edges().data(face).face)] = 1;
  int lost = 0;
  for (std::size_t f = 0; f < named.size(); ++f) lost += named[f] == meshed[f];
  expect(lost == 0, "faces neither meshed nor named, or both", lost);
  expect(test::vertex_error_mm(result.mesh) <= 1e-9, "vertices off the surface, mm",
         test::vertex_error_mm(result.mesh));
  const double chord_error = test::chord_error_mm(result.mesh);
  if (complete) {
    expect(result.unmeshed.empty(), "faces not meshed", static_cast<double>(result.unmeshed.size()));
    expect(chord_error <= options.chord_mm, "chord error, mm", chord_error);
  } else {
    std::printf("   chord error, mm: %g\n", chord_error);
  }
  expect(!result.mesh.arrays().triangles.empty(), "triangles",
         static_cast<double>(result.mesh.triangle_count()));
  return wrong;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::printf("CATOPTRA_CORPUS is not set: no file of the corpus was tessellated\n");
    return kSkipped;
  }
  try {
    return check(cad_import::import_cad(argv[1]), argc > 2) == 0 ? 0 : 1;
  } catch (const cad_import::ImportError& error) {
    // Whether a file must import is cad_import's test; here it only has no face to mesh.
    std::printf("no faces: %s\n", error.what());
    return 0;
  }
}
