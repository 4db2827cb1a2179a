#include <submap_slam/mapping/grid_mapper.h>

namespace submap_slam {
namespace {

constexpr Range kPositive{1e-9, 1e9};
constexpr Range kNonNegative{0, 1e9};
constexpr Range kShare{0, 1};

void describe(ParameterTable& table, SurfelMapParams& p) {
  table.add("surfel_resolution", p.resolution, "m", {0.005, 1}, "Cell size of the matching map");
  table.add("search_radius", p.search_radius, "m", {0.01, 2},
            "A beam is matched to the nearest surfel within this");
  table.add("fit_radius", p.fit_radius, "m", {0.01, 1},
            "A surfel's line is fitted to the surfels within this");
}

void describe(ParameterTable& table, MatcherParams& p) {
  table.add("line_sigma", p.line_sigma, "m", kPositive,
            "Standard deviation of a beam's distance from its line");
  table.add("cauchy_scale", p.cauchy_scale, "", kPositive, "Scale of the Cauchy loss in units of line_sigma");
  table.add("max_iterations", p.max_iterations, "", {1, 1000},
            "Most Levenberg-Marquardt iterations per scan");
}

void describe(ParameterTable& table, SearchWindow& p) {
  table.add("window_xy", p.window_xy, "m", {0.01, 5}, "Half width of the search window");
  table.add("window_phi", p.window_phi, "rad", {0.01, 3.2}, "Half width of the search window in heading");
  table.add("step_xy", p.step_xy, "m", {0.005, 1}, "Step of the search");
  table.add("step_phi", p.step_phi, "rad", {0.001, 1}, "Step of the search in heading");
  table.add("max_beams", p.max_beams, "", {1, 1e6},
            "Most beams that are scored, evenly spread over the scan");
}

void describe(ParameterTable& table, CorrelativeSearchParams& p) {
  describe(table, static_cast<SearchWindow&>(p));
  table.add("sigma", p.sigma, "m", kPositive,
            "Softness of the score: standard deviation of a beam's distance");
  table.add("peak_ratio", p.peak_ratio, "", kShare, "Peaks below this share of the best score are dropped");
  table.add("max_peaks", p.max_peaks, "", {1, 1000}, "Most peaks that are followed up");
}

void describe(ParameterTable& table, MotionParams& p) {
  table.add("sigma_xy", p.sigma_xy, "m", kPositive, "Standard deviation of a step's translation");
  table.add("sigma_xy_per_m", p.sigma_xy_per_m, "m/m", kNonNegative, "… for each metre moved");
  table.add("sigma_phi", p.sigma_phi, "rad", kPositive, "Standard deviation of a step's turn");
  table.add("sigma_phi_per_rad", p.sigma_phi_per_rad, "rad/rad", kNonNegative, "… for each radian turned");
  table.add("sigma_phi_per_m", p.sigma_phi_per_m, "rad/m", kNonNegative, "… for each metre moved");
}

void describeParticles(ParameterTable& table, FilterParams& p) {
  table.add("fixed", p.fixed_particles, "", {0, 10000},
            "Number of particles of the classical filter; 0: as many as the posterior has modes");
  table.add("max", p.max_particles, "", {1, 10000}, "Most particles of the adaptive filter");
  table.add("resample_below", p.resample_below, "", kShare,
            "The classical filter resamples when N_eff falls below this share");
  table.add("likelihood_power", p.likelihood_power, "", {1e-6, 1},
            "Exponent of a scan's likelihood in the weights: neighbouring beams are not independent");
  table.add("min_weight", p.min_weight, "", kShare,
            "Hypotheses of the adaptive filter below this weight are dropped");
  table.add("decided_weight", p.decided_weight, "", kShare, "A hypothesis above this weight has won");
}

void describe(ParameterTable& table, ProbabilityGridParams& p) {
  constexpr Range kFree{0.001, 0.499}, kOccupied{0.501, 0.999};
  table.add("resolution", p.resolution, "m", {0.005, 1}, "Cell size of the probability grid");
  table.add("hit_probability", p.hit, "", kOccupied,
            "A scan with a beam that ends in a cell multiplies its odds by those of this probability");
  table.add("miss_probability", p.miss, "", kFree, "The same if beams only pass through the cell");
  table.add("min_probability", p.min, "", kFree, "Cells are never surer to be free");
  table.add("max_probability", p.max, "", kOccupied, "Cells are never surer to be occupied");
}

void describe(ParameterTable& table, ScanMatchingParams& p) {
  describe(table, p.grid);
  table.add(
      "translation_weight", p.translation_weight, "1/m", kNonNegative,
      "Weight of the distance from odometry's prediction against the root mean square of 1 - probability "
      "at the beams' ends");
  table.add("rotation_weight", p.rotation_weight, "1/rad", kNonNegative,
            "The same for the turn away from the prediction");
  table.add("max_iterations", p.max_iterations, "", {1, 1000}, "Most iterations of Ceres per match");
  table.add(
      "information_share", p.information_share, "", {1e-6, 1},
      "Share of a match's information that counts for the covariance of the end pose: beams that end in "
      "the same cells err together");
  table.add("correlative_search", p.correlative_search,
            "Start also from the best pose of a search around the prediction; always done where odometry is "
            "missing, with a tenth of the weights");
  describe(table, p.window);
}

void describe(ParameterTable& table, ClosingParams& p) {
  table.add("lost_below", p.lost_below, "", kShare, "A scan with fewer inlier beams than this share is lost");
  table.add("lost_scans", p.lost_scans, "", {1, 1e6}, "This many lost scans in a row close the submap");
  table.add("undecided_scans", p.undecided_scans, "", {1, 1e6},
            "This many scans with several hypotheses close the submap");
  table.add("max_sigma_xy", p.max_sigma_xy, "m", kPositive,
            "A pose less certain than this closes the submap");
  table.add("max_sigma_phi", p.max_sigma_phi, "rad", kPositive,
            "A heading less certain than this closes the submap");
  table.add("doubtful_step_xy", p.doubtful_step_xy, "m", kPositive,
            "Where odometry or the scans leap and they disagree by more than this, the submap ends, so that "
            "joining can decide "
            "who is right");
  table.add("doubtful_step_phi", p.doubtful_step_phi, "rad", kPositive, "The same for the turn");
  table.add(
      "carried", p.carried,
      "True where the robot may be carried or started anew within the log: three scans in a row that fit "
      "nothing of what was seen before end the submap, and the next one may be anywhere. Where scans often "
      "fit badly, as outdoors, the loop search then takes several times as long");
}

void describe(ParameterTable& table, DriftParams& p) {
  table.add("match_scale", p.match_scale, "", kPositive,
            "Share of the standard deviation that a match's information gives which each key scan adds");
  table.add("odometry_scale", p.odometry_scale, "", kPositive,
            "Real standard deviation of odometry as a share of the motion prior's, which is wide on purpose");
  table.add("sigma_xy_per_m", p.sigma_xy_per_m, "m/√m", kNonNegative,
            "Least standard deviation of the end position");
  table.add("sigma_phi_per_m", p.sigma_phi_per_m, "rad/√m", kNonNegative,
            "Least standard deviation of the end heading");
}

void describe(ParameterTable& table, EvidenceParams& p) {
  table.add("resolution", p.resolution, "m", {0.005, 10}, "Cell size of submaps and map");
  table.add("max_range", p.max_range, "m", kPositive, "Beams are drawn up to this range");
  table.add("occupied_log_odds", p.occupied_log_odds, "", kPositive, "Evidence of a beam's end");
  table.add("free_log_odds", p.free_log_odds, "", {-1e9, 0}, "Evidence of a beam's passing");
}

}  // namespace

void describe(ParameterTable& table, GridMapperParams& p) {
  table.section("mapper", "Local mapper: from frames to grid submaps");
  table.add("method", p.method,
            "Particle filter over scans matched to surfels, or one hypothesis matched to a probability grid "
            "(Huang et al. 2024)",
            {"rbpf", "scan_matching"});
  table.add("max_range", p.max_range, "m", kNonNegative,
            "Beams beyond this are not used; 0: all that the scanner gives");
  table.add("key_distance", p.filter.keys.distance, "m", kPositive,
            "A scan is inserted into the map after this distance");
  table.add("key_angle", p.filter.keys.angle, "rad", kPositive, "… or after this turn");
  table.add("refine", p.refine, "Match every scan once more to the finished submap");
  table.add("refine_sigma_xy", p.refine_sigma_xy, "m", kPositive,
            "How far refinement by rbpf may move a pose");
  table.add("refine_sigma_phi", p.refine_sigma_phi, "rad", kPositive,
            "How far refinement by rbpf may turn a pose");
  table.section("matcher", "Scan matcher of rbpf: robust point-to-line distances to surfels");
  describe(table, p.filter.map);
  describe(table, p.filter.matcher);
  table.section("rescue", "Correlative search of rbpf for scans that the matcher cannot explain");
  table.add("below", p.filter.rescue_below, "", kShare,
            "Search if fewer beams are inliers than this share of what is usual over the last scans");
  table.add("slip_beyond", p.filter.slip_beyond, "", kPositive,
            "A match this many sigmas from odometry's prediction makes odometry doubtful");
  table.add("slip_cost", p.filter.slip_cost, "", kNonNegative,
            "Negative log probability that wheels slip at a doubtful scan while odometry goes on evenly");
  table.add("surprise_cost", p.filter.surprise_cost, "", kNonNegative,
            "The same where odometry says something quite different from the motion before");
  table.add("slip_information", p.filter.slip_information, "", {1e-6, 1},
            "Share of the odometry prior's information that is believed during a rescue");
  describe(table, p.filter.search);
  table.section("motion", "Odometry prior of one step");
  describe(table, p.filter.motion);
  table.section("particles", "Particle filter");
  describeParticles(table, p.filter);
  table.section("scan_matching", "Local mapper scan_matching: probability grid and scan matching by Ceres");
  describe(table, p.scan_matching);
  table.section("closing", "Decision rules that close a submap before its stretch ends");
  describe(table, p.closing);
  table.section("drift", "Covariance of a submap's end pose");
  describe(table, p.drift);
  table.section("evidence", "Evidence grids of submaps and map");
  describe(table, p.evidence);
}

}  // namespace submap_slam
