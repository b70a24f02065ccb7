// SQLite with C++ lifetimes and errors of one line. sqlite3.h stays behind it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace catoptra::app {

enum class SqliteAccess { read, write };

/// One connection, for one thread at a time. Everything here throws catoptra::Error(file, ...).
class SqliteDatabase {
 public:
  /// `write` makes the file where there is none (at the first statement that writes).
  SqliteDatabase(const std::filesystem::path& file, SqliteAccess access);

  /// One or more statements without results.
  void execute(const std::string& sql);
  [[nodiscard]] std::int64_t number(const std::string& sql);
  [[nodiscard]] std::string text(const std::string& sql);

  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }
  /// Words the last failure: whether the disk is full, the file damaged, none of SQLite, or locked.
  [[noreturn]] void fail(int code) const;

 private:
  std::string file_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> handle_;
};

/// A prepared statement. Parameters and columns count from 0.
class SqliteStatement {
 public:
  SqliteStatement(SqliteDatabase& database, const std::string& sql);

  void bind(int parameter, std::string_view text);
  void bind(int parameter, std::int64_t number);
  /// Not-a-number becomes null.
  void bind(int parameter, double number);
  void bind_null(int parameter);

  /// True while there is a row.
  bool step();
  /// Runs to the end and makes ready for the next values.
  void run();
  void reset();

  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::int64_t integer(int column) const;
  /// Null becomes kNoValue.
  [[nodiscard]] double real(int column) const;

 private:
  SqliteDatabase& database_;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> handle_;
};

/// Begun here, rolled back unless committed.
class SqliteTransaction {
 public:
  explicit SqliteTransaction(SqliteDatabase& database);
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  void commit();

 private:
  SqliteDatabase& database_;
  bool open_ = true;
};

}  // namespace catoptra::app
