// Imports one file of the corpus and holds it to its line of the table of expectations.
//   corpus_check TABLE CORPUS FILE   one file, named from the corpus folder
//   corpus_check TABLE CORPUS        the table as a whole: every file it names is there, and it names one at
//   least corpus_check                     the corpus is absent: says so and exits with 77, which CTest shows
//   as skipped
// Exit 0: as expected; 1: not; 2: wrong usage.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cad_import/import.h"
#include "cad_import/lens_faces.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#include <IGESControl_Controller.hxx>
#include <STEPCAFControl_Controller.hxx>
#endif

namespace {

/// OpenCASCADE makes its tables of translator parameters once per process and never frees them: 157
/// allocations, 3,328 bytes, whatever the file. Made here first, they are no leak; whatever leaks later is
/// one.
void make_kernel_tables() {
#ifdef __SANITIZE_ADDRESS__
  const __lsan::ScopedDisabler not_counted;
  STEPCAFControl_Controller::Init();
  IGESControl_Controller::Init();
#endif
}

namespace fs = std::filesystem;
using namespace catoptra::cad_import;

constexpr int kSkipped = 77;

/// One line of the table. A number that is "-" there is not held.
struct Expectation {
  std::string file;
  std::string outcome;  // "cad", "mesh" or "error"
  std::array<std::optional<double>, 3> size_mm;
  std::optional<double> tolerance_mm;
  std::optional<double> solids, faces, triangles;
  std::string reason;  // "error": part of the message; others: part of some warning
  // Lenses only: coordinate axis, thickness along it, mean curvatures of front and back at the vertices.
  std::string lens_axis;
  std::optional<double> lens_thickness_mm, lens_front_curvature, lens_back_curvature;
};

/// What an import gave.
struct Found {
  BoundingBox bounds;
  double solids = 0, faces = 0, triangles = 0;
  std::vector<std::string> warnings;
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, '\t');) fields.push_back(field == "-" ? "" : field);
  fields.resize(15);
  return fields;
}

std::optional<double> number(const std::string& field) {
  if (field.empty()) return std::nullopt;
  return std::stod(field);
}

std::vector<Expectation> read_table(const fs::path& table) {
  std::ifstream stream(table);
  std::vector<Expectation> lines;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> f = split(line);
    lines.push_back({f[0],
                     f[1],
                     {number(f[2]), number(f[3]), number(f[4])},
                     number(f[5]),
                     number(f[6]),
                     number(f[7]),
                     number(f[8]),
                     f[9],
                     f[11],
                     number(f[12]),
                     number(f[13]),
                     number(f[14])});
  }
  return lines;
}

/// Every exact face can be evaluated in the middle of its domain.
void check_surfaces(const CadModel& model, std::vector<std::string>& complaints) {
  for (const Face& face : model.faces) {
    const ParameterDomain d = face.surface->domain();
    const double u = 0.5 * (d.u_min + d.u_max), v = 0.5 * (d.v_min + d.v_max);
    const glm::dvec3 point = face.surface->point(u, v), normal = face.surface->unit_normal(u, v);
    const double length = std::sqrt(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z);
    if (!std::isfinite(point.x + point.y + point.z) || std::abs(length - 1) > 1e-9)
      complaints.push_back("face " + std::to_string(face.index) + " cannot be evaluated in its middle");
  }
}

void compare(const std::string& what, const std::optional<double>& expected, double found, double tolerance,
             std::vector<std::string>& complaints) {
  if (!expected || std::abs(*expected - found) <= tolerance) return;
  std::ostringstream text;
  text << what << ": " << found << " instead of " << *expected;
  complaints.push_back(text.str());
}

/// The table quotes thicknesses to 0.001 mm and curvatures to 1e-6 / mm.
void check_lens(const CadModel& model, const Expectation& expected, std::vector<std::string>& complaints) {
  if (expected.lens_axis.empty()) return;
  const LensGeometry lens = recognise_lens(model).geometry;
  const int axis = expected.lens_axis[0] - 'x';
  compare("lens axis along " + expected.lens_axis, 1, std::abs(lens.axis[axis]), 1e-9, complaints);
  compare("lens thickness", expected.lens_thickness_mm, lens.center_thickness_mm, 1e-3, complaints);
  const auto mean = [](const PrincipalCurvatures& k) { return 0.5 * (k.k1 + k.k2); };
  compare("front curvature", expected.lens_front_curvature, mean(lens.front_curvature), 1e-6, complaints);
  compare("back curvature", expected.lens_back_curvature, mean(lens.back_curvature), 1e-6, complaints);
}

double squared(const glm::dvec3& v) {
  return v.x * v.x + v.y * v.y + v.z * v.z;
}

/// Parameters of the point of the face nearest to `wanted`, by ever finer grids around the best so far.
glm::dvec2 nearest_on_face(const Face& face, const glm::dvec3& wanted) {
  constexpr int kSteps = 100, kRounds = 12;
  const ParameterDomain d = face.surface->domain();
  glm::dvec2 best(0.5 * (d.u_min + d.u_max), 0.5 * (d.v_min + d.v_max));
  double u_span = d.u_max - d.u_min, v_span = d.v_max - d.v_min, nearest = 1e300;
  for (int round = 0; round < kRounds; ++round, u_span *= 0.1, v_span *= 0.1) {
    const glm::dvec2 around = best;
    for (int i = 0; i <= kSteps; ++i)
      for (int k = 0; k <= kSteps; ++k) {
        const glm::dvec2 uv(std::clamp(around.x + u_span * (double(i) / kSteps - 0.5), d.u_min, d.u_max),
                            std::clamp(around.y + v_span * (double(k) / kSteps - 0.5), d.v_min, d.v_max));
        const double distance = squared(face.surface->point(uv.x, uv.y) - wanted);
        if (distance < nearest && face.trim->contains(uv.x, uv.y)) {
          nearest = distance;
          best = uv;
        }
      }
  }
  return best;
}

/// Holds the faces of `model` to the lines for `name` in the table of points.
void check_points(const CadModel& model, const fs::path& table, const std::string& name,
                  std::vector<std::string>& complaints) {
  std::ifstream stream(table);
  for (std::string line; std::getline(stream, line);) {
    const std::vector<std::string> f = split(line);
    if (line.empty() || line.front() == '#' || f[0] != name) continue;
    const auto face = std::ranges::find(model.faces, f[1], &Face::name);
    if (face == model.faces.end()) {
      complaints.push_back("no face is called \"" + f[1] + "\"");
      continue;
    }
    const glm::dvec3 wanted(std::stod(f[2]), std::stod(f[3]), std::stod(f[4]));
    const glm::dvec2 uv = nearest_on_face(*face, wanted);
    const glm::dvec3 apart = face->surface->point(uv.x, uv.y) - wanted;
    const std::string place = f[1] + " at " + f[2] + ", " + f[3] + ", " + f[4];
    compare("distance of " + place, 0, std::sqrt(squared(apart)), number(f[5]).value_or(0), complaints);
    const PrincipalCurvatures k = face->surface->principal_curvatures(uv.x, uv.y);
    compare("curvature of " + place, number(f[6]), std::max(std::abs(k.k1), std::abs(k.k2)),
            number(f[7]).value_or(0), complaints);
  }
}

Found import_file(const fs::path& file, const Expectation& expected, const fs::path& points,
                  std::vector<std::string>& complaints) {
  const std::string& outcome = expected.outcome;
  if (outcome == "mesh" || (outcome == "error" && !is_cad(sniff_format(file)))) {
    const TriangleMesh mesh = import_mesh(file);
    return {mesh.bounds, 0, 0, static_cast<double>(mesh.triangles.size()), mesh.warnings};
  }
  const CadModel model = import_cad(file);
  check_surfaces(model, complaints);
  check_lens(model, expected, complaints);
  check_points(model, points, expected.file, complaints);
  const auto solids =
      std::count_if(model.bodies.begin(), model.bodies.end(), [](const Body& b) { return b.solid; });
  return {model.bounds, static_cast<double>(solids), static_cast<double>(model.faces.size()), 0,
          model.warnings};
}

void compare(const Expectation& expected, const Found& found, std::vector<std::string>& complaints) {
  for (int axis = 0; axis < 3; ++axis)
    compare(std::string("size in ") + "xyz"[axis], expected.size_mm[static_cast<std::size_t>(axis)],
            found.bounds.max[axis] - found.bounds.min[axis], expected.tolerance_mm.value_or(0), complaints);
  compare("solids", expected.solids, found.solids, 0, complaints);
  compare("faces", expected.faces, found.faces, 0, complaints);
  compare("triangles", expected.triangles, found.triangles, 0, complaints);
  const auto says = [&](const std::string& warning) {
    return warning.find(expected.reason) != std::string::npos;
  };
  if (!expected.reason.empty() && std::none_of(found.warnings.begin(), found.warnings.end(), says))
    complaints.push_back("no warning says \"" + expected.reason + "\"");
}

void compare_error(const Expectation& expected, const fs::path& file, const std::string& message,
                   std::vector<std::string>& complaints) {
  std::cout << "error: " << message << "\n";
  if (expected.outcome != "error") complaints.emplace_back("an import was expected, not an error");
  if (message.find('\n') != std::string::npos) complaints.emplace_back("the error is more than one line");
  if (message.rfind(file.string(), 0) != 0) complaints.emplace_back("the error does not name the file");
  if (expected.outcome == "error" && message.find(expected.reason) == std::string::npos)
    complaints.push_back("the error does not say \"" + expected.reason + "\"");
}

int check_file(const std::vector<Expectation>& table, const fs::path& points, const fs::path& corpus,
               const std::string& name) {
  const auto line =
      std::find_if(table.begin(), table.end(), [&](const Expectation& e) { return e.file == name; });
  Expectation expected;
  std::vector<std::string> complaints;
  if (line != table.end())
    expected = *line;
  else
    complaints.emplace_back("the file is not in the table of expectations");
  const fs::path file = corpus / name;
  try {
    if (expected.outcome.empty()) expected.outcome = is_cad(sniff_format(file)) ? "cad" : "mesh";
    const Found found = import_file(file, expected, points, complaints);
    const glm::dvec3 size = found.bounds.max - found.bounds.min;
    std::cout.precision(10);
    std::cout << "size " << size.x << " x " << size.y << " x " << size.z << " mm, " << found.solids
              << " solids, " << found.faces << " faces, " << found.triangles << " triangles\n";
    for (const std::string& warning : found.warnings) std::cout << "warning: " << warning << "\n";
    if (expected.outcome == "error") complaints.emplace_back("an error was expected, not an import");
    compare(expected, found, complaints);
  } catch (const ImportError& error) {
    compare_error(expected, file, error.what(), complaints);
  }
  for (const std::string& complaint : complaints) std::cout << name << ": " << complaint << "\n";
  return complaints.empty() ? 0 : 1;
}

int check_table(const std::vector<Expectation>& table, const fs::path& corpus) {
  if (table.empty()) std::cout << "the table of expectations is empty\n";
  bool complete = !table.empty();
  for (const Expectation& line : table) {
    if (fs::is_regular_file(corpus / line.file)) continue;
    std::cout << line.file << ": in the table but not in the corpus\n";
    complete = false;
  }
  return complete ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.empty()) {
    std::cout << "CATOPTRA_CORPUS is not set: no file of the corpus was tested\n";
    return kSkipped;
  }
  if (arguments.size() < 2 || arguments.size() > 3) return 2;
  make_kernel_tables();
  const std::vector<Expectation> table = read_table(arguments[0]);
  return arguments.size() == 2
             ? check_table(table, arguments[1])
             : check_file(table, fs::path(arguments[0]).replace_filename("corpus_points.tsv"), arguments[1],
                          arguments[2]);
}
