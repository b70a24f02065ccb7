// What a batch computes: the seam between the engine, which knows nothing of optics, and the kinds of cases.
#pragma once

#include <memory>
#include <string>

#include "app/batch.h"

namespace catoptra::app {

/// What several cases share and is costly to make: a lens in memory. Immutable to its users, thread-safe.
class CaseSubject {
 public:
  virtual ~CaseSubject() = default;
  /// Throws catoptra::Error where the case cannot be computed.
  [[nodiscard]] virtual BatchResult evaluate(const BatchCase& batch_case) const = 0;
};

/// Thread-safe.
class CaseEvaluator {
 public:
  virtual ~CaseEvaluator() = default;
  /// Cases of the same text are evaluated on the same subject, so that it is made once.
  [[nodiscard]] virtual std::string subject_of(const BatchCase& batch_case) const = 0;
  /// Throws catoptra::Error where there is no such subject: the error of all its cases.
  [[nodiscard]] virtual std::shared_ptr<const CaseSubject> open(const BatchCase& batch_case) const = 0;
};

/// Evaluates on `subject`, with every failure but std::bad_alloc as the result's error, numbers that are not
/// finite as kNoValue, and zero without a sign (SQLite does not keep it).
[[nodiscard]] BatchResult evaluate_on(const CaseSubject& subject, const BatchCase& batch_case);

/// The result of a case whose subject could not be made, from the exception being handled. Rethrows
/// std::bad_alloc.
[[nodiscard]] BatchResult failed_result(const BatchCase& batch_case);

/// The engine behind run_batch(), for any kind of case.
BatchProgress run_cases(const std::vector<BatchCase>& cases, const CaseEvaluator& evaluator,
                        BatchStore& store, const BatchRunOptions& options);

}  // namespace catoptra::app
