// The documents agree with the program: every option and every key.
#include <gtest/gtest.h>

#include <regex>

#include "app/scene_file.h"
#include "app/src/lens_limits.h"
#include "cad_import/error.h"
#include "tests/app/command_runner.h"
#include "tests/app/lens_evaluate_files.h"
#include "tests/app/test_scene.h"

namespace catoptra::test {
namespace {

std::string document(const std::string& name) {
  return read_file(std::filesystem::path(CATOPTRA_DOCUMENTS) / name);
}

std::vector<std::string> all_matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match)
    found.push_back((*match)[1]);
  return found;
}

TEST(Documentation, NamesEveryOptionOfTheCommandLine) {
  const std::string text = document("command-line.md");
  const auto options = all_matches(run_catoptra({"completion", "fish"}).output, " -l ([a-z-]+)");
  ASSERT_GT(options.size(), 30u);
  for (const std::string& option : options) EXPECT_NE(text.find("--" + option), std::string::npos) << option;
}

TEST(Documentation, NamesEveryCommand) {
  const std::string text = document("command-line.md");
  for (const char* command :
       {"info", "render", "compare", "bench", "lens make", "lens evaluate", "mirror make", "mirror evaluate",
        "batch run", "batch status", "batch export", "batch report", "man", "completion"})
    EXPECT_NE(text.find("## catoptra " + std::string(command)), std::string::npos) << command;
}

/// Each key that has a section is known to the reader: a date as its value is a wrong type, not an unknown
/// key.
TEST(Documentation, EveryKeyOfTheSceneFileIsRead) {
  const std::string text = document("scene-file.md");
  std::size_t keys = 0;
  for (const std::string& heading : all_matches(text, "\n### ([^\n]+)"))
    for (const std::string& full_key : all_matches(heading, "([a-z]+\\.[a-z_]+)")) {
      const auto dot = full_key.find('.');
      const std::string table = full_key.substr(0, dot), key = full_key.substr(dot + 1);
      const bool single =
          table == "camera" || table == "environment" || table == "render" || table == "evaluation";
      std::string scene(single ? "[" : "[[");
      scene.append(table).append(single ? "]\n" : "]]\n").append(key).append(" = 2020-01-01\n");
      try {
        (void)app::read_scene_text(scene, "scene.toml", ".");
        ADD_FAILURE() << full_key << " takes a date";
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find("unknown key"), std::string::npos) << error.what();
      }
      ++keys;
    }
  EXPECT_GT(keys, 45u);
}

TEST(Documentation, ExampleSceneReads) {
  const TemporaryFolder folder;
  const std::string text = document("scene-file.md");
  const auto begin = text.find("```toml\n") + 8;
  std::string scene = text.substr(begin, text.find("```", begin) - begin);
  scene = std::regex_replace(scene, std::regex("street\\.glb"), "wall.obj");
  write_test_wall(folder);
  write_test_mirror(folder, 1200, "door_mirror.step");
  EXPECT_EQ(app::read_scene_text(scene, "scene.toml", folder.path()).scene.optics.size(), 1u);
}

TEST(Documentation, ExampleRuleReads) {
  const std::string text = document("rules.md");
  const auto begin = text.find("```toml\n") + 8;
  const auto rule = app::read_rule_text(text.substr(begin, text.find("```", begin) - begin), "rules.md",
                                        app::lens_rule_words());
  EXPECT_EQ(rule.figures.size(), 3u);
  for (const auto& quantity : app::lens_rule_words().quantities)
    EXPECT_NE(text.find("`" + quantity.name + "`"), std::string::npos) << quantity.name;
  for (const std::string& id : app::built_in_rules("lens"))
    EXPECT_NE(text.find("`" + id + "`"), std::string::npos) << id;
}

void expect_named(const nlohmann::json& value, const std::string& text) {
  if (value.is_array() && !value.empty()) expect_named(value.front(), text);
  if (!value.is_object()) return;
  for (const auto& [key, inner] : value.items()) {
    if (key == "versions") continue;
    EXPECT_TRUE(text.find("`" + key + "`") != std::string::npos ||
                text.find("`." + key + "`") != std::string::npos ||
                text.find("`" + key + "[]`") != std::string::npos)
        << key;
    expect_named(inner, text);
  }
}

TEST(Documentation, NamesEveryFieldOfALensReport) {
  const TemporaryFolder folder;
  const std::string file = make_lens(folder, {"--sph", "1", "--add", "1"});
  const nlohmann::json report = evaluate(
      file, {"--index", "1.5", "--rule", "ansi-z80.1-2015", "--ordered-sph", "1", "--ordered-add", "1"});
  ASSERT_GT(report.at("limits").size(), 3u);
  expect_named(report, document("reports.md"));
}

}  // namespace
}  // namespace catoptra::test
