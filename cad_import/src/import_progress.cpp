#include "cad_import/src/import_progress.h"

#include <algorithm>

namespace catoptra::cad_import {
namespace {

constexpr double kLeastStep = 0.005;  // share of the whole below which a new report says nothing new

}  // namespace

void ImportProgress::stage(std::string_view name, double begin, double end) {
  check();
  name_ = name;
  begin_ = begin;
  end_ = end;
  shown_ = std::min(shown_, begin - kLeastStep);  // a new stage is always shown
  step(0);
}

void ImportProgress::step(double share) {
  check();
  const double whole = begin_ + std::clamp(share, 0.0, 1.0) * (end_ - begin_);
  if (!options_.progress || whole < shown_ + kLeastStep) return;
  shown_ = whole;
  options_.progress(whole, name_);
}

void ImportProgress::check() const {
  if (thrown_) std::rethrow_exception(thrown_);
  if (options_.cancel && *options_.cancel) throw Cancelled(file_, "", "import cancelled");
}

// Called by the kernel from inside its own loops, where no exception may pass: it is kept until check().
void ImportProgress::Show(const Message_ProgressScope&, const Standard_Boolean) {
  if (thrown_) return;
  try {
    step(GetPosition());
  } catch (...) {
    thrown_ = std::current_exception();
  }
}

Standard_Boolean ImportProgress::UserBreak() {
  return thrown_ || (options_.cancel && *options_.cancel);
}

}  // namespace catoptra::cad_import
