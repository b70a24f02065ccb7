// What a batch database holds, for status, export and reports. docs/batch.md describes its tables.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/batch.h"

namespace catoptra::app {

enum class CaseStatus { pending, done, failed };
[[nodiscard]] std::string_view status_name(CaseStatus status);

struct BatchCounts {
  std::size_t pending = 0, done = 0, failed = 0;
  [[nodiscard]] std::size_t all() const { return pending + done + failed; }
};

/// Failed cases whose errors differ by their numbers only.
struct FailureReason {
  std::string example;  ///< the first of them
  std::size_t count = 0;
};

/// A plan whose cases are in the database.
struct StoredPlan {
  std::string file, text, sha256, version;  ///< version of Catoptra that entered it
};

/// A case as stored, in the order of the plans.
struct StoredCase {
  std::int64_t position = 0;  ///< from 1
  BatchCase batch_case;
  CaseStatus status = CaseStatus::pending;
  std::string error;
  std::vector<double> summary;  ///< as batch_columns().summary; empty unless done
};

/// A batch database as it is at the moment of opening; a run may go on writing to it meanwhile. For one
/// thread.
class BatchReader {
 public:
  /// Throws catoptra::Error where there is no such file, or it is no batch database of this version.
  explicit BatchReader(const std::filesystem::path& file);
  ~BatchReader();
  BatchReader(const BatchReader&) = delete;
  BatchReader& operator=(const BatchReader&) = delete;

  [[nodiscard]] BatchCounts counts();
  /// Most frequent first.
  [[nodiscard]] std::vector<FailureReason> failures();
  [[nodiscard]] std::vector<StoredPlan> plans();
  void for_each_case(const std::function<void(const StoredCase&)>& visit);
  /// Row by row as BatchResult::points; empty where there are none.
  [[nodiscard]] std::vector<double> points(std::int64_t position);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptra::app
