// The tables of a batch database, and how one is told from other files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/src/sqlite.h"

namespace catoptra::app {

/// What a file is, judged by its header and tables.
enum class DatabaseKind { empty, batch };

/// Throws catoptra::Error where the database is another program's, or of another version of the tables.
[[nodiscard]] DatabaseKind database_kind(SqliteDatabase& database, const std::filesystem::path& file);

/// Makes the tables of this version in an empty database, all or none.
void make_tables(SqliteDatabase& database);

/// "a, b, c" of column names, each quoted.
[[nodiscard]] std::string column_list(const std::vector<std::string>& names, const std::string& prefix = {});

}  // namespace catoptra::app
