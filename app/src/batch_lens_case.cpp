#include "app/src/batch_lens_case.h"

#include <cmath>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>

#include "app/src/glass_json.h"
#include "app/src/lens_front.h"
#include "cad_import/error.h"

namespace catoptra::app {
namespace {

using cad_import::LensBlank;
using cad_import::LensFrontForm;
using nlohmann::json;

/// Goes up whenever the same inputs give other numbers: results of older versions are then computed anew.
constexpr int kEvaluation = 1;

constexpr std::array<BlankNumber, 13> kBlankNumbers{
    {{"sph", "sph_d", &LensBlank::sphere_d},
     {"cyl", "cyl_d", &LensBlank::cylinder_d},
     {"axis", "axis_deg", &LensBlank::axis_deg},
     {"add", "add_d", &LensBlank::addition_d},
     {"corridor", "corridor_mm", &LensBlank::corridor_mm},
     {"prism", "prism_pd", &LensBlank::prism_d},
     {"base_deg", "base_deg", &LensBlank::prism_base_deg},
     {"front_curve", "front_curve_d", nullptr, &LensBlank::front_curve_d},
     {"conic", "conic", &LensBlank::conic},
     {"back_conic", "back_conic", &LensBlank::back_conic},
     {"center_thickness", "center_thickness_mm", nullptr, &LensBlank::center_thickness_mm},
     {"edge_thickness", "edge_thickness_mm", nullptr, &LensBlank::edge_thickness_mm},
     {"diameter", "diameter_mm", &LensBlank::diameter_mm}}};

[[noreturn]] void refuse(const std::string& reason) {
  throw Error("", "case", reason, "it has to come from a plan that this version has read");
}

/// The form that a lens gets where none is asked for, as in `lens make`.
void leave_out_idle(LensBlank& blank) {
  const LensBlank standard;
  if (blank.cylinder_d == 0) blank.axis_deg = standard.axis_deg;
  if (blank.prism_d == 0) blank.prism_base_deg = standard.prism_base_deg;
  if (blank.front != LensFrontForm::freeform) blank.corridor_mm = standard.corridor_mm;
}

json number_or_null(std::optional<double> value) {
  return value ? json(*value) : json(nullptr);
}

json pairs_json(const std::vector<glm::dvec2>& pairs) {
  json list = json::array();
  for (const glm::dvec2& p : pairs) list.push_back({p.x, p.y});
  return list;
}

std::vector<glm::dvec2> pairs_from(const json& list) {
  std::vector<glm::dvec2> pairs;
  for (const json& p : list) pairs.emplace_back(p.at(0).get<double>(), p.at(1).get<double>());
  return pairs;
}

json blank_json(LensBlank blank) {
  leave_out_idle(blank);
  json inputs;
  for (const BlankNumber& number : kBlankNumbers)
    inputs[number.column] =
        number.value ? json(blank.*number.value + 0.0) : number_or_null(blank.*number.optional_value);
  inputs["front"] = front_name(blank.front);
  inputs["asphere_mm"] = blank.asphere_mm;
  if (!blank.outline.empty()) inputs["outline_mm"] = pairs_json(blank.outline);
  return inputs;
}

LensBlank blank_from(const json& inputs) {
  LensBlank blank;
  for (const BlankNumber& number : kBlankNumbers) {
    const json& value = inputs.at(number.column);
    if (number.value)
      blank.*number.value = value.get<double>();
    else if (!value.is_null())
      blank.*number.optional_value = value.get<double>();
  }
  const auto front = front_from_name(inputs.at("front").get<std::string>());
  if (!front) refuse("has an unknown form of front");
  blank.front = *front;
  blank.asphere_mm = inputs.at("asphere_mm").get<std::vector<double>>();
  if (inputs.contains("outline_mm")) blank.outline = pairs_from(inputs.at("outline_mm"));
  return blank;
}

/// Indices that the evaluation uses: they are what a material is to it, whatever its name.
json index_json(const LensCase& lens_case) {
  const optics::Medium medium = lens_case.material.medium();
  return {{"index", medium.index(lens_case.options.wavelength_nm)},
          {"index_f", medium.index(optics::kLineF_nm)},
          {"index_c", medium.index(optics::kLineC_nm)}};
}

json gaze_json(const CaseGaze& gaze) {
  if (gaze.directions_deg.empty()) return {{"gaze_max_deg", gaze.max_deg}, {"gaze_step_deg", gaze.step_deg}};
  return {{"gaze_deg", pairs_json(gaze.directions_deg)}};
}

json faces_json(const std::vector<FaceSelector>& faces) {
  json list = json::array();
  for (const FaceSelector& face : faces) std::visit([&](const auto& value) { list.push_back(value); }, face);
  return list;
}

std::vector<FaceSelector> faces_from(const json& inputs, const char* key) {
  std::vector<FaceSelector> faces;
  if (inputs.contains(key))
    for (const json& face : inputs.at(key)) {
      if (face.is_string())
        faces.emplace_back(face.get<std::string>());
      else
        faces.emplace_back(face.get<int>());
    }
  return faces;
}

}  // namespace

optics::Medium CaseMaterial::medium() const {
  if (own) return *own;
  if (!name.empty()) return optics::built_in_media().find(name);
  return vd ? optics::abbe_medium(nd.value(), *vd) : optics::constant_medium(nd.value());
}

std::vector<glm::dvec2> CaseGaze::in_radians() const {
  if (directions_deg.empty()) return optics::gaze_grid(glm::radians(max_deg), glm::radians(step_deg));
  std::vector<glm::dvec2> directions;
  for (const glm::dvec2& d : directions_deg) directions.push_back(glm::radians(d));
  return directions;
}

optics::EvaluationOptions LensCase::evaluation_options() const {
  optics::EvaluationOptions result = options;
  result.position.pantoscopic_rad = glm::radians(panto_deg);
  result.position.wrap_rad = glm::radians(wrap_deg);
  result.threads = 1;  // cases run beside one another
  return result;
}

std::span<const BlankNumber> blank_numbers() {
  return kBlankNumbers;
}

std::string to_inputs(const LensCase& lens_case) {
  const optics::EvaluationOptions& o = lens_case.options;
  const optics::WearingPosition& p = o.position;
  json inputs = {{"kind", "lens"},
                 {"evaluation", kEvaluation},
                 {"mode", o.mode == optics::EvaluationMode::as_worn ? "as-worn" : "lensmeter"},
                 {"eye", p.eye == optics::Eye::right ? "right" : "left"},
                 {"rotation_centre_mm", p.rotation_centre_mm},
                 {"vertex_distance_mm", p.vertex_distance_mm},
                 {"panto_deg", lens_case.panto_deg},
                 {"wrap_deg", lens_case.wrap_deg},
                 {"object_distance_mm",
                  number_or_null(std::isfinite(o.object_distance_mm) ? std::optional(o.object_distance_mm)
                                                                     : std::nullopt)},
                 {"wavelength_nm", o.wavelength_nm},
                 {"material", lens_case.material.name},
                 {"nd", number_or_null(lens_case.material.nd)},
                 {"vd", number_or_null(lens_case.material.vd)}};
  inputs.update(index_json(lens_case));
  inputs.update(gaze_json(lens_case.gaze));
  if (lens_case.blank)
    inputs.update(blank_json(*lens_case.blank));
  else
    inputs["lens_sha256"] = lens_case.file_sha256;
  // Below: only where they are given, so that cases without them keep their keys.
  if (lens_case.material.own) {
    inputs["catalogue_sha256"] = lens_case.material.catalogue_sha256;
    inputs["glass"] = glass_json(*lens_case.material.own);
  }
  for (const auto& [key, faces] :
       {std::pair{"front_faces", &lens_case.front_faces}, {"back_faces", &lens_case.back_faces}})
    if (!lens_case.blank && !faces->empty()) inputs[key] = faces_json(*faces);
  return inputs.dump();
}

LensCase lens_case_from(std::string_view text) try {
  const json inputs = json::parse(text);
  if (inputs.at("kind") != "lens") refuse("is of another kind: " + inputs.at("kind").dump());
  if (inputs.at("evaluation") != kEvaluation) refuse("belongs to another version of the evaluation");
  const auto optional = [&](const char* key) {
    return inputs.at(key).is_null() ? std::nullopt : std::optional(inputs.at(key).get<double>());
  };
  LensCase result;
  result.material = {inputs.at("material").get<std::string>(), optional("nd"), optional("vd"), {}, {}};
  if (inputs.contains("glass")) {
    result.material.own =
        std::make_shared<const optics::Medium>(glass_from(inputs.at("glass"), result.material.name));
    result.material.catalogue_sha256 = inputs.at("catalogue_sha256").get<std::string>();
  }
  result.front_faces = faces_from(inputs, "front_faces");
  result.back_faces = faces_from(inputs, "back_faces");
  optics::EvaluationOptions& o = result.options;
  o.mode =
      inputs.at("mode") == "as-worn" ? optics::EvaluationMode::as_worn : optics::EvaluationMode::lensmeter;
  o.position.eye = inputs.at("eye") == "right" ? optics::Eye::right : optics::Eye::left;
  o.position.rotation_centre_mm = inputs.at("rotation_centre_mm").get<double>();
  o.position.vertex_distance_mm = inputs.at("vertex_distance_mm").get<double>();
  result.panto_deg = inputs.at("panto_deg").get<double>();
  result.wrap_deg = inputs.at("wrap_deg").get<double>();
  if (const auto distance = optional("object_distance_mm")) o.object_distance_mm = *distance;
  o.wavelength_nm = inputs.at("wavelength_nm").get<double>();
  if (inputs.contains("gaze_deg"))
    result.gaze.directions_deg = pairs_from(inputs.at("gaze_deg"));
  else
    result.gaze = {inputs.at("gaze_max_deg").get<double>(), inputs.at("gaze_step_deg").get<double>(), {}};
  if (inputs.contains("lens_sha256"))
    result.file_sha256 = inputs.at("lens_sha256").get<std::string>();
  else
    result.blank = blank_from(inputs);
  const json indices = index_json(result);
  for (const auto& [key, index] : indices.items())
    if (inputs.at(key) != index)
      throw Error("", "material", "has another index here than where the plan was read",
                  "use one version of Catoptra everywhere");
  return result;
} catch (const nlohmann::json::exception& failure) {
  refuse(std::string("is not readable: ") + failure.what());
}

std::span<const std::string> lens_input_columns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> names{"lens_sha256"};
    for (const BlankNumber& number : kBlankNumbers) names.emplace_back(number.column);
    for (const char* name : {"front",
                             "asphere_mm",
                             "material",
                             "nd",
                             "vd",
                             "index",
                             "index_f",
                             "index_c",
                             "mode",
                             "eye",
                             "rotation_centre_mm",
                             "vertex_distance_mm",
                             "panto_deg",
                             "wrap_deg",
                             "object_distance_mm",
                             "wavelength_nm",
                             "gaze_max_deg",
                             "gaze_step_deg",
                             "gaze_deg",
                             "front_faces",
                             "back_faces",
                             "outline_mm",
                             "catalogue_sha256"})
      names.emplace_back(name);
    return names;
  }();
  return columns;
}

}  // namespace catoptra::app
