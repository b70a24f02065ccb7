#include <Standard_Failure.hxx>
#include <cmath>
#include <glm/matrix.hpp>
#include <new>

#include "cad_import/import.h"
#include "cad_import/src/file_checks.h"
#include "cad_import/src/kernel_document.h"
#include "cad_import/src/kernel_session.h"
#include "cad_import/src/model_builder.h"
#include "cad_import/src/sew_faces.h"
#include "cad_import/src/shape_checks.h"

namespace catoptra::cad_import {
namespace {

double checked_unit(const std::string& file, const std::string& unit) {
  const auto mm = unit_in_mm(unit);
  if (!mm) throw ImportError(file, "unit", "unknown length unit \"" + unit + "\"", "mm, cm, m, in, ft or um");
  return *mm;
}

// Areas and offsets only stay what they are under rotation, shift, mirror and one scale for all directions.
void check_placement(const std::string& file, const ImportOptions& options) {
  if (!(options.scale > 0) || !std::isfinite(options.scale))
    throw ImportError(file, "scale", "must be a number above 0");
  const glm::dmat3 linear(options.placement);
  const glm::dmat3 product = glm::transpose(linear) * linear;
  const double scale2 = product[0][0];
  bool similar = scale2 > 0 && std::isfinite(scale2);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      similar = similar &&
                std::abs(product[i][j] - (i == j ? scale2 : 0)) <= 1e-9 * scale2;  // rounding of a matrix
  if (!similar)
    throw ImportError(file, "placement",
                      "is not made of rotation, translation and one scale for all directions");
}

KernelDocument read(const std::filesystem::path& file, FileFormat format, ImportProgress& progress) {
  switch (format) {
    case FileFormat::step:
      return read_step(file, progress);
    case FileFormat::iges:
      return read_iges(file, progress);
    case FileFormat::brep:
      return read_brep(file, progress);
    case FileFormat::freecad:
      return read_freecad(file, progress);
    default:
      throw ImportError(file.string(), "", "is not a CAD file",
                        "STEP, IGES, BREP or a FreeCAD document is needed here");
  }
}

CadModel import_with_kernel(const std::filesystem::path& file, const ImportOptions& options) {
  const std::string name = file.string();
  const double unit_mm = options.unit ? checked_unit(name, *options.unit) : 0;
  const KernelSession session;
  const Handle(ImportProgress) progress = new ImportProgress(options, name);
  KernelDocument document = read(file, sniff_format(file), *progress);
  sew_loose_faces(document);
  const double factor = options.scale * (options.unit ? unit_mm / document.unit_mm.value_or(1) : 1);
  const glm::dmat4 placement =
      options.placement * glm::dmat4(glm::dvec4(factor, 0, 0, 0), glm::dvec4(0, factor, 0, 0),
                                     glm::dvec4(0, 0, factor, 0), glm::dvec4(0, 0, 0, 1));
  CadModel model = build_model(document, name, placement, *progress);
  if (model.faces.empty()) {
    const std::string first =
        session.messages().empty() ? "" : "; the reader says: " + session.messages().front();
    throw ImportError(name, "", "no face in it" + first,
                      "points, curves and empty assemblies cannot reflect or refract");
  }
  if (options.unit && !document.unit_mm)
    model.warnings.push_back("the file's own unit \"" + document.unit + "\" is not known, so that unit = \"" +
                             *options.unit + "\" was taken for mm of the reader");
  if (std::string warning = size_warning(model.bounds); !warning.empty())
    model.warnings.push_back(std::move(warning));
  for (const std::string& message : session.messages()) model.warnings.push_back("reader: " + message);
  progress->stage("done", 1, 1);
  return model;
}

}  // namespace

CadModel import_cad(const std::filesystem::path& file, const ImportOptions& options) {
  const std::string name = file.string();
  check_readable(file);
  check_placement(name, options);
  try {
    return import_with_kernel(file, options);
  } catch (const Error&) {
    throw;
  } catch (const Standard_Failure& failure) {
    throw ImportError(name, "", std::string("the CAD kernel failed: ") + failure.GetMessageString());
  } catch (const std::bad_alloc&) {
    throw ImportError(name, "", "not enough memory to read it");
  }
}

}  // namespace catoptra::cad_import
