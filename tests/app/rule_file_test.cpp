// Rule files: what the reader makes of them, every slip told by file, line and key, and the rules in the
// program.
#include "app/src/rule_file.h"

#include <gtest/gtest.h>

#include <regex>

#include "app/src/built_in_rules.h"
#include "app/src/lens_limits.h"
#include "app/src/mirror_rules.h"
#include "tests/app/temporary_folder.h"

namespace catoptra::app {
namespace {

const RuleVocabulary kWords{"bridge",
                            {{"load", {"t", "kN"}}, {"opening", {"m"}, {"width_m"}, {"height_m"}}},
                            {"road", "rail"},
                            {"span_m"}};

const std::string kHead =
    "format = 1\nid = \"B1\"\nkind = \"bridge\"\ntitle = \"Bridges\"\nedition = \"2nd\"\ndate = \"2020-05\"\n"
    "source = \"the office\"\n";  // seven lines

std::string figure(const std::string& more) {
  return kHead +
         "[[figure]]\nquantity = \"load\"\nclause = \"3.1\"\nunit = \"t\"\ncertainty = \"verified\"\n" + more;
}

TEST(RuleFile, EveryKeyIsRead) {
  const RuleFile rule = read_rule_text(
      figure(
          "value = 40\napplies_to = [\"road\"]\nwhen = { span_m = { above = 10, up_to = 20 } }\nsource = \"a "
          "page\"\nnote = \"dry\"\n") +
          "[[figure]]\nquantity = \"opening\"\nclause = \"4\"\nunit = \"m\"\nvalues = { width_m = 3, "
          "height_m = 4 "
          "}\ncertainty = \"cross-checked\"\n",
      "b1.toml", kWords);
  EXPECT_EQ(rule.id, "B1");
  EXPECT_EQ(rule.title, "Bridges");
  EXPECT_EQ(rule.edition, "2nd");
  EXPECT_EQ(rule.date, "2020-05");
  ASSERT_EQ(rule.figures.size(), 2u);
  const RuleFigure& load = rule.figures[0];
  EXPECT_EQ(load.value, 40);
  EXPECT_EQ(load.unit, "t");
  EXPECT_EQ(load.clause, "3.1");
  EXPECT_EQ(load.applies_to, std::vector<std::string>{"road"});
  EXPECT_EQ(load.source, "a page");
  EXPECT_EQ(load.note, "dry");
  EXPECT_EQ(load.certainty, Certainty::verified);
  EXPECT_EQ(load.line, 8u);
  EXPECT_EQ(rule.figures[1].source, "the office") << "the file's, where a figure has none of its own";
  EXPECT_EQ(rule.figures[1].values.at("width_m"), 3);
  EXPECT_EQ(rule.figures[1].certainty, Certainty::cross_checked);
}

TEST(RuleFile, FigureIsFoundByQuantityUseAndRange) {
  const std::string more =
      "[[figure]]\nquantity = \"load\"\nclause = \"3.2\"\nunit = \"t\"\ncertainty = \"unverified\"\nvalue = "
      "30\n"
      "when = { span_m = { above = 20 } }\n";
  const RuleFile rule = read_rule_text(
      figure("value = 40\napplies_to = [\"road\"]\nwhen = { span_m = { from = 10, up_to = 20 } }\n") + more,
      "b1.toml", kWords);
  const auto load = [&](const char* what, double span) {
    const RuleFigure* found = find_figure(rule, "load", what, {{"span_m", span}});
    return found ? *found->value : 0;
  };
  EXPECT_EQ(load("road", 10), 40) << "from: the bound itself belongs to it";
  EXPECT_EQ(load("road", 20), 40) << "up_to: too";
  EXPECT_EQ(load("road", 20.001), 30);
  EXPECT_EQ(load("road", 9.999), 0);
  EXPECT_EQ(load("rail", 15), 0) << "for roads only";
  EXPECT_EQ(load("rail", 25), 30) << "no applies_to: for everything";
  EXPECT_EQ(find_figure(rule, "opening", "road", {}), nullptr);
  EXPECT_EQ(find_figure(rule, "load", "road", {}), nullptr) << "an unknown span is in no range";
}

TEST(RuleFile, TwoFiguresForOneCaseAreAContradiction) {
  const RuleFile rule =
      read_rule_text(figure("value = 40\n") + figure("value = 41\n").substr(kHead.size()), "b1.toml", kWords);
  try {
    (void)find_figure(rule, "load", "road", {});
    FAIL() << "one of two was taken";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find("b1.toml: line 14, figure: 'load' has another value"), 0u)
        << error.what();
  }
}

struct BadRule {
  const char* name;
  std::string text;
  const char* entity;  ///< exactly
  const char* reason;  ///< part of the line
};

void PrintTo(const BadRule& bad, std::ostream* stream) {
  *stream << bad.name;
}

class BadRuleFile : public testing::TestWithParam<BadRule> {};

TEST_P(BadRuleFile, NamesFileLineAndKey) {
  try {
    (void)read_rule_text(GetParam().text, "bad.toml", kWords);
    FAIL() << "the rule was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), "bad.toml");
    EXPECT_EQ(error.entity(), GetParam().entity) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().reason), std::string::npos) << error.what();
  }
}

std::string without(const std::string& text, const std::string& line_start) {
  return std::regex_replace(text, std::regex("(^|\n)" + line_start + "[^\n]*"), "$1#");
}

const BadRule kBadRules[] = {
    {"NotToml", "format = \n", "line 1", "not valid TOML"},
    {"Empty", "", "line 1, format", "required"},
    {"OtherFormat", "format = 2\n" + kHead.substr(11), "line 1, format", "reads format 1"},
    {"OtherKind", std::regex_replace(kHead, std::regex("bridge"), "lens"), "line 3, kind",
     "one for 'bridge'"},
    {"NoFigures", kHead, "line 1, figure", "judges nothing"},
    {"NoSource", without(figure("value = 1\n"), "source"), "line 1, source", "required"},
    {"EmptyTitle", std::regex_replace(figure("value = 1\n"), std::regex("Bridges"), ""), "line 4, title",
     "empty"},
    {"UnknownKey", figure("valu = 40\n"), "line 13, figure.valu", "did you mean 'value'?"},
    {"NoValue", figure(""), "line 8, figure.value", "required"},
    {"ValueIsText", figure("value = \"40\"\n"), "line 13, figure.value", "expected a number"},
    {"ValueIsInfinite", figure("value = inf\n"), "line 13, figure.value", "finite"},
    {"NamesForAValue", figure("values = { width_m = 3 }\n"), "line 13, figure.values", "one value"},
    {"UnknownQuantity", std::regex_replace(figure("value = 1\n"), std::regex("load"), "laod"),
     "line 9, figure.quantity", "'laod' is not one of load, opening"},
    {"UnknownUnit", std::regex_replace(figure("value = 1\n"), std::regex("\"t\""), "\"lb\""),
     "line 11, figure.unit", "not one of t, kN"},
    {"UnknownCertainty", std::regex_replace(figure("value = 1\n"), std::regex("verified"), "sure"),
     "line 12, figure.certainty", "'sure' is not one of"},
    {"NoCertainty", without(figure("value = 1\n"), "certainty"), "line 8, figure.certainty", "required"},
    {"NoClause", without(figure("value = 1\n"), "clause"), "line 8, figure.clause", "required"},
    {"UnknownUse", figure("value = 1\napplies_to = [\"raill\"]\n"), "line 14, figure.applies_to",
     "did you mean 'rail'?"},
    {"NoUses", figure("value = 1\napplies_to = []\n"), "line 14, figure.applies_to", "array of names"},
    {"UnknownVariable", figure("value = 1\nwhen = { spam_m = { above = 1 } }\n"),
     "line 14, figure.when.spam_m", "did you mean 'span_m'?"},
    {"UnknownBound", figure("value = 1\nwhen = { span_m = { over = 1 } }\n"),
     "line 14, figure.when.span_m.over", "unknown key"},
    {"NumberForRange", figure("value = 1\nwhen = { span_m = 1 }\n"), "line 14, figure.when.span_m",
     "expected a range"},
    {"EmptyRange", figure("value = 1\nwhen = { span_m = {} }\n"), "line 14, figure.when.span_m", "no bound"},
    {"TwoLowerBounds", figure("value = 1\nwhen = { span_m = { above = 1, from = 2 } }\n"),
     "line 14, figure.when.span_m.from", "excludes above"},
    {"RangeUpsideDown", figure("value = 1\nwhen = { span_m = { above = 2, up_to = 2 } }\n"),
     "line 14, figure.when.span_m", "nothing lies"},
    {"MissingName",
     kHead + "[[figure]]\nquantity = \"opening\"\nclause = \"1\"\nunit = \"m\"\ncertainty = "
             "\"derived\"\nvalues = { "
             "height_m = 3 }\n",
     "line 13, figure.values", "'width_m' is missing"},
};

INSTANTIATE_TEST_SUITE_P(Slips, BadRuleFile, testing::ValuesIn(kBadRules),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(FindRule, BuiltInNameFileOrNearestName) {
  EXPECT_EQ(find_rule("ISO-8980-1-2004", lens_rule_words()).id, "iso-8980-1-2004");
  const test::TemporaryFolder folder;
  const auto file = folder.write("mine.toml", figure("value = 40\n"));
  EXPECT_EQ(find_rule(file.string(), kWords).file, file.string());
  EXPECT_THROW((void)find_rule("no/such.toml", kWords), Error);
  try {
    (void)find_rule("iso-8980-1-2005", lens_rule_words());
    FAIL();
  } catch (const UnknownRule& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'iso-8980-1-2004'?"), std::string::npos)
        << error.what();
  }
}

TEST(BuiltInRules, UnknownNamesGetTheNearestAndTheWholeList) {
  const auto hint = [](const std::string& name, const RuleVocabulary& words) {
    try {
      (void)find_rule(name, words);
    } catch (const UnknownRule& error) {
      return error.hint();
    }
    return std::string("no error");
  };
  const std::string mirrors =
      "built in: FMVSS111-driver, FMVSS111-inside, FMVSS111-passenger, R46-I, R46-II, R46-III, R46-IV, "
      "R46-V; "
      "or the name of a rule file";
  const std::string lenses =
      "built in: ansi-z80.1-2015, iso-21987-2017, iso-8980-1-2004, iso-8980-2-2004; or the name of a rule "
      "file";
  EXPECT_EQ(hint("R46III", mirror_rule_words()), "did you mean 'R46-III'? " + mirrors);
  EXPECT_EQ(hint("fmvss 111 drivr", mirror_rule_words()), "did you mean 'FMVSS111-driver'? " + mirrors);
  EXPECT_EQ(hint("R46-VI", mirror_rule_words()), mirrors) << "I, V and II are one letter away";
  EXPECT_EQ(hint("iso-21987-2004", mirror_rule_words()), mirrors);
  EXPECT_EQ(hint("iso-8980", lens_rule_words()),
            "did you mean 'iso-8980-1-2004' or 'iso-8980-2-2004'? " + lenses);
  EXPECT_EQ(hint("iso8980-1", lens_rule_words()), "did you mean 'iso-8980-1-2004'? " + lenses);
  EXPECT_EQ(hint("ansi-z80", lens_rule_words()), "did you mean 'ansi-z80.1-2015'? " + lenses);
  EXPECT_EQ(hint("r46-iii", lens_rule_words()), lenses) << "it judges mirrors";
  EXPECT_EQ(hint("", lens_rule_words()), lenses);
}

TEST(BuiltInRules, AllLensRulesAreReadAndNamedAsTheirFiles) {
  const auto ids = built_in_rules("lens");
  EXPECT_EQ(ids, (std::vector<std::string>{"ansi-z80.1-2015", "iso-21987-2017", "iso-8980-1-2004",
                                           "iso-8980-2-2004"}));
  for (const std::string& id : ids) {
    const RuleFile rule = find_rule(id, lens_rule_words());
    EXPECT_EQ(rule.id, id);
    EXPECT_GT(rule.figures.size(), 10u) << id;
  }
}

}  // namespace
}  // namespace catoptra::app
