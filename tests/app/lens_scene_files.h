// Lens files and scenes for the tests of [[lens]].
#pragma once

#include <filesystem>
#include <string>

#include "cad_import/lens_blank.h"
#include "tests/support/temporary_folder.h"

namespace catoptra::test {

/// A round lens of `diameter_mm` and index 1.5, back vertex power `sphere_d`, as `name`.
inline cad_import::LensBlankReport write_test_lens(const TemporaryFolder& folder, double sphere_d,
                                                   const std::string& name = "lens.step",
                                                   double diameter_mm = 50) {
  cad_import::LensBlank blank;
  blank.index = 1.5;
  blank.sphere_d = sphere_d;
  blank.diameter_mm = diameter_mm;
  const cad_import::LensShape shape(blank);
  cad_import::write_lens(shape, folder / name);
  return shape.report();
}

}  // namespace catoptra::test
