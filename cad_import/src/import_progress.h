// Progress and cancellation, as the CAD kernel and the importer's own loops report them.
#pragma once

#include <Message_ProgressIndicator.hxx>
#include <exception>
#include <string>
#include <string_view>

#include "cad_import/import.h"

namespace catoptra::cad_import {

/// Calls ImportOptions::progress with a share of the whole that never falls, and watches
/// ImportOptions::cancel.
class ImportProgress : public Message_ProgressIndicator {
  DEFINE_STANDARD_RTTI_INLINE(ImportProgress, Message_ProgressIndicator)
 public:
  ImportProgress(const ImportOptions& options, std::string file)
      : options_(options), file_(std::move(file)) {}

  /// From now on 0..1 of a stage is `begin`..`end` of the whole. Throws Cancelled; rethrows what the callback
  /// threw.
  void stage(std::string_view name, double begin, double end);
  /// Reports `share` (0..1) of the stage. Throws as stage().
  void step(double share);
  /// Throws Cancelled where the user asked to stop, and rethrows what the callback threw inside the kernel.
  void check() const;

 protected:
  void Show(const Message_ProgressScope& scope, const Standard_Boolean force) override;
  Standard_Boolean UserBreak() override;

 private:
  const ImportOptions& options_;
  std::string file_, name_;
  double begin_ = 0, end_ = 1, shown_ = -1;
  std::exception_ptr thrown_;
};

}  // namespace catoptra::cad_import
