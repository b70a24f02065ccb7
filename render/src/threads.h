// The number of CPU threads that a picture asks for.
#pragma once

#include <tbb/task_arena.h>

#include <cstddef>

namespace catoptra::render {

/// Runs `work` in an arena of `threads` threads; 0: all of them.
template <typename Work>
void with_threads(std::size_t threads, const Work& work) {
  if (threads == 0) {
    work();
    return;
  }
  tbb::task_arena arena(static_cast<int>(threads));
  arena.execute(work);
}

}  // namespace catoptra::render
