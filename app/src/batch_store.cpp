// A batch database open for writing.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <unordered_set>

#include "app/batch.h"
#include "app/src/batch_schema.h"
#include "app/src/file_hash.h"
#include "app/src/sqlite.h"
#include "app/version.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

/// Databases up to this size are checked page by page when they are opened (about a second); of larger ones
/// damage shows where it is met.
constexpr std::uintmax_t kChecked_bytes = 256u << 20;

/// Keeps other processes out while it lives. The lock is the kernel's and ends with the process, however it
/// ends; the file beside the database only carries it.
class WriterLock {
 public:
  /// Under whichever name the database is known.
  explicit WriterLock(const std::filesystem::path& database)
      : path_(std::filesystem::weakly_canonical(database).string() + ".lock") {
    // A file that its last owner removed meanwhile carries no lock that anybody else would see.
    while (!take(database)) release();
  }
  ~WriterLock() {
    unlink(path_.c_str());
    release();
  }
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

 private:
  bool take(const std::filesystem::path& database) {
    descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
      throw Error(database.string(), "", "cannot be written here: " + std::string(std::strerror(errno)),
                  "does the folder exist, and may you write there?");
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int failure = errno;
      release();
      if (failure != EWOULDBLOCK)
        throw Error(database.string(), "", "cannot be locked: " + std::string(std::strerror(failure)),
                    "choose a folder on a local disk");
      throw Error(database.string(), "", "another 'batch run' is writing this database",
                  "wait for it, or give another name");
    }
    struct stat held {
    }, named{};
    return fstat(descriptor_, &held) == 0 && stat(path_.c_str(), &named) == 0 &&
           held.st_ino == named.st_ino && held.st_dev == named.st_dev;
  }
  void release() {
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = -1;
  }

  std::string path_;
  int descriptor_ = -1;
};

std::string placeholders(std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += i ? ", ?" : "?";
  return text;
}

/// Ready for writing, with its tables.
SqliteDatabase open_for_writing(const std::filesystem::path& file) {
  std::error_code failure;
  if (std::filesystem::is_directory(file, failure))
    throw Error(file.string(), "", "is a folder, not a database", "name a file in it");
  SqliteDatabase database(file, SqliteAccess::write);
  const DatabaseKind kind = database_kind(database, file);
  // Commits append to a log: no reader waits and a killed process loses nothing that was committed. (After a
  // loss of power the last commits may be missing; they are computed again.)
  database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL");
  const auto size = std::filesystem::file_size(file, failure);
  if (kind == DatabaseKind::empty) {
    make_tables(database);
  } else if (!failure && size <= kChecked_bytes) {
    const std::string verdict = database.text("PRAGMA quick_check(1)");
    if (verdict != "ok")
      throw Error(file.string(), "", "is damaged: " + verdict,
                  "give another name, or save what can be saved with sqlite3 '.recover'");
  }
  return database;
}

}  // namespace

struct BatchStore::Impl {
  std::filesystem::path file;
  WriterLock lock;  // before the database is touched, until it is closed
  SqliteDatabase database;
  SqliteStatement finish, known, summary, point;

  explicit Impl(const std::filesystem::path& path)
      : file(path),
        lock(path),
        database(open_for_writing(path)),
        finish(
            database,
            "UPDATE cases SET status = ?, error = ? WHERE key = ? AND status = 'pending' RETURNING position"),
        known(database, "SELECT count(*) FROM cases WHERE key = ?"),
        summary(database, "INSERT INTO results (position, " + column_list(batch_columns().summary) +
                              ") VALUES (?, " + placeholders(batch_columns().summary.size()) + ")"),
        point(database, "INSERT INTO points (position, point, " + column_list(batch_columns().points) +
                            ") VALUES (?, ?, " + placeholders(batch_columns().points.size()) + ")") {}

  /// The position of a pending case that is so no longer; nullopt where it has a result already.
  std::optional<std::int64_t> take(const BatchResult& result) {
    finish.reset();
    finish.bind(0, std::string_view(result.error.empty() ? "done" : "failed"));
    if (result.error.empty())
      finish.bind_null(1);
    else
      finish.bind(1, std::string_view(result.error));
    finish.bind(2, std::string_view(result.key));
    if (finish.step()) {
      const std::int64_t position = finish.integer(0);
      finish.run();
      return position;
    }
    finish.reset();
    known.reset();
    known.bind(0, std::string_view(result.key));
    const bool there = known.step() && known.integer(0) > 0;
    known.reset();
    if (!there)
      throw Error(file.string(), "case " + result.key, "is not in this database", "enter its plan first");
    return std::nullopt;
  }

  std::unordered_set<std::string> keys_with(const std::string& status) {
    std::unordered_set<std::string> keys;
    SqliteStatement statement(database, "SELECT key FROM cases WHERE status = ?");
    statement.bind(0, std::string_view(status));
    while (statement.step()) keys.insert(statement.text(0));
    return keys;
  }
};

BatchStore::BatchStore(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) {}
BatchStore::~BatchStore() = default;

const std::filesystem::path& BatchStore::file() const {
  return impl_->file;
}

std::size_t BatchStore::add(const BatchPlan& plan) {
  SqliteDatabase& database = impl_->database;
  SqliteTransaction transaction(database);
  SqliteStatement known(database, "SELECT 1 FROM cases WHERE key = ?");
  SqliteStatement enter(
      database, "INSERT INTO cases (key, source, position, inputs, status) VALUES (?, ?, ?, ?, 'pending')");
  // A case that is there keeps its place; one that still waits may have moved to another path.
  SqliteStatement move(database,
                       "UPDATE cases SET source = ?2 WHERE key = ?1 AND status = 'pending' AND source <> ?2");
  std::int64_t position = database.number("SELECT coalesce(max(position), 0) FROM cases");
  const std::int64_t before = position;
  for (const BatchCase& batch_case : plan.cases) {
    known.bind(0, std::string_view(batch_case.key));
    const bool there = known.step();
    known.reset();
    SqliteStatement& statement = there ? move : enter;
    statement.bind(0, std::string_view(batch_case.key));
    statement.bind(1, std::string_view(batch_case.source));
    if (!there) {
      statement.bind(2, ++position);
      statement.bind(3, std::string_view(batch_case.inputs));
    }
    statement.run();
  }
  if (position > before) {
    SqliteStatement remember(database,
                             "INSERT OR IGNORE INTO plans (sha256, file, text, version) VALUES (?, ?, ?, ?)");
    remember.bind(0, std::string_view(sha256(plan.text)));
    remember.bind(1, std::string_view(plan.file));
    remember.bind(2, std::string_view(plan.text));
    remember.bind(3, version());
    remember.run();
  }
  transaction.commit();
  return std::size_t(position - before);
}

std::vector<BatchCase> BatchStore::pending(const BatchPlan& plan) {
  const auto keys = impl_->keys_with("pending");
  std::vector<BatchCase> cases;
  for (const BatchCase& batch_case : plan.cases)
    if (keys.contains(batch_case.key)) cases.push_back(batch_case);
  return cases;
}

std::size_t BatchStore::forget_failures(const BatchPlan& plan) {
  const auto keys = impl_->keys_with("failed");
  SqliteTransaction transaction(impl_->database);
  SqliteStatement forget(impl_->database, "UPDATE cases SET status = 'pending', error = NULL WHERE key = ?");
  std::size_t count = 0;
  for (const BatchCase& batch_case : plan.cases) {
    if (!keys.contains(batch_case.key)) continue;
    forget.bind(0, std::string_view(batch_case.key));
    forget.run();
    ++count;
  }
  transaction.commit();
  return count;
}

void BatchStore::put(const BatchResult& result) {
  const std::size_t columns = batch_columns().summary.size(), width = batch_columns().points.size();
  const bool fits = result.error.empty()
                        ? result.summary.size() == columns && result.points.size() % width == 0
                        : result.summary.empty() && result.points.empty();
  if (!fits)
    throw Error(file().string(), "case " + result.key, "has a result of another shape",
                "use one version of Catoptra everywhere");
  SqliteTransaction transaction(impl_->database);
  const auto position = impl_->take(result);
  if (!position) return;
  if (result.error.empty()) {
    SqliteStatement& summary = impl_->summary;
    summary.reset();
    summary.bind(0, *position);
    for (std::size_t i = 0; i < columns; ++i) summary.bind(int(i) + 1, result.summary[i]);
    summary.run();
  }
  SqliteStatement& point = impl_->point;
  for (std::size_t row = 0; row < result.points.size() / width; ++row) {
    point.reset();
    point.bind(0, *position);
    point.bind(1, std::int64_t(row));
    for (std::size_t i = 0; i < width; ++i) point.bind(int(i) + 2, result.points[row * width + i]);
    point.run();
  }
  transaction.commit();
}

}  // namespace catoptra::app
