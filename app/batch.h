// Thousands of evaluations in one go: a plan (TOML, docs/batch.md) says which, each is done once, and an
// SQLite database keeps the results.
//
// A case is a pure function: its inputs - everything that has a say, files by the hash of their content -
// give named numbers or an error, the same on every thread, in every order and in every process of the same
// build. So a case may be computed anywhere (another process, another machine), handed around as one line of
// JSON, and put into the database by whoever owns it.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace catoptra::app {

/// One thing to compute.
struct BatchCase {
  std::string key;     ///< SHA-256 of `inputs`, 64 lower-case hexadecimal digits
  std::string inputs;  ///< a JSON object on one line: keys sorted, numbers in their shortest form
  std::string source;  ///< absolute path of the file that `inputs` names by hash, or empty; not in the key
};

/// {"inputs": {...}, "key": "...", "source": "..."} on one line.
[[nodiscard]] std::string to_json(const BatchCase& batch_case);

/// Back again. Throws catoptra::Error where `line` is no case, or its key is not that of its inputs.
[[nodiscard]] BatchCase case_from_json(std::string_view line);

/// The value of a quantity that a case does not have (a ray that does not get through): null in JSON and
/// SQLite, empty in CSV.
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// What came of a case: numbers as batch_columns() names them, or an error.
struct BatchResult {
  std::string key;
  std::string error;            ///< empty: done. One line, without the file's path
  std::vector<double> summary;  ///< one per summary column; empty where it failed
  std::vector<double> points;   ///< row by row, one value per point column; finite or kNoValue
};

/// {"error": null, "key": "...", "points": [[...], ...], "summary": [...]} on one line, doubles in their
/// shortest form that reads back as the same double.
[[nodiscard]] std::string to_json(const BatchResult& result);

/// Back again, bit for bit. Throws catoptra::Error where `line` is no result of this version.
[[nodiscard]] BatchResult result_from_json(std::string_view line);

/// Names of the numbers, each with its unit: _d dioptre, _pd prism dioptre, _deg, _mm, _percent.
struct BatchColumns {
  std::vector<std::string> summary, points;
};
[[nodiscard]] const BatchColumns& batch_columns();

/// A plan with its cases, each once, in the plan's order.
struct BatchPlan {
  std::string file, text;
  std::vector<BatchCase> cases;
  std::size_t repeated = 0;  ///< cases that the plan holds more than once
};

/// Reads a plan and hashes every lens file that it names; paths in it start at its folder. "-" reads standard
/// input. Throws catoptra::Error with file, line and key.
[[nodiscard]] BatchPlan read_batch_plan(const std::filesystem::path& file);
[[nodiscard]] BatchPlan read_batch_plan_text(std::string_view text, const std::string& name,
                                             const std::filesystem::path& folder);

/// Computes one case. Whatever is wrong with it becomes BatchResult::error; only running out of memory
/// throws.
[[nodiscard]] BatchResult evaluate_case(const BatchCase& batch_case);

/// The same, from one line of JSON to another, for workers. Keeps the last lens of the calling thread.
/// Throws as case_from_json.
[[nodiscard]] std::string evaluate_case(std::string_view line);

/// The results of one or more plans on disk, open for writing by this process alone. A process that is killed
/// at any moment leaves a database with every result whose put() has returned, and nothing half done.
class BatchStore {
 public:
  /// Opens the database, or makes it where there is none. Throws catoptra::Error where another process writes
  /// it, it is none of ours or damaged, or the place cannot be written.
  explicit BatchStore(const std::filesystem::path& file);
  ~BatchStore();
  BatchStore(const BatchStore&) = delete;
  BatchStore& operator=(const BatchStore&) = delete;

  /// Enters the cases that are not there yet as pending, in one transaction. Returns how many.
  std::size_t add(const BatchPlan& plan);

  /// Those of the plan that have neither result nor error yet, in its order. add() comes first.
  [[nodiscard]] std::vector<BatchCase> pending(const BatchPlan& plan);

  /// Makes failed cases of the plan pending again. Returns how many.
  std::size_t forget_failures(const BatchPlan& plan);

  /// Stores a result in one transaction. A result that is there already stays, so that a case may be computed
  /// twice. Throws catoptra::Error for a key that add() has not entered, and where the disk does not take it.
  void put(const BatchResult& result);

  [[nodiscard]] const std::filesystem::path& file() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct BatchProgress {
  std::size_t done = 0, failed = 0;  ///< in this run
  std::size_t wanted = 0;            ///< of this run
  double seconds = 0;                ///< since it began
};

struct BatchRunOptions {
  std::size_t jobs = 0;  ///< threads; 0: all. Results do not depend on it.
  /// Called after every result, from one thread at a time.
  std::function<void(const BatchProgress&)> progress;
  /// Becomes true from outside: no further case is begun, those in hand are finished and stored, and
  /// run_batch() returns with fewer than were wanted. Null: never.
  const std::atomic<bool>* stop = nullptr;
};

/// Computes what is pending of `plan`, on all cores, and puts it into `store`; add() is called first. Throws
/// catoptra::Error where the store cannot be written; what was stored before that stays.
BatchProgress run_batch(const BatchPlan& plan, BatchStore& store, const BatchRunOptions& options = {});

}  // namespace catoptra::app
