#include <gmock/gmock.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/parameters.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "../support/temp_folder.h"

namespace submap_slam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Settings {
  double range = 12.5;
  int count = 7;
  uint64_t seed = 1;
  bool refine = true;
  std::string scheme = "systematic";
  std::string label;
};

class Parameters : public ::testing::Test {
 protected:
  Parameters() {
    table.section("scanner", "What the scanner gives");
    table.add("range", settings.range, "m", {0.5, 100}, "Longest range");
    table.add("count", settings.count, "", {1, 1000}, "Number of beams");
    table.section("filter", "The filter");
    table.add("seed", settings.seed, "Seed of the random generator");
    table.add("refine", settings.refine, "Match twice");
    table.add("scheme", settings.scheme, "Resampling scheme", {"systematic", "residual"});
    table.add("label", settings.label, "Sensor label");
  }

  /** The message of the ConfigError that an action must throw. */
  template <class Action>
  static std::string refusal(Action action) {
    try {
      action();
    } catch (const ConfigError& e) {
      return e.what();
    }
    ADD_FAILURE() << "no ConfigError";
    return {};
  }
  std::string refused(const std::string& assignment) {
    return refusal([&] { table.set(assignment); });
  }

  Settings settings;
  ParameterTable table;
  TempFolder temp;
};

TEST_F(Parameters, SetEveryKindOfValueFromText) {
  table.set("scanner", "range", "8.25");
  table.set("scanner", "count", " 360 ");
  table.set("filter", "seed", "18446744073709551615");
  table.set("filter", "refine", "No");
  table.set("filter", "scheme", "residual");
  table.set("filter", "label", "two words");
  EXPECT_EQ(settings.range, 8.25);
  EXPECT_EQ(settings.count, 360);
  EXPECT_EQ(settings.seed, std::numeric_limits<uint64_t>::max());
  EXPECT_FALSE(settings.refine);
  EXPECT_EQ(settings.scheme, "residual");
  EXPECT_EQ(settings.label, "two words");
}

TEST_F(Parameters, ChoicesThatAreListsHaveAnyOrderAndSpacing) {
  std::string maps = "auto";
  table.add("maps", maps, "Forms", {"auto", "grid", "landmarks", "grid, landmarks"});
  for (const char* text : {"grid, landmarks", "grid,landmarks", "landmarks , grid", "landmarks,grid"}) {
    maps = "auto";
    table.set("filter", "maps", text);
    EXPECT_EQ(maps, "grid, landmarks") << text;
  }
  table.set("filter", "maps", "landmarks");
  EXPECT_EQ(maps, "landmarks");
  for (const char* text : {"", "grid, grid", "auto, grid", "grid, landmarks, auto"})
    EXPECT_THAT(refused(std::string("filter.maps=") + text),
                HasSubstr("expected one of 'auto', 'grid', 'landmarks', 'grid, landmarks'"));
}

TEST_F(Parameters, TakeAssignmentsOfTheCommandLine) {
  table.set("scanner.range=3e1");
  table.set(" filter . label = a.b=c ");
  EXPECT_EQ(settings.range, 30);
  EXPECT_EQ(settings.label, "a.b=c");
}

TEST_F(Parameters, RefuseAnAssignmentWithoutSectionOrValue) {
  for (const char* text : {"range=3", "scanner.range", "", "=", "a=b.c"})
    EXPECT_THAT(refused(text), HasSubstr("expected section.key=value")) << text;
}

TEST_F(Parameters, RefuseWhatIsNoNumber) {
  for (const char* text : {"", "3x", "x", "1 2", "0x10", "--3"})
    EXPECT_THAT(refused(std::string("scanner.range=") + text), HasSubstr("[scanner] range")) << text;
  for (const char* text : {"2.5", "", "1e2", "99999999999"})
    EXPECT_THAT(refused(std::string("scanner.count=") + text), HasSubstr("[scanner] count")) << text;
  EXPECT_THAT(refused("filter.seed=-1"), HasSubstr("[filter] seed"));
  EXPECT_THAT(refused("filter.refine=maybe"), HasSubstr("true or false"));
  EXPECT_EQ(settings.range, 12.5);
  EXPECT_EQ(settings.count, 7);
}

TEST_F(Parameters, RangeIncludesItsEndsAndNothingBeyond) {
  table.set("scanner.range=0.5");
  table.set("scanner.range=100");
  EXPECT_THAT(refused("scanner.range=0.499"), AllOf(HasSubstr("[scanner] range"), HasSubstr("[0.5, 100] m")));
  refused("scanner.range=100.001");
  refused("scanner.range=nan");
  refused("scanner.range=inf");
  refused("scanner.count=0");
  EXPECT_EQ(settings.range, 100);
}

TEST_F(Parameters, RefuseAnUnknownChoiceAndListTheKnownOnes) {
  EXPECT_THAT(refused("filter.scheme=stratified"),
              AllOf(HasSubstr("[filter] scheme"), HasSubstr("'systematic', 'residual'")));
  EXPECT_EQ(settings.scheme, "systematic");
}

TEST_F(Parameters, NameTheNearestKeyForAnUnknownOne) {
  EXPECT_THAT(refused("scanner.rnage=1"), HasSubstr("did you mean [scanner] range?"));
  EXPECT_THAT(refused("filer.seed=1"), HasSubstr("did you mean [filter] seed?"));
  EXPECT_THAT(refused("filter.range=1"), HasSubstr("unknown key [filter] range"));
}

TEST_F(Parameters, AnEmptyTableKnowsNoNearestKey) {
  ParameterTable empty;
  EXPECT_THAT(refusal([&] { empty.set("a.b=c"); }),
              AllOf(HasSubstr("[a] b"), Not(HasSubstr("did you mean"))));
}

TEST_F(Parameters, LoadWhatAnIniFileHoldsAndKeepTheRest) {
  table.loadIni(
      temp.write("some.ini", "# comment\n[filter]\nrefine = false\n; another\n\n[scanner]\nrange=20\n"));
  EXPECT_EQ(settings.range, 20);
  EXPECT_FALSE(settings.refine);
  EXPECT_EQ(settings.count, 7);
}

TEST_F(Parameters, AnIniFileThatIsNotThereIsAnInputError) {
  EXPECT_THROW(table.loadIni(temp.file("none.ini")), InputError);
  EXPECT_THROW(table.loadIni(temp.file("")), InputError) << "a folder";
}

TEST_F(Parameters, AnErrorInAnIniFileNamesFileAndKey) {
  const std::string file = temp.write("bad.ini", "[scanner]\nrange = far\n");
  EXPECT_THAT(refusal([&] { table.loadIni(file); }),
              AllOf(HasSubstr(file + ":2: "), HasSubstr("[scanner] range")));
  const std::string unknown = temp.write("unknown.ini", "[scanner]\nrang = 3\n");
  EXPECT_THAT(refusal([&] { table.loadIni(unknown); }), HasSubstr("did you mean [scanner] range?"));
}

TEST_F(Parameters, LoadAnIniFileWithCommentsBehindValuesAndBlanksAnywhere) {
  table.loadIni(temp.write("some.ini",
                           "\xEF\xBB\xBF; as an editor of Windows writes it\r\n"
                           " [scanner]  // what it gives\r\n\trange\t= 20 // m\r\n count=9\n"));
  EXPECT_EQ(settings.count, 9);
  EXPECT_EQ(settings.range, 20);
}

TEST_F(Parameters, AValueEndsWhereACommentBegins) {
  table.loadIni(temp.write("some.ini",
                           "// c\n[filter]\nlabel = LASER #1;a//b ; comment = 3\nscheme=residual\t// c\n"
                           "[scanner]\ncount = 9 ;\n"));
  EXPECT_EQ(settings.label, "LASER #1;a//b");
  EXPECT_EQ(settings.scheme, "residual");
  EXPECT_EQ(settings.count, 9);
  table.loadIni(temp.write("empty.ini", "[filter]\nlabel = ; nothing\n"));
  EXPECT_EQ(settings.label, "");
}

TEST_F(Parameters, LinesOfAnIniFileThatSayNothingAreRefused) {
  const auto refused_line = [&](const std::string& content) {
    const auto file = temp.write("bad.ini", content);
    return refusal([&] { table.loadIni(file); });
  };
  EXPECT_THAT(refused_line("[scanner]\n\nrange 20\n"),
              AllOf(HasSubstr("bad.ini:3: "), HasSubstr("'range 20'"), HasSubstr("key = value")));
  EXPECT_THAT(refused_line("[scanner]\n= 20\n"), HasSubstr("bad.ini:2: "));
  EXPECT_THAT(refused_line("# c\n[scanner\nrange = 20\n"), HasSubstr("bad.ini:2: '[scanner': expected"));
  EXPECT_THAT(refused_line("range = 20\n"), AllOf(HasSubstr("bad.ini:1: "), HasSubstr("[section]")));
  EXPECT_THAT(refused_line("[scaner]\n"),
              AllOf(HasSubstr("bad.ini:1: "), HasSubstr("did you mean [scanner]?")));
  EXPECT_THAT(refused_line("[scanner]\nrange = 20\n[filter]\n[scanner]\nrange = 20\n"),
              AllOf(HasSubstr("bad.ini:5: "), HasSubstr("[scanner] range"), HasSubstr("line 2")));
}

TEST_F(Parameters, TheWrittenIniFileGivesTheSameBitsBack) {
  settings.range = 0.1 + 0.7;  // not 0.8
  settings.seed = 0xfedcba9876543210ull;
  settings.refine = false;
  settings.label = "LASER_1";
  std::ostringstream written;
  table.writeIni(written);
  const Settings expected = settings;
  settings = Settings{};
  table.loadIni(temp.write("effective.ini", written.str()));
  EXPECT_EQ(settings.range, expected.range);
  EXPECT_EQ(settings.count, expected.count);
  EXPECT_EQ(settings.seed, expected.seed);
  EXPECT_EQ(settings.refine, expected.refine);
  EXPECT_EQ(settings.label, expected.label);
  std::ostringstream again;
  table.writeIni(again);
  EXPECT_EQ(again.str(), written.str());
}

TEST_F(Parameters, TheReferenceHasARowForEveryKey) {
  std::ostringstream reference;
  table.writeReference(reference);
  EXPECT_THAT(reference.str(), HasSubstr("## [scanner]\n\nWhat the scanner gives"));
  EXPECT_THAT(reference.str(), HasSubstr("| `range` | `12.5` | m | 0.5 … 100 | Longest range |"));
  EXPECT_THAT(reference.str(), HasSubstr("| `scheme` | `systematic` |  | `systematic`, `residual` |"));
  EXPECT_THAT(reference.str(), HasSubstr("| `seed` | `1` |  | ≥ 0 |"));
}

TEST_F(Parameters, AKeyBeforeAnySectionIsAProgrammingError) {
  ParameterTable fresh;
  EXPECT_THROW(fresh.add("refine", settings.refine, ""), std::logic_error);
}

}  // namespace
}  // namespace submap_slam
