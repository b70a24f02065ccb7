// Small batch plans and direct looks into their databases.
#pragma once

#include <sqlite3.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/app/command_runner.h"
#include "tests/app/temporary_folder.h"

namespace catoptra::test {

/// The first column of the first row; empty where there is none. Throws where SQLite refuses. `tidy`: the log
/// that a killed process has left may be put into the file afterwards; else that is left to the program under
/// test.
inline std::string ask_sqlite(const std::filesystem::path& file, const std::string& sql, bool tidy = true) {
  sqlite3* database = nullptr;
  std::string answer;
  const auto keep = [](void* to, int count, char** values, char**) {
    auto& text = *static_cast<std::string*>(to);
    if (text.empty() && count > 0 && values[0]) text = values[0];
    return 0;
  };
  sqlite3_open_v2(file.c_str(), &database, SQLITE_OPEN_READWRITE | (tidy ? SQLITE_OPEN_CREATE : 0), nullptr);
  sqlite3_busy_timeout(database, 10000);
  sqlite3_db_config(database, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, tidy ? 0 : 1, nullptr);
  char* message = nullptr;
  const int code = sqlite3_exec(database, sql.c_str(), keep, &answer, &message);
  const std::string failure = message ? message : "";
  sqlite3_free(message);
  sqlite3_close(database);
  if (code != SQLITE_OK) throw std::runtime_error(sql + ": " + failure);
  return answer;
}

/// The first number of the first row, as the double that is stored.
inline double number_in_sqlite(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  sqlite3_stmt* statement = nullptr;
  sqlite3_open(file.c_str(), &database);
  sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr);
  if (sqlite3_step(statement) != SQLITE_ROW) throw std::runtime_error(sql + ": no row");
  const double value = sqlite3_column_double(statement, 0);
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return value;
}

/// The cells of one line of CSV.
inline std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[i++];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += line[i];
  }
  return cells;
}

/// `lenses` minus lenses of 40 mm in `poses` positions, at 21 gazes.
inline std::string many_poses_plan(int lenses, int poses) {
  return "wavelengths_nm = [546.07]\n"
         "[[prescriptions]]\n"
         "sph = { from = -" +
         std::to_string(lenses) +
         ", to = -1, step = 1 }\n"
         "diameter = 40\nmaterial = \"CR-39\"\n"
         "[[poses]]\nmode = \"as-worn\"\n"
         "rotation_centre_mm = { from = 25, to = " +
         std::to_string(25 + (poses - 1) * 0.01) +
         ", step = 0.01 }\n"
         "panto_deg = 8\n"
         "[[gaze]]\nmax_deg = 20\nstep_deg = 8\n";
}

/// What a batch gives, for byte-by-byte comparison: the cases and the points.
inline std::string exported(const std::filesystem::path& database) {
  const std::string file = database.string();
  return run_catoptra({"batch", "export", "--db", file, "-o", "-"}).output + "\n" +
         run_catoptra({"batch", "export", "--db", file, "--points", "-o", "-"}).output;
}

/// Empty where both databases hold the same rows in every table of results; else the table.
inline std::string differing_table(const std::filesystem::path& a, const std::filesystem::path& b) {
  for (const std::string table : {"cases", "results", "points"})
    for (const auto& [one, other] : {std::pair{"main", "other"}, {"other", "main"}}) {
      const std::string from = std::string("SELECT * FROM ") + one + "." + table;
      const std::string to = std::string("SELECT * FROM ") + other + "." + table;
      const std::string count = ask_sqlite(
          a, "ATTACH '" + b.string() + "' AS other; SELECT count(*) FROM (" + from + " EXCEPT " + to + ")");
      if (count != "0") return table;
    }
  return {};
}

}  // namespace catoptra::test
