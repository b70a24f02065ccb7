// What must be true of a file before assimp may see it: where it is not, assimp 5.2 runs on for ever.
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

#include "cad_import/src/mesh_parts.h"

namespace catoptra::cad_import {

void check_ply_header(const std::filesystem::path& file) {
  constexpr std::size_t kMostLines = 10'000;
  std::error_code ignored;
  const double bytes = static_cast<double>(std::filesystem::file_size(file, ignored));
  std::ifstream stream(file, std::ios::binary);
  double elements = 0;
  std::string line;
  for (std::size_t number = 1; number <= kMostLines && std::getline(stream, line); ++number) {
    std::istringstream words(line);
    std::string keyword, name;
    words >> keyword;
    if (keyword == "end_header") return;
    if (keyword != "element") continue;
    double count = -1;
    if (!(words >> name >> count) || count < 0)
      throw ImportError(file.string(), "line " + std::to_string(number), "is no element with its count");
    elements += count;
    // An element without properties takes no space, but one with them takes a byte at least.
    if (elements > bytes)
      throw ImportError(file.string(), "line " + std::to_string(number),
                        "promises more elements than the file has bytes", "the file is cut off or damaged");
  }
  throw ImportError(file.string(), "", "the PLY header has no end_header", "the file is cut off or damaged");
}

}  // namespace catoptra::cad_import
