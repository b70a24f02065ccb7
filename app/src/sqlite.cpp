#include "app/src/sqlite.h"

#include <sqlite3.h>

#include <cmath>
#include <cstring>
#include <system_error>

#include "app/batch.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

/// How long a statement waits for another connection's lock.
constexpr int kPatience_ms = 10000;

/// A file in WAL mode can be read where SQLite may make its index file beside it; not in a folder that cannot
/// be written, or on a full disk. Where no log lies beside the file, nothing can change and it may be read as
/// it is.
bool may_be_immutable(const std::filesystem::path& file) {
  std::filesystem::path log = file;
  log += "-wal";
  std::error_code failure;
  const auto size = std::filesystem::file_size(log, failure);
  return failure || size == 0;
}

bool has_no_room_for_index(int code) {
  const int kind = code & 0xff;
  return kind == SQLITE_CANTOPEN || kind == SQLITE_IOERR || kind == SQLITE_FULL || kind == SQLITE_READONLY;
}

std::string uri_of(const std::filesystem::path& file, std::string_view parameters) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string()) {
    if (c == '%' || c == '?' || c == '#') {
      uri += '%';
      uri += "0123456789ABCDEF"[(c >> 4) & 15];
      uri += "0123456789ABCDEF"[c & 15];
    } else {
      uri += c;
    }
  }
  return uri + std::string(parameters);
}

int open_at(sqlite3** handle, const std::string& uri, int flags) {
  const int code = sqlite3_open_v2(uri.c_str(), handle, flags | SQLITE_OPEN_URI, nullptr);
  if (code != SQLITE_OK) return code;
  sqlite3_extended_result_codes(*handle, 1);
  sqlite3_busy_timeout(*handle, kPatience_ms);
  // Only a statement opens the file for good.
  return sqlite3_exec(*handle, "PRAGMA schema_version", nullptr, nullptr, nullptr);
}

}  // namespace

SqliteDatabase::SqliteDatabase(const std::filesystem::path& file, SqliteAccess access)
    : file_(file.string()), handle_(nullptr, sqlite3_close) {
  // Readers open for writing too where they may: the last connection then tidies up what a log has left
  // behind.
  const int create = access == SqliteAccess::write ? SQLITE_OPEN_CREATE : 0;
  sqlite3* opened = nullptr;
  int code = open_at(&opened, uri_of(file, ""), SQLITE_OPEN_READWRITE | create);
  handle_.reset(opened);
  if (!create && has_no_room_for_index(code) && may_be_immutable(file)) {
    code = open_at(&opened, uri_of(file, "?immutable=1"), SQLITE_OPEN_READONLY);
    handle_.reset(opened);
  }
  if (code != SQLITE_OK) fail(code);
}

void SqliteDatabase::fail(int code) const {
  const int system = handle_ ? sqlite3_system_errno(handle_.get()) : 0;
  const std::string why = system ? " (" + std::string(std::strerror(system)) + ")" : "";
  if (code == SQLITE_IOERR_READ || code == SQLITE_IOERR_SHORT_READ)
    throw Error(file_, "", "cannot be read" + why, "is the disk sound?");
  switch (code & 0xff) {
    case SQLITE_FULL:
    case SQLITE_IOERR:
      throw Error(file_, "", "cannot be written: " + std::string(sqlite3_errstr(code)) + why,
                  "make room; what was stored before is kept, and the same command goes on from there");
    case SQLITE_NOTADB:
      throw Error(file_, "", "is no SQLite database", "give another name; this file was left as it is");
    case SQLITE_CORRUPT:
      throw Error(file_, "", "is damaged: " + std::string(sqlite3_errmsg(handle_.get())),
                  "give another name, or save what can be saved with sqlite3 '.recover'");
    case SQLITE_CANTOPEN:
      throw Error(file_, "", "cannot be opened" + why, "does the folder exist, and may you write there?");
    case SQLITE_READONLY:
    case SQLITE_PERM:
      throw Error(file_, "", "may not be written" + why, "change its permissions or give another place");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw Error(file_, "", "is locked by another program", "close that program and try again");
    case SQLITE_NOMEM:
      throw std::bad_alloc();
    default:
      throw Error(file_, "database", handle_ ? sqlite3_errmsg(handle_.get()) : sqlite3_errstr(code));
  }
}

void SqliteDatabase::execute(const std::string& sql) {
  const int code = sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code);
}

std::int64_t SqliteDatabase::number(const std::string& sql) {
  SqliteStatement statement(*this, sql);
  return statement.step() ? statement.integer(0) : 0;
}

std::string SqliteDatabase::text(const std::string& sql) {
  SqliteStatement statement(*this, sql);
  return statement.step() ? statement.text(0) : std::string();
}

SqliteStatement::SqliteStatement(SqliteDatabase& database, const std::string& sql)
    : database_(database), handle_(nullptr, sqlite3_finalize) {
  sqlite3_stmt* prepared = nullptr;
  const int code = sqlite3_prepare_v2(database.handle(), sql.c_str(), int(sql.size()), &prepared, nullptr);
  handle_.reset(prepared);
  if (code != SQLITE_OK) database.fail(code);
}

void SqliteStatement::bind(int parameter, std::string_view text) {
  const int code = sqlite3_bind_text64(handle_.get(), parameter + 1, text.data(), text.size(),
                                       SQLITE_TRANSIENT, SQLITE_UTF8);
  if (code != SQLITE_OK) database_.fail(code);
}

void SqliteStatement::bind(int parameter, std::int64_t number) {
  if (const int code = sqlite3_bind_int64(handle_.get(), parameter + 1, number)) database_.fail(code);
}

void SqliteStatement::bind(int parameter, double number) {
  if (std::isnan(number)) return bind_null(parameter);
  if (const int code = sqlite3_bind_double(handle_.get(), parameter + 1, number)) database_.fail(code);
}

void SqliteStatement::bind_null(int parameter) {
  if (const int code = sqlite3_bind_null(handle_.get(), parameter + 1)) database_.fail(code);
}

bool SqliteStatement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  database_.fail(code);
}

void SqliteStatement::run() {
  while (step()) continue;
  reset();
}

void SqliteStatement::reset() {
  sqlite3_reset(handle_.get());
}

std::string SqliteStatement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
  return text ? std::string(text, std::size_t(sqlite3_column_bytes(handle_.get(), column))) : std::string();
}

std::int64_t SqliteStatement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}

double SqliteStatement::real(int column) const {
  if (sqlite3_column_type(handle_.get(), column) == SQLITE_NULL) return kNoValue;
  return sqlite3_column_double(handle_.get(), column);
}

SqliteTransaction::SqliteTransaction(SqliteDatabase& database) : database_(database) {
  database_.execute("BEGIN IMMEDIATE");
}

SqliteTransaction::~SqliteTransaction() {
  // After a failure SQLite may have rolled back by itself; then there is nothing to do.
  if (open_ && !sqlite3_get_autocommit(database_.handle()))
    sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void SqliteTransaction::commit() {
  database_.execute("COMMIT");
  open_ = false;
}

}  // namespace catoptra::app
