// A batch database as CSV or JSON, in the order of the plans.
#pragma once

#include <iosfwd>

#include "app/src/batch_store.h"

namespace catoptra::app {

enum class ExportRows { cases, points };

/// RFC 4180 with a header that names the units; numbers in the shortest form that reads back as the same
/// double; empty where there is no value. One row per case with its inputs, or one per point with its case's
/// number and key.
void export_csv(BatchReader& reader, ExportRows rows, std::ostream& out);

/// {"cases": [{"number", "key", "status", "error", "source", "inputs": {...}, "summary": {...}}, ...]}; with
/// `points` also "points": [{...}, ...] in each.
void export_json(BatchReader& reader, ExportRows rows, std::ostream& out);

}  // namespace catoptra::app
