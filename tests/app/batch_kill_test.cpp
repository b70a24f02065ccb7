// kill -9, at any moment: what was stored stays, nothing is computed twice, and the end is that of an
// undisturbed run.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <random>
#include <set>
#include <thread>

#include "tests/app/batch_files.h"

extern char** environ;

namespace catoptra::test {
namespace {

using std::chrono::microseconds;

constexpr int kLenses = 4, kPoses = 500, kCases = kLenses * kPoses;
constexpr int kKills = 20;

/// `catoptra batch run` in a process of its own.
class BatchProcess {
 public:
  BatchProcess(const std::filesystem::path& plan, const std::filesystem::path& database) {
    std::vector<std::string> words{CATOPTRA_PROGRAM, "batch",           "run",    plan.string(),
                                   "--db",           database.string(), "--jobs", "2"};
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (posix_spawn(&process_, CATOPTRA_PROGRAM, &actions, nullptr, pointers.data(), environ) != 0)
      throw std::runtime_error("cannot start " CATOPTRA_PROGRAM);
    posix_spawn_file_actions_destroy(&actions);
    // Behind this test, so that on a busy machine too a kill comes when it is meant to.
    (void)setpriority(PRIO_PROCESS, id_t(process_), 19);
  }
  BatchProcess(const BatchProcess&) = delete;
  BatchProcess& operator=(const BatchProcess&) = delete;
  ~BatchProcess() {
    if (process_ > 0) (void)kill_now();
  }

  [[nodiscard]] bool running() {
    if (process_ > 0 && waitpid(process_, &status_, WNOHANG) == process_) process_ = 0;
    return process_ > 0;
  }

  /// True where the signal, and not its own end, ended it.
  bool kill_now() {
    if (process_ > 0) {
      kill(process_, SIGKILL);
      waitpid(process_, &status_, 0);
      process_ = 0;
    }
    return WIFSIGNALED(status_) && WTERMSIG(status_) == SIGKILL;
  }

 private:
  pid_t process_ = 0;
  int status_ = 0;
};

/// Results in the database; 0 before it has tables.
int stored(const std::filesystem::path& database) {
  try {
    return std::stoi(ask_sqlite(database, "SELECT count(*) FROM cases WHERE status <> 'pending'", false));
  } catch (const std::runtime_error&) {
    return 0;
  }
}

/// Runs until `wanted` results are there and a random moment longer; where `wanted` is 0, for a random moment
/// from the start (which meets start-up, the plan, or a lens in the making). True where it was interrupted.
bool run_and_kill(const std::filesystem::path& plan, const std::filesystem::path& database, int wanted,
                  std::mt19937_64& random) {
  BatchProcess process(plan, database);
  while (process.running() && stored(database) < wanted) std::this_thread::sleep_for(microseconds(200));
  std::this_thread::sleep_for(microseconds(random() % (wanted == 0 ? 300000u : 2000u)));
  return process.kill_now();
}

/// Empty where the output holds `text`.
std::string output_without(const CommandResult& result, const std::string& text) {
  return result.output.find(text) == std::string::npos ? result.output + result.errors : "";
}

TEST(BatchKill, TwentyKillsGiveTheRowsOfAnUndisturbedRun) {
  const TemporaryFolder folder;
  const auto plan = folder.write("plan.toml", many_poses_plan(kLenses, kPoses));
  const auto calm = folder / "calm.sqlite", killed = folder / "killed.sqlite";
  ASSERT_EQ(run_catoptra({"batch", "run", plan.string(), "--db", calm.string()}).code, 0);
  ASSERT_EQ(stored(calm), kCases);

  constexpr std::uint64_t kSeed = 20261124;
  std::mt19937_64 random(kSeed);
  int interrupted = 0, before = 0;
  std::set<int> found;
  for (int left = kKills; left > 0; --left) {
    // Some steps further on, so that at any speed of the machine enough is left for the kills to come.
    const int step = 1 + int(random() % std::uint64_t(1 + (kCases - before) / (left + 2)));
    interrupted += run_and_kill(plan, killed, left % 5 == 0 ? 0 : before + step, random);
    const int now = stored(killed);
    EXPECT_GE(now, before) << "a kill must not lose what was stored";
    EXPECT_TRUE(now == 0 || ask_sqlite(killed, "PRAGMA quick_check", false) == "ok");
    before = now;
    found.insert(now);
  }
  std::cout << "seed " << kSeed << ": " << interrupted << " of " << kKills << " kills interrupted a run; "
            << found.size() << " different numbers of results were found after them\n";
  EXPECT_GE(interrupted, 15) << "the batch has to be longer for kills to meet it";
  EXPECT_GE(found.size(), 10u) << "kills have to meet different moments";
  ASSERT_LT(before, kCases) << "something has to be left to go on with";

  const CommandResult rest = run_catoptra({"batch", "run", plan.string(), "--db", killed.string()});
  ASSERT_EQ(rest.code, 0) << rest.errors;
  EXPECT_EQ(output_without(rest, ", " + std::to_string(kCases - before) + " computed, 0 of them failed"), "")
      << "nothing is computed twice";
  EXPECT_EQ(exported(killed), exported(calm));
  EXPECT_EQ(files_in(folder.path()), 3u) << "no lock or log is left";
  EXPECT_EQ(differing_table(killed, calm), "");
  EXPECT_EQ(ask_sqlite(killed, "PRAGMA integrity_check"), "ok");
}

TEST(BatchKill, AKillWhileTheDatabaseIsMadeLeavesOneThatCanBeUsed) {
  const TemporaryFolder folder;
  const auto plan = folder.write("plan.toml", many_poses_plan(1, 20));
  const auto calm = folder / "calm.sqlite";
  ASSERT_EQ(run_catoptra({"batch", "run", plan.string(), "--db", calm.string()}).code, 0);
  for (int i = 0; i < 8; ++i) {
    const auto database = folder / ("early" + std::to_string(i) + ".sqlite");
    BatchProcess process(plan, database);
    // As soon as the file is there: the moments after that are those in which the tables are made.
    while (process.running() && !std::filesystem::exists(database))
      std::this_thread::sleep_for(microseconds(20));
    std::this_thread::sleep_for(microseconds(i * 200));
    EXPECT_TRUE(process.kill_now());
    const CommandResult rest = run_catoptra({"batch", "run", plan.string(), "--db", database.string()});
    ASSERT_EQ(rest.code, 0) << rest.errors;
    EXPECT_EQ(differing_table(database, calm), "");
  }
}

}  // namespace
}  // namespace catoptra::test
