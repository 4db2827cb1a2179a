/** Bad input ends in one clear line, and what is valid or was there before is kept. */
#include <algorithm>

#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

TEST_F(CliTest, RefusesBadCommandLines) {
  expectRefused(run({}), "subcommand");
  expectRefused(run({"frobnicate"}), "frobnicate");
  expectRefused(run({"map"}), "required");
  expectRefused(run({"map", log("room.rawlog")}), "--output");
  expectRefused(run({"map", log("room.rawlog"), "-o", path("out"), "--nonsense"}), "--nonsense");
  expectRefused(run({"map", "a.rawlog", "b.rawlog", "-o", path("out")}), "b.rawlog");
  expectRefused(run({"map", "a.ini", "-o", path("out")}), "no rawlog");
  expectRefused(run({"map", log("room.rawlog"), "-o", path("out"), "--threads", "0"}), "--threads");
  expectRefused(run({"eval", path("t.tum")}), "--relations");
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(CliTest, RefusesBadLogs) {
  writeFile(path("empty.rawlog"), "");
  writeFile(path("text.rawlog"), "This is no log at all, but some text that a user gave by mistake.\n");
  for (const char* command : {"map", "build"}) {
    expectRefused(run({command, path("missing.rawlog"), "-o", path("out")}), "missing.rawlog: no such file");
    expectRefused(run({command, path("empty.rawlog"), "-o", path("out")}), "empty.rawlog");
    expectRefused(run({command, path("text.rawlog"), "-o", path("out")}), "text.rawlog");
    expectRefused(run({command, path("output"), "-o", path("out")}), "folder");
    expectRefused(run({command, log("room.rawlog"), "-o", path("out"), "--from", "9999999"}), "9999999");
    expectRefused(run({command, log("room.rawlog"), "-o", path("out"), "--sensor", "SONAR"}), "SONAR");
  }
  EXPECT_FALSE(fs::exists(path("out"))) << "nothing must be written for a log of no use";
  expectRefused(run({"check", path("missing.rawlog")}), "missing.rawlog");
}

TEST_F(CliTest, RefusesBadConfigurations) {
  const auto with = [&](const Arguments& extra) {
    Arguments arguments{"map", log("room.rawlog"), "-o", path("out")};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    return run(arguments);
  };
  writeFile(path("unknown.ini"), "[submaps]\nmax_distence = 3\n");
  writeFile(path("value.ini"), "[submaps]\nmax_distance = far\n");
  expectRefused(with({"-c", path("unknown.ini")}), "did you mean [submaps] max_distance?");
  expectRefused(with({"-c", path("value.ini")}), "far");
  expectRefused(with({"-c", path("missing.ini")}), "missing.ini");
  expectRefused(with({"--set", "submaps.max_distence=3"}), "did you mean [submaps] max_distance?");
  expectRefused(with({"--set", "submaps.max_distance=-1"}), "max_distance");
  expectRefused(with({"--set", "nonsense"}), "section.key=value");
  expectRefused(with({"--set", "joining.chain=magic"}), "magic");
  expectRefused(with({"--from", "soon"}), "soon");
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(CliTest, RefusesConfigurationsThatSaySomethingElseThanTheyDo) {
  const auto with_ini = [&](const std::string& content) {
    writeFile(path("my.ini"), content);
    return run({"map", log("room.rawlog"), "-o", path("out"), "-c", path("my.ini")});
  };
  expectRefused(with_ini("[submaps]\nmax_distance 3\n"), "my.ini:2: 'max_distance 3'");
  expectRefused(with_ini("[submap]\n"), "my.ini:1: unknown section [submap]; did you mean [submaps]?");
  expectRefused(with_ini("[submaps]\nmax_distance = 3\nmax_distance = 4\n"), "my.ini:3: ");
  expectRefused(run({"map", log("room.rawlog"), "-o", path("out"), "--seed", "-1"}), "[run] seed = '-1'");
  EXPECT_FALSE(fs::exists(path("out")));
}

/** One line that names the file and harms no terminal. */
void expectPrintable(const std::string& message, const std::string& file) {
  EXPECT_THAT(message, HasSubstr(file));
  EXPECT_LT(message.size(), 1200u);
  EXPECT_EQ(
      std::count_if(message.begin(), message.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e; }), 1)
      << "only the end of the line";
}

TEST_F(CliTest, NeverPrintsTheBytesOfBinaryFiles) {
  const Outcome configured = run({"map", log("room.rawlog"), "-o", path("out"), "-c", log("loop.rawlog")});
  expectRefused(configured, "expected an ini file");
  expectPrintable(configured.err, "loop.rawlog");

  const Outcome judged = run({"eval", log("loop.rawlog"), "--reference", log("loop.truth.tum")});
  expectRefused(judged, "loop.rawlog:1: is no text");
  expectPrintable(judged.err, "loop.rawlog");

  writeFile(path("bell.tum"), "\x1b[31m\x07-\xff-\xc3 " + std::string(100000, 'x') + "\n");
  const Outcome long_line = run({"eval", path("bell.tum"), "--reference", path("bell.tum")});
  expectRefused(long_line, "'?[31m?-?-?' is not a finite number");
  expectPrintable(long_line.err, "bell.tum");

  const std::string umlaut = "\xc3\xbc.rawlog";
  expectRefused(run({"check", path(umlaut)}), umlaut + ": no such file");
}

TEST_F(CliTest, RefusesToMapNothing) {
  for (const char* setting : {"mapper.max_range=0.01", "reader.min_range=1000"}) {
    const Arguments arguments = quickly({"map", log("room.rawlog"), "-o", path("out"), "--set", setting});
    fs::remove_all(path("out"));
    expectRefused(run(arguments), "the map would be empty");
    EXPECT_FALSE(fs::exists(path("out/map.png")));
  }
  succeed(quickly({"map", log("room.rawlog"), "-o", path("out"), "--overwrite"}));
  const std::string map = contentOf(path("out/map.png"));
  expectRefused(run(quickly({"map", log("room.rawlog"), "-o", path("out"), "--overwrite", "--set",
                             "reader.min_range=1000"})),
                "the map would be empty");
  EXPECT_TRUE(contentOf(path("out/map.png")) == map);
}

TEST_F(CliTest, RefusesBadPlugins) {
  writeFile(path("text.so"), "no library");
  for (const Arguments& arguments :
       {Arguments{"--list-joiners"}, Arguments{"map", log("room.rawlog"), "-o", path("out")}}) {
    const auto with = [&](const std::string& plugin) {
      Arguments all = arguments;
      all.insert(all.end(), {"-p", plugin});
      return run(all);
    };
    expectRefused(with(path("missing.so")), "missing.so: no such file");
    expectRefused(with(path("text.so")), "text.so");
  }
}

TEST_F(CliTest, RefusesFilesThatAreNoSubmaps) {
  expectRefused(run({"info", log("room.rawlog")}), "room.rawlog");
  expectRefused(run({"info", path("missing.rawlog")}), "missing.rawlog");
  expectRefused(run({"join", log("room.rawlog"), "-o", path("out")}), "room.rawlog");
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(CliTest, RefusesBadTrajectories) {
  writeFile(path("bad.tum"), "0 0 0 0 0 0 0 1\n1 nan\n");
  writeFile(path("good.tum"), "0 0 0 0 0 0 0 1\n");
  writeFile(path("later.relations"), "5000 5001 1 0 0 0 0 0\n");
  expectRefused(run({"eval", path("bad.tum"), "--reference", path("good.tum")}), "bad.tum:2");
  expectRefused(run({"eval", path("good.tum"), "--reference", path("missing.tum")}), "missing.tum");
  expectRefused(run({"eval", path("good.tum"), "--relations", path("later.relations")}), "same log");
}

TEST_F(CliTest, RefusesLimitsThatNoRelationMeets) {
  writeFile(path("t.tum"), "0 0 0 0 0 0 0 1\n10 1 0 0 0 0 0 1\n");
  writeFile(path("r.relations"), "0 10 1 0 0 0 0 0\n");
  const auto with = [&](const Arguments& limits) {
    Arguments arguments{"eval", path("t.tum"), "--relations", path("r.relations")};
    arguments.insert(arguments.end(), limits.begin(), limits.end());
    return run(arguments);
  };
  for (const char* option : {"--min-dt", "--max-dt", "--split"}) expectRefused(with({option, "-5"}), option);
  expectRefused(with({"--max-dt", "5"}), "--max-dt");
  expectRefused(with({"--min-dt", "20"}), "--min-dt");
}

TEST_F(CliTest, KeepsWhatIsThere) {
  fs::create_directory(path("out"));
  writeFile(path("out/map.png"), "precious");
  writeFile(path("out/mine.txt"), "mine");
  expectRefused(run(quickly({"map", log("room.rawlog"), "-o", path("out")})), "--overwrite");
  EXPECT_EQ(contentsOf(path("out")).size(), 2u);
  EXPECT_EQ(contentOf(path("out/map.png")), "precious");

  succeed(quickly({"map", log("room.rawlog"), "-o", path("out"), "--overwrite"}));
  EXPECT_NE(contentOf(path("out/map.png")), "precious");
  EXPECT_EQ(contentOf(path("out/mine.txt")), "mine");
}

TEST_F(CliTest, NeverWritesSubmapsOverTheLog) {
  fs::copy_file(log("room.rawlog"), path("log.rawlog"));
  expectRefused(run({"build", path("log.rawlog"), "-o", path("log.rawlog"), "--overwrite"}), "log itself");
  EXPECT_TRUE(contentOf(path("log.rawlog")) == contentOf(log("room.rawlog")));
}

TEST_F(CliTest, MapsADamagedLogUpToTheDamage) {
  const std::string whole = contentOf(log("room.rawlog"));
  writeFile(path("cut.rawlog"), whole.substr(0, whole.size() / 2));
  const Outcome outcome =
      run({"map", path("cut.rawlog"), "-o", path("out"), "-q", "--set", "joining.chain="});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(lines(outcome.err), 1u) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("submap-slam: warning: " + path("cut.rawlog")));
  EXPECT_GT(lines(contentOf(path("out/trajectory.tum"))), 200u);
  EXPECT_THAT(contentOf(path("out/log.txt")), HasSubstr("warning: "));
  EXPECT_EQ(run({"check", path("cut.rawlog")}).exit_code, 3);
}

TEST_F(CliTest, JoinsADamagedFileOfSubmapsUpToTheDamage) {
  succeed(quickly({"build", log("room.rawlog"), "-o", path("s.rawlog")}));
  const std::string whole = contentOf(path("s.rawlog"));
  writeFile(path("cut.rawlog"), whole.substr(0, whole.size() / 2));
  EXPECT_EQ(run({"join", path("cut.rawlog"), "-o", path("out"), "-q"}).exit_code, 3);
  EXPECT_TRUE(fs::exists(path("out/map.png")));
  EXPECT_EQ(run({"info", path("cut.rawlog")}).exit_code, 3);
}

}  // namespace
}  // namespace submap_slam::testing
