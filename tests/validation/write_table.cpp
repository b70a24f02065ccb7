// write_table EXAMPLES OUTPUT.md: measures, and writes the validation table of the README.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>

#include "tests/validation/table.h"

namespace catoptra::validation {

std::string number(double value, int digits, const std::string& unit) {
  // Digits after the point that leave `digits` significant ones.
  const int whole = value == 0 ? 1 : static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", std::max(0, digits - whole), value);
  return text + (unit.empty() ? "" : (unit == "'" ? "" : " ") + unit);
}

std::string below(double value, const std::string& unit) {
  // Never finer than 1e-9: what is left below is rounding that may differ between machines.
  const int exponent = value < 1e-9 ? -9 : static_cast<int>(std::ceil(std::log10(value)));
  const std::string power =
      exponent >= -2 ? number(std::pow(10, exponent), 1) : "1e" + std::to_string(exponent);
  return "< " + power + (unit.empty() || unit == "'" ? "" : " ") + unit;
}

}  // namespace catoptra::validation

int main(int argc, char** argv) try {
  using namespace catoptra::validation;
  if (argc != 3) {
    std::fputs("usage: write_table EXAMPLES OUTPUT.md\n", stderr);
    return 2;
  }
  const std::filesystem::path output = argv[2];
  auto rows = closed_form_rows(output.parent_path());
  for (Row& row : lens_rows()) rows.push_back(std::move(row));
  for (Row& row : picture_rows(argv[1], output.parent_path())) rows.push_back(std::move(row));
  std::ofstream out(output);
  out << "| case | expected | computed | error |\n|---|---|---|---|\n";
  for (const Row& row : rows)
    out << "| " << row.what << " | " << row.expected << " | " << row.computed << " | " << row.error << " |\n";
  return out.flush() ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
