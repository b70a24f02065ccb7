// catoptra info FILE... [--json]
#include <cstdio>
#include <memory>

#include "app/src/commands.h"
#include "app/src/file_report.h"
#include "app/src/one_line.h"
#include "app/src/output_file.h"
#include "app/src/report.h"
#include "cad_import/import.h"

namespace catoptra::app {
namespace {

struct InfoOptions {
  std::vector<std::string> files;
  std::string unit;
  bool json = false;
};

nlohmann::ordered_json describe(const std::string& file, const InfoOptions& options, Progress& progress) {
  cad_import::ImportOptions import;
  if (!options.unit.empty()) import.unit = options.unit;
  import.progress = [&](double share, std::string_view stage) {
    progress.show(share, file + ": " + std::string(stage));
};
if (cad_import::is_cad(cad_import::sniff_format(file))) return cad_json(cad_import::import_cad(file, import));
return mesh_json(cad_import::import_mesh(file, import));
}  // namespace

/// A file that fails hides none of the others: its error is told, and the exit code says so at the end.
int run_info(const InfoOptions& options, const CommonOptions& common) {
  if (!options.unit.empty() && !cad_import::unit_in_mm(options.unit))
    throw UsageError("unknown unit '" + options.unit + "'", "known: mm, cm, m, in");
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  bool failed = false;
  Progress progress(!common.no_progress);
  for (const std::string& file : options.files) {
    try {
      const auto description = describe(file, options, progress);
      progress.clear();
      if (options.json)
        files.push_back(description);
      else
        write_text("-", plain_text(description));
    } catch (const Error& error) {
      progress.clear();
      failed = true;
      std::fprintf(stderr, "catoptra: %s\n", one_line(error.what()).c_str());
      files.push_back({{"file", file}, {"error", error.what()}});
    }
  }
  if (options.json) write_text("-", json_text({{"files", files}}));
  return failed ? kExitFailed : kExitDone;
}

}  // namespace catoptra::app

Command add_info_command(CLI::App& root, CommonOptions& common) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* app = add_subcommand(root, common, "info",
                                 "Say what CAD and mesh files hold: bodies, faces, sizes, materials");
  app->add_option("FILE", options->files, "STEP, IGES, BREP, FreeCAD (.FCStd), glTF, OBJ, STL or PLY")
      ->required();
  app->add_option("--unit", options->unit, "Length unit of the files' numbers, in place of their own")
      ->option_text("UNIT");
  app->add_flag("--json", options->json, "Print JSON");
  return {app, [options, &common] { return run_info(*options, common); }};
}

}  // namespace catoptra::app
