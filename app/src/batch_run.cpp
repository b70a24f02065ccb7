// The engine: subjects side by side on all threads, their cases side by side within them, one writer.
#include <tbb/concurrent_queue.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <optional>
#include <thread>

#include "app/src/batch_lens.h"
#include "app/src/case_evaluator.h"

namespace catoptra::app {
namespace {

/// Results that may wait for the writer. Where the disk is slower than the cores, these wait for it.
constexpr std::ptrdiff_t kWaiting = 1024;

/// Takes results from any thread and stores them from one.
class Writer {
 public:
  Writer(BatchStore& store, std::size_t wanted, const BatchRunOptions& options)
      : store_(store), options_(options) {
    progress_.wanted = wanted;
    queue_.set_capacity(kWaiting);
    thread_ = std::thread([this] { work(); });
  }
  ~Writer() { join(); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void push(BatchResult result) { queue_.push(std::optional(std::move(result))); }
  /// Nothing more is wanted: storing has failed, or somebody asked to stop.
  [[nodiscard]] bool closed() const { return failed_ || (options_.stop && *options_.stop); }

  /// Waits until all is stored. Rethrows what went wrong with it.
  BatchProgress finish() {
    join();
    if (failure_) std::rethrow_exception(failure_);
    return progress_;
  }

 private:
  void join() {
    if (!thread_.joinable()) return;
    queue_.push(std::nullopt);
    thread_.join();
  }

  void work() {
    const auto begin = std::chrono::steady_clock::now();
    for (std::optional<BatchResult> result;;) {
      queue_.pop(result);
      if (!result) return;
      if (failed_) continue;  // so that no one waits for room in the queue
      try {
        store_.put(*result);
        ++(result->error.empty() ? progress_.done : progress_.failed);
        progress_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        if (options_.progress) options_.progress(progress_);
      } catch (...) {
        failure_ = std::current_exception();
        failed_ = true;
      }
    }
  }

  BatchStore& store_;
  const BatchRunOptions& options_;
  BatchProgress progress_;
  tbb::concurrent_bounded_queue<std::optional<BatchResult>> queue_;
  std::exception_ptr failure_;
  std::atomic<bool> failed_ = false;
  std::thread thread_;  // last: it uses the others
};

using Group = std::vector<const BatchCase*>;

/// Cases by subject, in the order in which the subjects come up.
std::vector<Group> grouped(const std::vector<BatchCase>& cases, const CaseEvaluator& evaluator) {
  std::map<std::string, std::size_t> index;
  std::vector<Group> groups;
  for (const BatchCase& batch_case : cases) {
    const auto [found, added] = index.emplace(evaluator.subject_of(batch_case), groups.size());
    if (added) groups.emplace_back();
    groups[found->second].push_back(&batch_case);
  }
  return groups;
}

void run_group(const Group& group, const CaseEvaluator& evaluator, Writer& writer) {
  std::shared_ptr<const CaseSubject> subject;
  try {
    subject = evaluator.open(*group.front());
  } catch (const std::exception&) {
    for (const BatchCase* batch_case : group) writer.push(failed_result(*batch_case));
    return;
  }
  tbb::parallel_for(
      std::size_t(0), group.size(),
      [&](std::size_t i) {
        if (!writer.closed()) writer.push(evaluate_on(*subject, *group[i]));
      },
      tbb::simple_partitioner());
}

}  // namespace

BatchProgress run_cases(const std::vector<BatchCase>& cases, const CaseEvaluator& evaluator,
                        BatchStore& store, const BatchRunOptions& options) {
  std::optional<tbb::global_control> limit;
  if (options.jobs > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, options.jobs);
  const auto groups = grouped(cases, evaluator);
  Writer writer(store, cases.size(), options);
  // In the order of the plan: whoever looks into a running batch sees its begin. While a thread waits for its
  // subject's cases it takes up none of another subject (isolate): as many lenses are in memory as threads.
  tbb::task_arena arena(options.jobs > 0 ? int(options.jobs) : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(
        std::size_t(0), groups.size(),
        [&](std::size_t i) {
          if (writer.closed()) return;
          tbb::this_task_arena::isolate([&] { run_group(groups[i], evaluator, writer); });
        },
        tbb::simple_partitioner());
  });
  return writer.finish();
}

BatchProgress run_batch(const BatchPlan& plan, BatchStore& store, const BatchRunOptions& options) {
  store.add(plan);
  return run_cases(store.pending(plan), lens_case_evaluator(), store, options);
}

}  // namespace catoptra::app
