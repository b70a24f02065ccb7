#include "app/src/batch_lens.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "app/src/batch_lens_case.h"
#include "app/src/file_hash.h"
#include "app/src/lens_report.h"
#include "app/src/lens_source.h"
#include "cad_import/error.h"
#include "cad_import/import.h"
#include "cad_import/lens_faces.h"

namespace catoptra::app {
namespace {

using optics::LensPoint;

cad_import::CadModel model_of(const LensCase& lens_case, const std::string& source) {
  if (lens_case.blank) {
    cad_import::LensBlank blank = *lens_case.blank;
    const optics::Medium medium = lens_case.material.medium();
    blank.index = medium.index(optics::reference_line_nm(medium));  // as `lens make`
    return cad_import::lens_model(cad_import::LensShape(blank));
  }
  if (sha256_of_file(source) != lens_case.file_sha256)
    throw Error(source, "file", "is no longer what the plan was made from",
                "run the batch again with the plan");
  if (!cad_import::is_cad(cad_import::sniff_format(source)))
    throw Error(source, "file", "has no exact surfaces", "give STEP, IGES, BREP or FreeCAD files");
  return cad_import::import_cad(source);
}

/// What is counted over the points of a case.
struct Extremes {
  double passed = 0, error_min = kNoValue, error_max = kNoValue, astigmatism = kNoValue, prism = kNoValue,
         distortion_min = kNoValue, distortion_max = kNoValue, colour = kNoValue;

  void count(const LensPoint& p) {
    if (p.end != optics::LensPathEnd::passed) return;
    ++passed;  // fmin and fmax pass over what is not a number
    error_min = std::fmin(error_min, p.mean_power_error_d);
    error_max = std::fmax(error_max, p.mean_power_error_d);
    astigmatism = std::fmax(astigmatism, std::abs(p.oblique_astigmatism_d));
    prism = std::fmax(prism, std::hypot(p.prism.x, p.prism.y));
    distortion_min = std::fmin(distortion_min, p.distortion);
    distortion_max = std::fmax(distortion_max, p.distortion);
    colour = std::fmax(colour, p.transverse_colour);
  }
};

/// The angle that was asked for: radians and back leave a last digit behind.
double as_asked_deg(double angle_rad) {
  return std::round(1e9 * glm::degrees(angle_rad)) / 1e9;
}

void append_point(const LensPoint& p, bool dispersion, std::vector<double>& values) {
  const bool passed = p.end == optics::LensPathEnd::passed, met = p.end != optics::LensPathEnd::missed;
  values.insert(values.end(), {as_asked_deg(p.gaze_rad.x), as_asked_deg(p.gaze_rad.y),
                               met ? p.point_mm.x : kNoValue, met ? p.point_mm.y : kNoValue, double(p.end)});
  if (!passed) {
    values.insert(values.end(), batch_columns().points.size() - 5, kNoValue);
    return;
  }
  const optics::SphereCylinder power = sphere_cylinder(p.power, optics::CylinderForm::minus);
  values.insert(values.end(),
                {power.sphere_d, power.cylinder_d, glm::degrees(power.axis_rad), p.mean_power_error_d,
                 p.oblique_astigmatism_d, p.tangential_d, p.sagittal_d, p.prism.x, p.prism.y,
                 glm::degrees(p.object_rad.x), glm::degrees(p.object_rad.y), p.distortion,
                 dispersion ? p.transverse_colour : kNoValue});
}

/// A lens without a material, and one evaluator per material that was asked for.
class LensSubject final : public CaseSubject {
 public:
  LensSubject(const cad_import::CadModel& model, const LensCase& first) {
    LensSourceOptions options;
    options.medium = first.material.medium();
    options.front_faces = first.front_faces;
    options.back_faces = first.back_faces;
    lens_ = lens_of_model(model, options);
    center_thickness_mm_ =
        cad_import::measure_lens(lens_.lens.faces, lens_.lens.back.faces, model.file).center_thickness_mm;
  }

  BatchResult evaluate(const BatchCase& batch_case) const override {
    const LensCase lens_case = lens_case_from(batch_case.inputs);
    const bool dispersion = !lens_case.material.name.empty() || lens_case.material.vd.has_value();
    const auto gaze = lens_case.gaze.in_radians();
    const auto evaluation = evaluator(lens_case.material).at_gaze(gaze, lens_case.evaluation_options());
    BatchResult result;
    Extremes extremes;
    for (const LensPoint& point : evaluation.points) {
      extremes.count(point);
      append_point(point, dispersion, result.points);
    }
    const auto& reference = evaluation.reference;
    const auto& prism = evaluation.reference_prism;
    result.summary = {reference.sphere_d,
                      reference.cylinder_d,
                      glm::degrees(reference.axis_rad),
                      std::hypot(prism.x, prism.y),
                      glm::degrees(prism_base(prism).base_rad),
                      evaluation.spectacle_magnification,
                      center_thickness_mm_,
                      double(evaluation.points.size()),
                      extremes.passed,
                      extremes.error_min,
                      extremes.error_max,
                      extremes.astigmatism,
                      extremes.prism,
                      extremes.distortion_min,
                      extremes.distortion_max,
                      dispersion ? extremes.colour : kNoValue};
    return result;
  }

 private:
  struct OfMaterial {
    optics::Optic lens;
    std::optional<optics::LensEvaluator> evaluator;
  };

  const optics::LensEvaluator& evaluator(const CaseMaterial& material) const {
    const std::lock_guard lock(mutex_);
    auto& found = materials_[nlohmann::json{material.name, material.catalogue_sha256, material.nd.value_or(0),
                                            material.vd.value_or(0)}
                                 .dump()];
    if (!found.evaluator) {
      // A thread that waits inside must not take up another case, which would want the same lock.
      tbb::this_task_arena::isolate([&] {
        found.lens = lens_.lens;
        found.lens.medium = material.medium();
        found.evaluator.emplace(found.lens, lens_.frame);
      });
    }
    return *found.evaluator;
  }

  LensSource lens_;
  double center_thickness_mm_ = 0;
  mutable std::mutex mutex_;
  mutable std::map<std::string, OfMaterial> materials_;  // whose addresses last
};

class LensCaseEvaluator final : public CaseEvaluator {
 public:
  std::string subject_of(const BatchCase& batch_case) const override {
    const auto inputs = nlohmann::json::parse(batch_case.inputs);
    auto lens = nlohmann::json::object();
    const auto add = [&](const char* key) {
      if (inputs.contains(key)) lens[key] = inputs.at(key);
    };
    for (const char* key : {"lens_sha256", "front_faces", "back_faces"}) add(key);
    if (lens.contains("lens_sha256")) return lens.dump();  // for all materials
    for (const BlankNumber& number : blank_numbers()) add(number.column);
    for (const char* key : {"front", "asphere_mm", "outline_mm", "material", "nd", "vd", "catalogue_sha256"})
      add(key);
    return lens.dump();
  }

  std::shared_ptr<const CaseSubject> open(const BatchCase& batch_case) const override {
    const LensCase lens_case = lens_case_from(batch_case.inputs);
    return std::make_shared<LensSubject>(model_of(lens_case, batch_case.source), lens_case);
  }
};

}  // namespace

const CaseEvaluator& lens_case_evaluator() {
  static const LensCaseEvaluator evaluator;
  return evaluator;
}

const BatchColumns& batch_columns() {
  static const BatchColumns columns{
      {"reference_sphere_d", "reference_cylinder_d", "reference_axis_deg", "reference_prism_pd",
       "reference_prism_base_deg", "spectacle_magnification_ratio", "measured_thickness_mm", "points",
       "points_passed", "mean_power_error_min_d", "mean_power_error_max_d", "oblique_astigmatism_max_d",
       "prism_max_pd", "distortion_min_ratio", "distortion_max_ratio", "tca_max_pd"},
      {"gaze_h_deg", "gaze_v_deg", "x_mm", "y_mm", "end", "sphere_d", "cylinder_d", "axis_deg",
       "mean_power_error_d", "oblique_astigmatism_d", "tangential_d", "sagittal_d", "prism_h_pd",
       "prism_v_pd", "object_h_deg", "object_v_deg", "distortion_ratio", "tca_pd"}};
  return columns;
}

BatchResult evaluate_case(const BatchCase& batch_case) {
  std::shared_ptr<const CaseSubject> subject;
  try {
    subject = lens_case_evaluator().open(batch_case);
  } catch (const std::exception&) {
    return failed_result(batch_case);
  }
  return evaluate_on(*subject, batch_case);
}

std::string evaluate_case(std::string_view line) {
  struct Kept {
    std::string subject;
    std::shared_ptr<const CaseSubject> lens;
  };
  thread_local Kept kept;
  const BatchCase batch_case = case_from_json(line);
  try {
    const std::string subject = lens_case_evaluator().subject_of(batch_case);
    if (!kept.lens || kept.subject != subject) kept = {subject, lens_case_evaluator().open(batch_case)};
  } catch (const std::exception&) {
    kept = {};
    return to_json(failed_result(batch_case));
  }
  return to_json(evaluate_on(*kept.lens, batch_case));
}

}  // namespace catoptra::app
