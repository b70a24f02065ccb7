// The inputs of a lens case, between the plan, the evaluator and the JSON whose hash is the case's key.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/src/mirror_faces.h"
#include "cad_import/lens_blank.h"
#include "optics/lens_evaluation.h"
#include "optics/medium.h"

namespace catoptra::app {

/// What a lens is made of, so that the same text means the same indices everywhere.
struct CaseMaterial {
  std::string name;              ///< of the built-in catalogue; empty: given by the next two
  std::optional<double> nd, vd;  ///< index and Abbe number, or an index alone for all wavelengths
  /// Where `name` is a glass of one's own: it and the hash of its catalogue. Cases carry its dispersion, so
  /// that whoever computes them needs no file.
  std::shared_ptr<const optics::Medium> own;
  std::string catalogue_sha256;

  /// Throws catoptra::Error with the nearest names where there is no such material.
  [[nodiscard]] optics::Medium medium() const;
};

/// Where a lens is measured: a grid within a circle of `max_deg`, or the directions given.
struct CaseGaze {
  double max_deg = 30, step_deg = 10;
  std::vector<glm::dvec2> directions_deg;

  /// As optics::LensPoint::gaze_rad. Throws catoptra::Error for a grid that is none.
  [[nodiscard]] std::vector<glm::dvec2> in_radians() const;
};

struct LensCase {
  std::string file_sha256;                            ///< of a lens file, with
  std::vector<FaceSelector> front_faces, back_faces;  ///< its sides (empty: recognised), or
  std::optional<cad_import::LensBlank> blank;         ///< a lens to order; its index is that of `material`
  CaseMaterial material;
  optics::EvaluationOptions options;   ///< but for its two angles, which are
  double panto_deg = 0, wrap_deg = 0;  ///< so that a number stays the one that the plan has
  CaseGaze gaze;

  /// `options` with the angles, for one thread.
  [[nodiscard]] optics::EvaluationOptions evaluation_options() const;
};

/// A number of a prescription: its key in plans (as the option of `lens make`) and its name in inputs and
/// tables, which carries the unit.
struct BlankNumber {
  const char* key;
  const char* column;
  double cad_import::LensBlank::*value = nullptr;                          ///< either this
  std::optional<double> cad_import::LensBlank::*optional_value = nullptr;  ///< or this, null where left out
};
[[nodiscard]] std::span<const BlankNumber> blank_numbers();

/// The canonical JSON. What has no effect is left at its default (the axis of a lens without cylinder), so
/// that equal lenses have equal text. Throws catoptra::Error where the material is unknown.
[[nodiscard]] std::string to_inputs(const LensCase& lens_case);

/// Back again. Throws catoptra::Error where `inputs` is none of this version, or the material has other
/// indices here.
[[nodiscard]] LensCase lens_case_from(std::string_view inputs);

/// Names of the inputs as columns of tables, in their order there.
[[nodiscard]] std::span<const std::string> lens_input_columns();

}  // namespace catoptra::app
