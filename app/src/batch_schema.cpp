#include "app/src/batch_schema.h"

#include "app/batch.h"
#include "app/src/batch_lens_case.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

/// In the file's header: 'CatB'.
constexpr std::int64_t kApplication = 0x43617442;

/// Version of the tables. Goes up with every change to them, or to the columns of results.
constexpr std::int64_t kTables = 1;

std::string column_definitions(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += ",\n  \"" + name + "\" REAL";
  return text;
}

/// One row per case with everything in columns, for people with a SQL prompt.
std::string view_of_cases() {
  std::string text = "CREATE VIEW lens_cases AS SELECT c.position, c.key, c.status, c.error, c.source";
  for (const std::string& name : lens_input_columns())
    text += ",\n  json_extract(c.inputs, '$." + name + "') AS \"" + name + "\"";
  text += ",\n  " + column_list(batch_columns().summary, "r.");
  return text + "\nFROM cases c LEFT JOIN results r ON r.position = c.position;\n";
}

}  // namespace

std::string column_list(const std::vector<std::string>& names, const std::string& prefix) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + prefix + '"' + name + '"';
  return text;
}

DatabaseKind database_kind(SqliteDatabase& database, const std::filesystem::path& file) {
  const std::int64_t application = database.number("PRAGMA application_id");
  const std::int64_t tables = database.number("PRAGMA user_version");
  if (application == 0 && tables == 0 && database.number("SELECT count(*) FROM sqlite_master") == 0)
    return DatabaseKind::empty;
  if (application != kApplication)
    throw Error(file.string(), "", "is a database of another program",
                "give another name; this file was left as it is");
  if (tables != kTables)
    throw Error(file.string(), "",
                "has tables of version " + std::to_string(tables) + ", and this program those of version " +
                    std::to_string(kTables),
                "use the version of Catoptra that made it, or give another name");
  return DatabaseKind::batch;
}

void make_tables(SqliteDatabase& database) {
  SqliteTransaction transaction(database);
  database.execute("PRAGMA application_id = " + std::to_string(kApplication) +
                   ";\n"
                   "PRAGMA user_version = " +
                   std::to_string(kTables) +
                   ";\n"
                   "CREATE TABLE plans (\n"
                   "  sha256 TEXT PRIMARY KEY NOT NULL,\n"
                   "  file TEXT NOT NULL,\n"
                   "  text TEXT NOT NULL,\n"
                   "  version TEXT NOT NULL\n"
                   ") STRICT;\n"
                   "CREATE TABLE cases (\n"
                   "  position INTEGER PRIMARY KEY,\n"
                   "  key TEXT NOT NULL UNIQUE,\n"
                   "  inputs TEXT NOT NULL,\n"
                   "  source TEXT NOT NULL,\n"
                   "  status TEXT NOT NULL CHECK (status IN ('pending', 'done', 'failed')),\n"
                   "  error TEXT CHECK ((error IS NULL) = (status <> 'failed'))\n"
                   ") STRICT;\n"
                   "CREATE TABLE results (\n"
                   "  position INTEGER PRIMARY KEY REFERENCES cases" +
                   column_definitions(batch_columns().summary) +
                   "\n) STRICT;\n"
                   "CREATE TABLE points (\n"
                   "  position INTEGER NOT NULL REFERENCES cases,\n"
                   "  point INTEGER NOT NULL" +
                   column_definitions(batch_columns().points) +
                   ",\n  PRIMARY KEY (position, point)\n) STRICT, WITHOUT ROWID;\n" + view_of_cases());
  transaction.commit();
}

}  // namespace catoptra::app
