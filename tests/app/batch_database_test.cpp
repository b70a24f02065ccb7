// Disks that are full, places that cannot be written, files that are none of ours, two runs at once.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "app/batch.h"
#include "tests/app/batch_files.h"

namespace catoptra::test {
namespace {

CommandResult run_plan(const std::filesystem::path& plan, const std::filesystem::path& database,
                       const std::string& before = "") {
  return run_catoptra({"batch", "run", plan.string(), "--db", database.string()}, "", before);
}

/// One line on standard error that names the file and holds `text`, and exit code 1.
void expect_refused(const CommandResult& result, const std::filesystem::path& file, const std::string& text) {
  EXPECT_EQ(result.code, 1) << result.errors;
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  EXPECT_NE(result.errors.find(file.string()), std::string::npos) << result.errors;
  EXPECT_NE(result.errors.find(text), std::string::npos) << result.errors;
  EXPECT_EQ(result.output, "");
}

class BatchDatabase : public testing::Test {
 protected:
  TemporaryFolder folder;
  std::filesystem::path plan = folder.write("plan.toml", many_poses_plan(2, 5));
  std::filesystem::path database = folder / "results.sqlite";
};

// The limit on file sizes stands for a full disk: both refuse a write in the middle. It works for root too.
TEST_F(BatchDatabase, AFullDiskLosesNothingAndTheSameCommandGoesOn) {
  const auto many = folder.write("many.toml", many_poses_plan(2, 200));
  const auto calm = folder / "calm.sqlite";
  ASSERT_EQ(run_plan(many, calm).code, 0);
  // 512-byte blocks: too few for the tables, for the cases to come, for the results.
  int stored_before = -1;
  for (const int blocks : {16, 400, 3000}) {
    const CommandResult full = run_plan(many, database, "ulimit -f " + std::to_string(blocks) + ";");
    expect_refused(full, database, "cannot be written");
    EXPECT_NE(full.errors.find("make room"), std::string::npos) << full.errors;
    int stored = -1;
    try {
      stored = std::stoi(ask_sqlite(database, "SELECT count(*) FROM cases WHERE status = 'done'"));
    } catch (const std::runtime_error&) {
    }
    EXPECT_GE(stored, stored_before);
    stored_before = stored;
  }
  EXPECT_GT(stored_before, 0) << "the last of them meets a running batch";
  EXPECT_LT(stored_before, 400);
  const CommandResult rest = run_plan(many, database);
  ASSERT_EQ(rest.code, 0) << rest.errors;
  EXPECT_NE(rest.output.find(std::to_string(400 - stored_before) + " computed"), std::string::npos)
      << rest.output;
  EXPECT_EQ(differing_table(database, calm), "");
}

TEST_F(BatchDatabase, AFullDiskLeavesNoHalfExport) {
  ASSERT_EQ(run_plan(plan, database).code, 0);
  const auto table = folder / "table.csv";
  const CommandResult full =
      run_catoptra({"batch", "export", "--db", database.string(), "-o", table.string()}, "", "ulimit -f 2;");
  expect_refused(full, table, "cannot be written");
  EXPECT_FALSE(std::filesystem::exists(table));
  const CommandResult no_room =
      run_catoptra({"batch", "export", "--db", database.string(), "-o", "/dev/full/x.csv"});
  expect_refused(no_room, "/dev/full/x.csv", "cannot be written");
}

TEST_F(BatchDatabase, APlaceThatCannotBeWrittenIsTold) {
  // These fail for root too: a folder that is a file, one that does not exist, and one that takes no files.
  for (const auto& place : {plan / "results.sqlite", folder / "nowhere" / "results.sqlite",
                            std::filesystem::path("/proc/results.sqlite")})
    expect_refused(run_plan(plan, place), place, "cannot be written here");
  expect_refused(run_plan(plan, folder.path()), folder.path(), "is a folder");
  if (geteuid() == 0) {
    std::cout
        << "run as root, whom permissions do not stop: the folder without write permission is left out\n";
    return;
  }
  const auto closed = folder / "closed";
  std::filesystem::create_directory(closed);
  chmod(closed.c_str(), 0555);
  expect_refused(run_plan(plan, closed / "results.sqlite"), closed / "results.sqlite", "Permission denied");
  chmod(closed.c_str(), 0755);
}

TEST_F(BatchDatabase, OtherPeoplesFilesStayAsTheyAre) {
  const auto text =
      folder.write("notes.sqlite", "these are notes, and no database at all\n" + std::string(2000, 'x'));
  const auto foreign = folder / "photos.sqlite";
  (void)ask_sqlite(foreign, "CREATE TABLE photos (name TEXT); INSERT INTO photos VALUES ('cat')");
  const auto marked = folder / "marked.sqlite";
  (void)ask_sqlite(marked, "PRAGMA application_id = 1196444487; VACUUM");
  ASSERT_EQ(run_plan(plan, database).code, 0);
  const auto newer = folder / "newer.sqlite";
  std::filesystem::copy_file(database, newer);
  (void)ask_sqlite(newer, "PRAGMA user_version = 99; PRAGMA wal_checkpoint(TRUNCATE)");
  const std::size_t files = files_in(folder.path());
  const std::vector<std::pair<std::filesystem::path, std::string>> all{
      {text, "is no SQLite database"},
      {foreign, "is a database of another program"},
      {marked, "is a database of another program"},
      {newer, "has tables of version 99"}};
  for (const auto& [file, reason] : all) {
    const std::string before = read_file(file);
    expect_refused(run_plan(plan, file), file, reason);
    expect_refused(run_catoptra({"batch", "status", "--db", file.string()}), file, reason);
    expect_refused(run_catoptra({"batch", "export", "--db", file.string(), "-o", "-"}), file, reason);
    EXPECT_EQ(read_file(file), before);
  }
  EXPECT_EQ(files_in(folder.path()), files) << "no lock, log or index is left beside them";
}

TEST_F(BatchDatabase, ADamagedDatabaseIsTold) {
  ASSERT_EQ(run_plan(folder.write("many.toml", many_poses_plan(1, 60)), database).code, 0);
  const std::string whole = read_file(database);
  ASSERT_GT(whole.size(), 40000u);
  std::string scratched = whole;  // pages of tables, in the middle of the file
  for (std::size_t i = whole.size() / 2; i < whole.size() / 2 + 8192; ++i) scratched[i] = char(i * 7);
  for (const std::string& damaged : {whole.substr(0, whole.size() / 2), scratched}) {
    const auto file = folder.write("damaged.sqlite", damaged);
    expect_refused(run_plan(plan, file), file, "is damaged");
    EXPECT_EQ(read_file(file), damaged);
    std::filesystem::remove(file.string() + "-wal");
    std::filesystem::remove(file.string() + "-shm");
  }
}

TEST_F(BatchDatabase, TwoRunsAtOnceDoNotMeet) {
  {
    const app::BatchStore held(database);
    expect_refused(run_plan(plan, database), database, "another 'batch run' is writing this database");
    const auto link = folder / "link.sqlite";
    std::filesystem::create_symlink(database, link);
    expect_refused(run_plan(plan, link), link, "another 'batch run' is writing this database");
  }
  EXPECT_EQ(run_plan(plan, database).code, 0) << "free again";
}

TEST_F(BatchDatabase, ThereIsNothingToAskBeforeTheFirstRun) {
  expect_refused(run_catoptra({"batch", "status", "--db", database.string()}), database, "does not exist");
  EXPECT_FALSE(std::filesystem::exists(database));
  folder.write("results.sqlite", "");
  expect_refused(run_catoptra({"batch", "status", "--db", database.string()}), database, "holds no batch");
  EXPECT_EQ(run_plan(plan, database).code, 0) << "an empty file becomes a database";
}

}  // namespace
}  // namespace catoptra::test
