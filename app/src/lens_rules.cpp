#include "app/src/lens_rules.h"

namespace catoptra::app {

const RuleVocabulary& lens_rule_words() {
  static const RuleVocabulary words{
      "lens",
      {
          {"meridian_power", {"D", "%"}},
          {"sphere", {"D", "%"}},
          {"cylinder", {"D", "%"}},
          {"axis", {"deg"}},
          {"prism", {"prism dioptre", "mm"}},
          {"prism_horizontal", {"prism dioptre"}, {"constant", "per_dioptre"}},
          {"prism_vertical", {"prism dioptre"}, {"constant", "per_dioptre"}},
          {"addition", {"D"}},
          {"base_curve", {"D"}},
          {"center_thickness", {"mm"}},
      },
      {"single vision", "multifocal", "progressive"},
      {"highest_meridian_d", "sphere_d", "cylinder_d", "prism_d", "addition_d"}};
  return words;
}

}  // namespace catoptra::app
