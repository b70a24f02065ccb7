// Usage, exit codes and the documents that the program prints about itself.
#include <gtest/gtest.h>

#include "app/version.h"
#include "tests/app/command_runner.h"
#include "tests/app/test_scene.h"

namespace catoptra::test {
namespace {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t lines_in(const std::string& text) {
  return std::size_t(std::count(text.begin(), text.end(), '\n'));
}

const std::vector<std::vector<std::string>> kCommands{{},
                                                      {"info"},
                                                      {"render"},
                                                      {"compare"},
                                                      {"bench"},
                                                      {"lens"},
                                                      {"lens", "make"},
                                                      {"batch"},
                                                      {"batch", "run"},
                                                      {"batch", "status"},
                                                      {"batch", "export"},
                                                      {"mirror"},
                                                      {"mirror", "make"},
                                                      {"man"},
                                                      {"completion"}};

TEST(CommandLine, EveryCommandHasHelpAndVersion) {
  for (const auto& command : kCommands) {
    auto help = command, version = command;
    help.push_back("--help");
    version.push_back("--version");
    const CommandResult helped = run_catoptra(help);
    EXPECT_EQ(helped.code, 0);
    EXPECT_TRUE(holds(helped.output, "--log-level")) << helped.output;
    EXPECT_EQ(run_catoptra(version).output, "catoptra " + std::string(app::version()) + "\n");
  }
}

TEST(CommandLine, WrongUsageIsOneLineAndExitCode2) {
  const std::vector<std::vector<std::string>> wrong{
      {},
      {"nonsense"},
      {"render"},
      {"render", "scene.toml"},
      {"render", "scene.toml", "-o", "x.png", "--samples", "0"},
      {"render", "scene.toml", "-o", "x.png", "--overlay", "traced"},
      {"render", "scene.toml", "-o", "x.png", "--mode", "pvr"},
      {"render", "scene.toml", "-o", "x.png", "--overlay", "patches"},
      {"render", "scene.toml", "-o", "x.png", "--resolution", "12"},
      {"compare", "scene.toml", "-o", "out", "--modes", "pvrr,automatic"},
      {"compare", "scene.toml", "-o", "out", "--modes", "raytrace"},
      {"bench", "scene.toml", "--frames", "none"},
      {"info"},
      {"info", "x.step", "--no-such-option"},
      {"mirror"},
      {"mirror", "evaluate", "scene.toml", "--strict"},
      {"mirror", "evaluate", "scene.toml", "--rule", "R47"},
      {"mirror", "evaluate", "scene.toml", "--aim-limits", "5,-1"},
      {"mirror", "make", "--radius", "100", "--radius-h", "100", "--radius-v", "90", "-o", "m.step"},
      {"lens"},
      {"lens", "make", "--sph", "-2"},
      {"lens", "make", "--index", "1.6", "--material", "CR-39", "-o", "l.step"},
      {"lens", "make", "--front", "cone", "-o", "l.step"},
      {"render", "scene.toml", "-o", "x.jpg"},
      {"render", "scene.toml", "-o", "x.png", "--reference-threshold", "nan"},
      {"compare", "scene.toml", "-o", "out", "--max-error-arcmin", "-1"},
      {"mirror", "make", "-o", "m.foo"},
      {"mirror", "make", "--radius", "inf", "-o", "m.step"},
      {"mirror", "make", "--width", "0", "-o", "m.step"},
      {"mirror", "make", "--corner-radius", "-1", "-o", "m.step"},
      {"mirror", "make", "--outline", "round", "-o", "m.step"},
      {"lens", "make", "-o", "l.stl"},
      {"lens", "make", "--sph", "nan", "-o", "l.step"},
      {"lens", "make", "--asphere", "1e-8,inf", "-o", "l.step"},
      {"lens", "make", "--back", "cylinder", "-o", "l.step"},
      {"lens", "make", "--back", "toric", "--back-conic", "-1", "-o", "l.step"},
      {"batch", "run", "plan.toml"},
      {"batch", "run", "plan.toml", "--db", "r.sqlite", "--jobs", "-1"},
      {"batch", "status"},
      {"batch", "export", "--db", "r.sqlite"},
      {"batch", "report", "--db", "r.sqlite"},
      {"completion", "csh"},
  };
  for (const auto& arguments : wrong) {
    const CommandResult result = run_catoptra(arguments);
    std::string line;
    for (const std::string& argument : arguments) line += argument + " ";
    EXPECT_EQ(result.code, 2) << line << result.errors;
    EXPECT_EQ(lines_in(result.errors), 1u) << line << result.errors;
    EXPECT_EQ(result.errors.rfind("catoptra: ", 0), 0u) << line << result.errors;
  }
}

TEST(CommandLine, MisspeltWordsSuggestTheNearest) {
  struct Slip {
    std::vector<std::string> arguments;
    std::string told;
  };
  const std::vector<Slip> slips{
      {{"rendre", "s.toml"}, "unknown command 'rendre' (did you mean 'render'?; see catoptra --help)"},
      {{"lens", "mak", "-o", "x.step"},
       "unknown command 'mak' (did you mean 'make'?; see catoptra lens --help)"},
      {{"frobnicate"}, "unknown command 'frobnicate' (known: info, render, compare, bench, lens, mirror"},
      {{"render", "s.toml", "--outpt", "x.png"}, "unknown option '--outpt' (did you mean '--output'? see"},
      {{"mirror", "make", "--outline", "round", "-o", "m.step"},
       "did you mean 'rounded'? outlines: rect, rounded"},
      {{"lens", "make", "--outline", "round", "-o", "l.step"}, "round lenses: --diameter D"},
      {{"lens", "make", "--axis", "200", "-o", "l.step"}, "--axis: 200 is not between 0 and 180"},
      {{"lens", "make", "--material", "CR-93", "-o", "l.step"}, "CR-39"},
  };
  for (const Slip& slip : slips) {
    const CommandResult result = run_catoptra(slip.arguments);
    EXPECT_EQ(result.code, 2) << result.errors;
    EXPECT_TRUE(holds(result.errors, slip.told)) << result.errors;
    EXPECT_EQ(lines_in(result.errors), 1u) << result.errors;
  }
}

TEST(CommandLine, HelpSpeaksOfLensesToo) {
  EXPECT_TRUE(holds(run_catoptra({"--help"}).output, "mirror or a spectacle lens"));
}

TEST(CommandLine, SceneErrorsNameFileLineAndKeyAndExitWith1) {
  const TemporaryFolder folder;
  const auto scene = folder.write("bad.toml", "[camera]\nfov = 3\n").string();
  const CommandResult result = run_catoptra({"render", scene, "-o", (folder / "x.png").string()});
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.errors.rfind("catoptra: " + scene + ": line 2, camera.fov: unknown key", 0), 0u)
      << result.errors;
  EXPECT_EQ(lines_in(result.errors), 1u);
  EXPECT_EQ(run_catoptra({"render", (folder / "no.toml").string(), "-o", (folder / "x.png").string()}).code,
            1);
}

TEST(CommandLine, ResultsThatCannotBeWrittenAreErrors) {
  const TemporaryFolder folder;
  const auto mirror = write_test_mirror(folder, 400).string();
  EXPECT_EQ(run_catoptra({"mirror", "make", "-o", (folder / "no/folder/m.step").string()}).code, 1);
  EXPECT_EQ(run_catoptra({"render", "scene.toml", "-o", (folder / "no/folder/x.png").string()}).code, 1);
}

TEST(CommandLine, ManualPageNamesEveryCommandAndOption) {
  const CommandResult result = run_catoptra({"man"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.output.rfind(".TH CATOPTRA 1", 0), 0u);
  for (const char* part :
       {"catoptra render", "catoptra mirror make", "\\-\\-max\\-error\\-arcmin", ".SH EXIT STATUS"})
    EXPECT_TRUE(holds(result.output, part)) << part;
}

TEST(CommandLine, CompletionScriptsKnowTheCommands) {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const CommandResult result = run_catoptra({"completion", shell});
    EXPECT_EQ(result.code, 0);
    EXPECT_TRUE(holds(result.output, "compare")) << shell;
    EXPECT_TRUE(holds(result.output, "max-error-arcmin")) << shell;
  }
}

/// The bash script, run by bash: what completes "catoptra mirror make --radius".
TEST(CommandLine, BashCompletesOptionsOfTheCommandTyped) {
  const TemporaryFolder folder;
  folder.write("complete.bash", run_catoptra({"completion", "bash"}).output +
                                    "COMP_WORDS=(catoptra mirror make --radius-)\nCOMP_CWORD=3\n_catoptra\n"
                                    "printf '%s\\n' \"${COMPREPLY[@]}\"\n");
  const std::string output = (folder / "out").string();
  const std::string line =
      "bash " + shell_quoted((folder / "complete.bash").string()) + " >" + shell_quoted(output);
  ASSERT_EQ(std::system(line.c_str()), 0);
  EXPECT_EQ(read_file(output), "--radius-h\n--radius-v\n");
}

}  // namespace
}  // namespace catoptra::test
