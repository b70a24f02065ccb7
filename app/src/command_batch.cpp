// catoptra batch run, status, export, report
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/batch.h"
#include "app/src/batch_export.h"
#include "app/src/batch_report.h"
#include "app/src/batch_store.h"
#include "app/src/commands.h"
#include "app/src/output_file.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

struct RunOptions {
  std::string plan, database;
  int jobs = 0;
  bool retry_failed = false, strict = false, list = false;
};

struct StatusOptions {
  std::string database;
  bool json = false;
};

struct ExportOptions {
  std::string database, output;
  bool points = false;
};

struct ReportOptions {
  std::string database, output;
  int rows = int(BatchReportOptions{}.rows), maps = int(BatchReportOptions{}.maps);
};

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + ' ' + noun + (count == 1 ? "" : "s");
}

/// "1:02:03", or "2:03".
std::string clock_text(double seconds) {
  const auto whole = static_cast<long>(std::min(seconds, 3.6e7));
  char text[32];
  if (whole >= 3600)
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  return text;
}

void show(Progress& line, const BatchProgress& p) {
  const double finished = double(p.done + p.failed), rate = finished / std::max(p.seconds, 1e-9);
  char text[96];
  std::snprintf(text, sizeof text, "%zu of %zu cases, %.3g a second, %s left%s", p.done + p.failed, p.wanted,
                rate, clock_text((double(p.wanted) - finished) / rate).c_str(),
                p.failed ? (", " + std::to_string(p.failed) + " failed").c_str() : "");
  line.show(finished / double(std::max<std::size_t>(p.wanted, 1)), text);
}

int list_cases(const BatchPlan& plan) {
  for (const BatchCase& batch_case : plan.cases) std::cout << to_json(batch_case) << '\n';
  return std::cout.flush() ? kExitDone : throw Error("standard output", "", "cannot be written");
}

std::string summary(const BatchPlan& plan, const BatchProgress& ran, const BatchCounts& all,
                    const std::string& file) {
  std::string text = counted(plan.cases.size(), "case") + " in the plan";
  if (plan.repeated) text += " (" + std::to_string(plan.repeated) + " more are repetitions)";
  if (ran.wanted == 0)
    text += "; all are in " + file + " already, nothing to do\n";
  else
    text +=
        ", " + std::to_string(ran.wanted) + " computed, " + std::to_string(ran.failed) + " of them failed\n";
  return text + file + ": " + std::to_string(all.done) + " done, " + std::to_string(all.failed) +
         " failed, " + std::to_string(all.pending) + " pending\n";
}

int run_run(const RunOptions& options, const CommonOptions& common) {
  if (options.database.empty() && !options.list)
    throw UsageError("--db is required", "the database for the results, or --list");
  const BatchPlan plan = read_batch_plan(options.plan);
  if (options.list) return list_cases(plan);
  BatchProgress ran;
  {
    BatchStore store(options.database);
    if (options.retry_failed) store.forget_failures(plan);
    Progress line(!common.no_progress);
    BatchRunOptions running;
    running.jobs = std::size_t(options.jobs);
    double shown = -1;
    running.progress = [&](const BatchProgress& p) {
      if (p.seconds - shown < 0.1) return;  // often enough for an eye
      shown = p.seconds;
      show(line, p);
    };
    ran = run_batch(plan, store, running);
  }
  const BatchCounts all = BatchReader(options.database).counts();
  write_text("-", summary(plan, ran, all, options.database));
  return options.strict && all.failed > 0 ? kExitCheckFailed : kExitDone;
}

int run_status(const StatusOptions& options) {
  BatchReader reader(options.database);
  const BatchCounts counts = reader.counts();
  const auto failures = reader.failures();
  if (options.json) {
    nlohmann::ordered_json report = {{"cases", counts.all()},
                                     {"done", counts.done},
                                     {"failed", counts.failed},
                                     {"pending", counts.pending}};
    report["failures"] = nlohmann::json::array();
    for (const FailureReason& reason : failures)
      report["failures"].push_back({{"count", reason.count}, {"example", reason.example}});
    report["plans"] = nlohmann::json::array();
    for (const StoredPlan& plan : reader.plans())
      report["plans"].push_back({{"file", plan.file}, {"sha256", plan.sha256}, {"version", plan.version}});
    write_text("-", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    return kExitDone;
  }
  std::string text = counted(counts.all(), "case") + ": " + std::to_string(counts.done) + " done, " +
                     std::to_string(counts.failed) + " failed, " + std::to_string(counts.pending) +
                     " pending\n";
  for (const FailureReason& reason : failures)
    text += "failed " + std::to_string(reason.count) + " x: " + reason.example + "\n";
  write_text("-", text);
  return kExitDone;
}

int run_export(const ExportOptions& options) {
  const std::filesystem::path output = options.output;
  const bool as_json = output.extension() == ".json";
  if (output != "-" && !as_json && output.extension() != ".csv")
    throw UsageError("batches are exported as .csv or .json, not as '" + options.output + "'");
  BatchReader reader(options.database);
  const ExportRows rows = options.points ? ExportRows::points : ExportRows::cases;
  const auto write = [&](std::ostream& out) {
    as_json ? export_json(reader, rows, out) : export_csv(reader, rows, out);
    out.flush();
    if (!out) throw Error(options.output, "", "cannot be written", "is there room, and may you write there?");
  };
  if (output == "-")
    write(std::cout);
  else
    write_renamed(output, [&](const std::filesystem::path& temporary) {
      std::ofstream out(temporary, std::ios::binary);
      write(out);
    });
  return kExitDone;
}

int run_report(const ReportOptions& options) {
  BatchReader reader(options.database);
  BatchReportOptions report;
  report.rows = std::size_t(options.rows);
  report.maps = std::size_t(options.maps);
  write_text(options.output,
             batch_page(reader, std::filesystem::path(options.database).filename().string(), report));
  return kExitDone;
}

void add_database(CLI::App& app, std::string& database, bool required) {
  app.add_option("--db", database, "SQLite database of the batch")
      ->required(required)
      ->option_text("RESULTS.sqlite");
}

}  // namespace

std::vector<Command> add_batch_commands(CLI::App& root, CommonOptions& common) {
  CLI::App* batch = add_subcommand(root, common, "batch", "Evaluate thousands of lenses by a plan");
  batch->require_subcommand(0, 1);

  auto running = std::make_shared<RunOptions>();
  CLI::App* run =
      add_subcommand(*batch, common, "run",
                     "Compute what a plan asks for and the database does not have yet; killed at any "
                     "moment, the same command goes on from there");
  run->add_option("PLAN", running->plan, "Plan (TOML); - reads standard input")->required();
  add_database(*run, running->database, false);
  run->add_option("--jobs", running->jobs, "Threads; 0: one per core")
      ->check(CLI::Range(0, 4096))
      ->option_text("N");
  run->add_flag("--retry-failed", running->retry_failed, "Compute failed cases of the plan again");
  run->add_flag("--strict", running->strict, "Exit with 3 where a case of the database has failed");
  run->add_flag("--list", running->list, "Print the cases, one line of JSON each, and compute nothing");

  auto asking = std::make_shared<StatusOptions>();
  CLI::App* status =
      add_subcommand(*batch, common, "status", "Count cases and errors, also while a batch runs");
  add_database(*status, asking->database, true);
  status->add_flag("--json", asking->json, "Print JSON");

  auto exporting = std::make_shared<ExportOptions>();
  CLI::App* out = add_subcommand(*batch, common, "export", "Write results as CSV or JSON");
  add_database(*out, exporting->database, true);
  out->add_option("-o,--output", exporting->output,
                  "File to write, .csv or .json; - writes CSV to standard output")
      ->required()
      ->option_text("FILE");
  out->add_flag("--points", exporting->points,
                "One row per point of the lenses; in JSON the points within the cases");

  auto reporting = std::make_shared<ReportOptions>();
  CLI::App* report = add_subcommand(
      *batch, common, "report", "Write a page with summary, plots, maps and all cases, to open in a browser");
  add_database(*report, reporting->database, true);
  report->add_option("-o,--output", reporting->output, "Page to write; - : standard output")
      ->required()
      ->option_text("R.html");
  report->add_option("--rows", reporting->rows, "At most so many cases in the table (default 5000)")
      ->check(CLI::Range(0, 1000000))
      ->option_text("N");
  report->add_option("--maps", reporting->maps, "At most so many lenses with maps (default 100)")
      ->check(CLI::Range(0, 1000000))
      ->option_text("N");
  return {{run, [running, &common] { return run_run(*running, common); }},
          {status, [asking] { return run_status(*asking); }},
          {out, [exporting] { return run_export(*exporting); }},
          {report, [reporting] { return run_report(*reporting); }}};
}

}  // namespace catoptra::app
