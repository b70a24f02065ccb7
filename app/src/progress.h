// Progress on standard error, only where a person watches.
#pragma once

#include <string_view>

namespace catoptra::app {

/// One line that is written over and over, and erased at the end.
class Progress {
 public:
  /// `wanted`: false silences it. It is silent as well where standard error is no terminal.
  explicit Progress(bool wanted);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `share` done, 0..1; negative where it is unknown.
  void show(double share, std::string_view what);
  void clear();

 private:
  bool enabled_;
  bool shown_ = false;
};

}  // namespace catoptra::app
