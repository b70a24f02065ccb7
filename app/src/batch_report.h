// The report on a batch as an HTML page.
#pragma once

#include <cstddef>
#include <string>

#include "app/src/batch_store.h"

namespace catoptra::app {

struct BatchReportOptions {
  std::size_t rows = 5000;  ///< cases in the table; the page says where there are more
  std::size_t maps = 100;   ///< done cases whose maps can be looked at
};

/// Summary, failures, quantities against each other, every case in a table, and maps of single lenses. Throws
/// catoptra::Error.
[[nodiscard]] std::string batch_page(BatchReader& reader, const std::string& name,
                                     const BatchReportOptions& options = {});

}  // namespace catoptra::app
