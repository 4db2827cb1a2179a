/** Logs of other programs become rawlogs that can be checked and mapped. */
#include <cmath>
#include <sstream>

#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class ImportTest : public CliTest {
 protected:
  /** Ranges of a robot at x in a room from (−4, −3) to (6, 3) that looks along x: one beam per degree. */
  static std::string ranges(double x) {
    std::ostringstream text;
    for (int degree = -90; degree < 90; ++degree) {
      const double c = std::cos(degree * M_PI / 180), s = std::sin(degree * M_PI / 180);
      const double ahead = c > 1e-9 ? (6 - x) / c : 1e9, aside = std::abs(s) > 1e-9 ? 3 / std::abs(s) : 1e9;
      text << ' ' << std::min(ahead, aside);
    }
    return text.str();
  }

  /** A CARMEN log of a drive by 2 m, one stamp of which runs backwards. */
  std::string carmenLog() const {
    std::ostringstream log;
    log.precision(15);
    log << "# a drive\nPARAM robot_front_laser_max 50 host 0\n";
    for (int k = 0; k < 40; ++k) {
      const double x = 0.05 * k, stamp = 1000 + 0.2 * (k == 20 ? 3 : k);
      log << "FLASER 180" << ranges(x) << ' ' << x << " 0 0 " << x << " 0 0 " << stamp << " host " << k
          << '\n';
    }
    writeFile(path("drive.log"), log.str());
    return path("drive.log");
  }
};

TEST_F(ImportTest, CarmenLogIsImportedCheckedAndMapped) {
  const Outcome outcome = succeed({"import", carmenLog(), "-o", path("drive.rawlog")});
  EXPECT_THAT(outcome.err, HasSubstr("form: carmen"));
  EXPECT_THAT(outcome.err, HasSubstr("40 scans of LASER"));
  EXPECT_THAT(outcome.err, HasSubstr("submap-slam: warning: LASER: 1 of 40 ipc_timestamps do not increase"));
  const std::string report = succeed({"check", path("drive.rawlog")}).out;
  EXPECT_THAT(report, HasSubstr("40 frames in 7.8 s"));
  EXPECT_THAT(report, HasSubstr("180 beams over 179.00 deg, max. range 50.00 m"));
  EXPECT_THAT(report, HasSubstr("path 1.9 m"));
  succeed({"map", path("drive.rawlog"), "-o", path("out"), "--set", "joining.chain=", "-q"});
  std::istringstream trajectory(contentOf(path("out/trajectory.tum")));
  std::string line, last;
  while (std::getline(trajectory, line)) last = line;
  std::istringstream words(last);
  double stamp = 0, x = 0, y = 0;
  words >> stamp >> x >> y;
  EXPECT_NEAR(stamp, 1007.8, 1e-3);
  EXPECT_NEAR(x, 1.95, 0.02);
  EXPECT_NEAR(y, 0, 0.02);
}

TEST_F(ImportTest, DamagedLinesAreNamedAndTheRestIsThere) {
  std::string text = contentOf(carmenLog());
  text.resize(text.size() - 200);
  writeFile(path("cut.log"), text);
  const Outcome outcome = run({"import", path("cut.log"), "-o", path("cut.rawlog"), "-q"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("cut.log:42: the line ends before"));
  EXPECT_THAT(succeed({"check", path("cut.rawlog")}).out, HasSubstr("39 frames"));
}

TEST_F(ImportTest, NothingIsReplacedUnasked) {
  const Arguments arguments{"import", carmenLog(), "-o", path("a.rawlog"), "-q"};
  succeed(arguments);
  const std::string before = contentOf(path("a.rawlog"));
  expectRefused(run(arguments), "a.rawlog: exists; use --overwrite");
  Arguments overwrite = arguments;
  overwrite.emplace_back("--overwrite");
  succeed(overwrite);
  EXPECT_EQ(contentOf(path("a.rawlog")), before);
  overwrite[1] = path("missing.log");
  expectRefused(run(overwrite), "missing.log: no such file");
  EXPECT_EQ(contentOf(path("a.rawlog")), before);  // a failure leaves the old one
  EXPECT_FALSE(fs::exists(path("a.rawlog.part")));
  expectRefused(run({"import", path("drive.log"), "-o", path("drive.log"), "--overwrite"}), "is the input");
}

TEST_F(ImportTest, RefusesWhatItCannotUse) {
  const auto refuses = [&](const Arguments& arguments, const std::string& text) {
    Arguments all{"import"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"-o", path("x.rawlog")});
    expectRefused(run(all), text);
    EXPECT_FALSE(fs::exists(path("x.rawlog")));
  };
  const std::string carmen = carmenLog();
  refuses({log("room.rawlog")}, "is a rawlog already");
  refuses({path("")}, "is a folder");
  refuses({carmen, "--format", "graph"}, "drive.log:2: 'PARAM': expected VERTEX_SE2");
  refuses({carmen, "--format", "carma"}, "--format");
  refuses({carmen, "--controls", "c.txt"}, "--controls does not apply to the form carmen");
  refuses({carmen, "--sensor-pose", "1,2"}, "--sensor-pose");
}

TEST_F(ImportTest, HelpHasAnExample) {
  EXPECT_THAT(succeed({"import", "--help"}).out, HasSubstr("Example: submap-slam import "));
}

}  // namespace
}  // namespace submap_slam::testing
