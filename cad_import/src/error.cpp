#include "cad_import/error.h"

#include <utility>

namespace catoptra {
namespace {

std::string one_line(const std::string& file, const std::string& entity, const std::string& reason,
                     const std::string& hint) {
  std::string text;
  for (const std::string* part : {&file, &entity, &reason}) {
    if (part->empty()) continue;
    if (!text.empty()) text += ": ";
    text += *part;
  }
  if (!hint.empty()) text += " (" + hint + ")";
  return text;
}

}  // namespace

Error::Error(std::string file, std::string entity, std::string reason, std::string hint)
    : std::runtime_error(one_line(file, entity, reason, hint)),
      file_(std::move(file)),
      entity_(std::move(entity)),
      reason_(std::move(reason)),
      hint_(std::move(hint)) {}

}  // namespace catoptra
