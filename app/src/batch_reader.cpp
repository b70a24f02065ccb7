// Questions to a batch database.
#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "app/src/batch_schema.h"
#include "app/src/batch_store.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

constexpr std::array<std::string_view, 3> kStatus{"pending", "done", "failed"};

/// `text` with every number as '#': what errors have in common.
std::string without_numbers(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool digit = std::isdigit(static_cast<unsigned char>(text[i])) != 0;
    const bool inside = !result.empty() && result.back() == '#' &&
                        (digit || (text[i] == '.' && i + 1 < text.size() &&
                                   std::isdigit(static_cast<unsigned char>(text[i + 1]))));
    if (inside) continue;
    result += digit ? '#' : text[i];
  }
  return result;
}

/// With every case of the file as it is now.
SqliteDatabase open_for_reading(const std::filesystem::path& file) {
  std::error_code failure;
  if (!std::filesystem::exists(file, failure))
    throw Error(file.string(), "", "does not exist",
                "'catoptra batch run PLAN.toml --db " + file.string() + "' makes it");
  if (std::filesystem::is_directory(file, failure))
    throw Error(file.string(), "", "is a folder, not a database", "name a file in it");
  SqliteDatabase database(file, SqliteAccess::read);
  if (database_kind(database, file) == DatabaseKind::empty)
    throw Error(file.string(), "", "holds no batch", "'catoptra batch run' fills it");
  database.execute("BEGIN");
  (void)database.number(
      "SELECT count(*) FROM plans");  // from here on the file stands still for this connection
  return database;
}

}  // namespace

std::string_view status_name(CaseStatus status) {
  return kStatus[std::size_t(status)];
}

struct BatchReader::Impl {
  SqliteDatabase database;
  SqliteStatement points;

  explicit Impl(const std::filesystem::path& file)
      : database(open_for_reading(file)),
        points(database, "SELECT " + column_list(batch_columns().points) +
                             " FROM points WHERE position = ? ORDER BY point") {}
};

BatchReader::BatchReader(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) {}
BatchReader::~BatchReader() = default;

BatchCounts BatchReader::counts() {
  BatchCounts counts;
  SqliteStatement statement(impl_->database, "SELECT status, count(*) FROM cases GROUP BY status");
  while (statement.step()) {
    const std::string status = statement.text(0);
    auto& count = status == kStatus[0] ? counts.pending : status == kStatus[1] ? counts.done : counts.failed;
    count = std::size_t(statement.integer(1));
  }
  return counts;
}

std::vector<FailureReason> BatchReader::failures() {
  std::vector<FailureReason> reasons;
  std::map<std::string, std::size_t> index;
  SqliteStatement statement(impl_->database,
                            "SELECT error FROM cases WHERE status = 'failed' ORDER BY position");
  while (statement.step()) {
    const std::string error = statement.text(0);
    const auto [found, added] = index.emplace(without_numbers(error), reasons.size());
    if (added) reasons.push_back({error, 0});
    ++reasons[found->second].count;
  }
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const FailureReason& a, const FailureReason& b) { return a.count > b.count; });
  return reasons;
}

std::vector<StoredPlan> BatchReader::plans() {
  std::vector<StoredPlan> plans;
  SqliteStatement statement(impl_->database, "SELECT file, text, sha256, version FROM plans ORDER BY rowid");
  while (statement.step())
    plans.push_back({statement.text(0), statement.text(1), statement.text(2), statement.text(3)});
  return plans;
}

void BatchReader::for_each_case(const std::function<void(const StoredCase&)>& visit) {
  const auto& names = batch_columns().summary;
  SqliteStatement statement(
      impl_->database,
      "SELECT c.position, key, inputs, source, status, error, " + column_list(names, "r.") +
          " FROM cases c LEFT JOIN results r ON r.position = c.position ORDER BY c.position");
  while (statement.step()) {
    StoredCase row;
    row.position = statement.integer(0);
    row.batch_case = {statement.text(1), statement.text(2), statement.text(3)};
    const std::string status = statement.text(4);
    row.status = static_cast<CaseStatus>(std::find(kStatus.begin(), kStatus.end(), status) - kStatus.begin());
    row.error = statement.text(5);
    if (row.status == CaseStatus::done)
      for (std::size_t i = 0; i < names.size(); ++i) row.summary.push_back(statement.real(int(i) + 6));
    visit(row);
  }
}

std::vector<double> BatchReader::points(std::int64_t position) {
  SqliteStatement& statement = impl_->points;
  std::vector<double> values;
  statement.reset();
  statement.bind(0, position);
  while (statement.step())
    for (std::size_t i = 0; i < batch_columns().points.size(); ++i) values.push_back(statement.real(int(i)));
  statement.reset();
  return values;
}

}  // namespace catoptra::app
