/** Joins many submaps of a city through a store with a budget, from frames that are off by up to 0.3 m and
 * 0.5°, and states time, peak memory and accuracy:
 *
 *   large_world_benchmark SUBMAPS SIDE_M RANGE_M STORE_MB MAX_CELLS THREADS
 *
 * 1000 1000 20 1000 4e7 2 is a square kilometre (5 GB of evidence), 10 100 25 1000 1e7 2 are ten submaps of
 * 100 × 100 m. The submaps have cells of 0.05 m; MAX_CELLS is that of the joiner. */
#include <fmt/format.h>
#include <submap_slam/rawlog/submap_store.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <utility>

#include "grid_gauss_newton/grid_gauss_newton.h"
#include "synthetic_submaps.h"

namespace {

using namespace submap_slam;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

struct Plan {
  std::size_t submaps;
  double side, range;  // m
};

/** In [-1, 1). */
double random(std::mt19937& generator) { return static_cast<double>(generator()) / 2147483648.0 - 1; }

/** The walls of a crooked house in each square of 25 m that is near the submap. */
testing::World housesAround(const TPose2D& T_w_s, double range) {
  constexpr double kBlock = 25;
  testing::World walls;
  const auto first = [&](double x) { return static_cast<int>(std::floor((x - range) / kBlock)) - 1; };
  const auto last = [&](double x) { return static_cast<int>(std::floor((x + range) / kBlock)) + 1; };
  for (int by = first(T_w_s.y); by <= last(T_w_s.y); ++by)
    for (int bx = first(T_w_s.x); bx <= last(T_w_s.x); ++bx) {
      std::mt19937 generator(static_cast<uint32_t>(1000 * (by + 100) + bx + 100));
      const TPose2D house(kBlock * (bx + 0.5) + 3 * random(generator),
                          kBlock * (by + 0.5) + 3 * random(generator), 0.7 * random(generator));
      const double w = 6 + 2 * random(generator), h = 5 + 2 * random(generator);
      const TPoint2D corners[] = {{-w, -h}, {w, -h}, {w, h}, {-w, h}};
      for (int k = 0; k < 4; ++k) {
        const TPoint2D a = house.composePoint(corners[k]), b = house.composePoint(corners[(k + 1) % 4]);
        walls.push_back({a.x, a.y, b.x, b.y});
      }
    }
  return walls;
}

/** Frames to and fro through the square. */
std::vector<TPose2D> framesOf(const Plan& plan) {
  const auto across = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(plan.submaps))));
  const double step = (plan.side - 2 * plan.range) / static_cast<double>(across - 1);
  std::vector<TPose2D> frames;
  for (std::size_t k = 0; k < plan.submaps; ++k) {
    const std::size_t row = k / across, column = row % 2 == 0 ? k % across : across - 1 - k % across;
    frames.emplace_back(step * static_cast<double>(column), step * static_cast<double>(row),
                        row % 2 == 0 ? 0.0 : M_PI);
  }
  return frames;
}

/** Submaps whose end poses lead along frames that are off. */
GridSubmaps makeSubmaps(const Plan& plan, const std::vector<TPose2D>& truth, SubmapStore& store) {
  std::mt19937 generator(1);
  std::vector<TPose2D> start = truth;
  for (std::size_t k = 1; k < start.size(); ++k)
    start[k] =
        truth[k] + TPose2D(0.2 * random(generator), 0.2 * random(generator), 0.009 * random(generator));
  constexpr std::size_t kTogether = 16;
  GridSubmaps submaps(plan.submaps);
  for (std::size_t first = 0; first < submaps.size(); first += kTogether) {
    const std::size_t end = std::min(first + kTogether, submaps.size());
    tbb::parallel_for(first, end, [&](std::size_t k) {
      submaps[k] = testing::renderSubmap(housesAround(truth[k], plan.range), truth[k], plan.range, 0.05);
      submaps[k]->id = static_cast<uint32_t>(k);
      submaps[k]->unload();
    });
    for (std::size_t k = first; k < end; ++k) store.takeOver(*submaps[k]);
  }
  testing::linkChain(submaps, start, 0.3, 0.01);
  return submaps;
}

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/** Of all threads. */
double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/** Peak of this process, the making of the submaps included (MB). */
double peakMemory() {
  const std::string key = "VmHWM:";
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.compare(0, key.size(), key) == 0) return std::stod(line.substr(key.size())) / 1000;
  return 0;
}

/** Errors of the frames as seen from the one before (m), mean and largest. */
std::pair<double, double> relativeErrors(const JoinedMap& joined, const std::vector<TPose2D>& truth) {
  double sum = 0, worst = 0;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const TPose2D wanted = truth[k] - truth[k - 1];
    const TPose2D found = joined.frames[k].mean.asTPose() - joined.frames[k - 1].mean.asTPose();
    const double error = std::hypot(found.x - wanted.x, found.y - wanted.y);
    sum += error, worst = std::max(worst, error);
  }
  return {sum / static_cast<double>(truth.size() - 1), worst};
}

void joinAndReport(const GridSubmaps& submaps, const std::vector<TPose2D>& truth, const SubmapStore& store,
                   const std::string& max_cells) {
  GridGaussNewton joiner;
  ParameterTable table;
  joiner.describe(table);
  table.set("grid_gauss_newton.max_cells=" + max_cells);
  const JoinedMap start = chainSubmaps(submaps);
  const double begin = seconds(), cpu_begin = cpuSeconds();
  const JoinedMap joined = joiner.join(submaps, start, {});
  const double after_join = seconds(), cpu_after_join = cpuSeconds();
  const PackedEvidence map = fuseEvidence(submaps, joined.frames, 0);
  const double end = seconds(), cpu_end = cpuSeconds();
  fmt::print("{} ({}), {} iterations\n", toString(joined.status), joined.reason, joined.iterations.size());
  fmt::print(
      "joined in {:.2f} s ({:.2f} s of CPU), map of {} x {} cells of {:.2f} m fused in {:.2f} s ({:.2f})\n",
      after_join - begin, cpu_after_join - cpu_begin, map.sizeX(), map.sizeY(), map.resolution(),
      end - after_join, cpu_end - cpu_after_join);
  for (const auto& [name, map_joined] : {std::pair("start", start), std::pair("joined", joined)}) {
    const auto [mean, worst] = relativeErrors(map_joined, truth);
    fmt::print("{}: frames seen from the one before are off by {:.4f} m, at most {:.4f} m\n", name, mean,
               worst);
  }
  fmt::print("peak memory {:.0f} MB; {} times a submap was read again\n", peakMemory(), store.timesRead());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) {
    fmt::print("usage: {} SUBMAPS SIDE_M RANGE_M STORE_MB MAX_CELLS THREADS\n", argv[0]);
    return 2;
  }
  const Plan plan{static_cast<std::size_t>(std::atoi(argv[1])), std::atof(argv[2]), std::atof(argv[3])};
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(std::atoi(argv[6])));
  const auto store =
      SubmapStore::create(static_cast<std::size_t>(1e6 * std::atof(argv[4])),
                          (std::filesystem::temp_directory_path() / "large_world_benchmark.spill").string());
  const std::vector<TPose2D> truth = framesOf(plan);
  const double begin = seconds();
  const GridSubmaps submaps = makeSubmaps(plan, truth, *store);
  fmt::print("{} submaps made in {:.1f} s\n", submaps.size(), seconds() - begin);
  joinAndReport(submaps, truth, *store, argv[5]);
  return 0;
}
