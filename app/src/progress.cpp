#include "app/src/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace catoptra::app {

Progress::Progress(bool wanted) : enabled_(wanted && isatty(STDERR_FILENO) == 1) {}

void Progress::show(double share, std::string_view what) {
  if (!enabled_) return;
  // Cut to 70 letters so that the line never wraps in a terminal of 80 columns: a wrapped line cannot be
  // erased.
  const int length = static_cast<int>(std::min<std::size_t>(what.size(), 70));
  if (share >= 0)
    std::fprintf(stderr, "\r\033[K%3.0f %% %.*s", 100 * std::clamp(share, 0.0, 1.0), length, what.data());
  else
    std::fprintf(stderr, "\r\033[K%.*s", length, what.data());
  std::fflush(stderr);
  shown_ = true;
}

void Progress::clear() {
  if (!shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace catoptra::app
