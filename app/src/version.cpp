#include "app/version.h"

namespace catoptra::app {

std::string_view version() {
  return CATOPTRA_VERSION;
}

}  // namespace catoptra::app
