/** Local filters against batch least squares, and what they do with difficult input. */
#include <gtest/gtest.h>
#include <mrpt/poses/CPose2D.h>
#include <submap_slam/landmarks/landmark_filter.h>
#include <submap_slam/landmarks/landmark_mapper.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <map>

#include "simulated_drive.h"

namespace submap_slam::testing {
namespace {

using namespace landmark_mapping;
using Eigen::Index;

/** All poses and features of a drive with known ids that fit odometry and measurements best: Gauss-Newton
 * with dense matrices over everything at once, in the same geometry but no filter. */
class Batch {
 public:
  explicit Batch(const Drive& drive) : frames_(drive.stretch.frames) {
    Pose pose = Pose::Zero();
    poses_.push_back(pose);
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (k > 0) poses_.push_back(compose(poses_.back(), increment(k)).pose);
      const LandmarkScan& scan = frames_[k].landmark_scans[0];
      for (const auto& m : scan.measurements)
        if (features_.count(*m.id) == 0)
          features_[*m.id] = locate(poses_.back(), toPose(scan.T_robot_sensor), {m.range, m.bearing}).feature;
    }
    for (int i = 0; i < 10; ++i) step();
  }

  Pose end() const { return poses_.back(); }
  const std::map<uint32_t, Point>& features() const { return features_; }
  Eigen::Matrix3d endCovariance() const {
    const Eigen::MatrixXd inverse =
        information_.llt().solve(Eigen::MatrixXd::Identity(information_.rows(), information_.rows()));
    const Index row = poseRow(poses_.size() - 1);
    return inverse.block<3, 3>(row, row);
  }

 private:
  Pose increment(std::size_t k) const { return toPose(*frames_[k].odometry - *frames_[k - 1].odometry); }
  static Index poseRow(std::size_t k) { return 3 * (static_cast<Index>(k) - 1); }
  Index featureRow(uint32_t id) const {
    return poseRow(poses_.size()) + 2 * std::distance(features_.begin(), features_.find(id));
  }

  void add(const Eigen::MatrixXd& j, const Eigen::VectorXd& r, const Eigen::MatrixXd& covariance) {
    const Eigen::MatrixXd w = j.transpose() * covariance.inverse();
    information_ += w * j;
    vector_ += w * r;
  }

  void step() {
    const Index size = poseRow(poses_.size()) + 2 * static_cast<Index>(features_.size());
    information_ = Eigen::MatrixXd::Zero(size, size);
    vector_ = Eigen::VectorXd::Zero(size);
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (k > 0) addMotion(k, size);
      addMeasurements(k, size);
    }
    const Eigen::VectorXd dx = information_.llt().solve(vector_);
    for (std::size_t k = 1; k < poses_.size(); ++k) poses_[k] += dx.segment<3>(poseRow(k));
    for (auto& [id, point] : features_) point += dx.segment<2>(featureRow(id));
  }

  void addMotion(std::size_t k, Index size) {
    const Composition c = compose(poses_[k - 1], increment(k));
    Eigen::MatrixXd j = Eigen::MatrixXd::Zero(3, size);
    j.middleCols<3>(poseRow(k)).setIdentity();
    if (k > 1) j.middleCols<3>(poseRow(k - 1)) = -c.by_a;
    Eigen::Vector3d r = c.pose - poses_[k];
    r[2] = wrapped(r[2]);
    add(j, r, c.by_b * frames_[k].motion_covariance->asEigen() * c.by_b.transpose());
  }

  void addMeasurements(std::size_t k, Index size) {
    const LandmarkScan& scan = frames_[k].landmark_scans[0];
    const Eigen::Vector2d sigma(scan.sigma_range, scan.sigma_bearing);
    for (const auto& m : scan.measurements) {
      const Predicted p = predictMeasurement(poses_[k], toPose(scan.T_robot_sensor), features_.at(*m.id));
      Eigen::MatrixXd j = Eigen::MatrixXd::Zero(2, size);
      if (k > 0) j.middleCols<3>(poseRow(k)) = p.by_pose;
      j.middleCols<2>(featureRow(*m.id)) = p.by_feature;
      add(j, innovationOf({m.range, m.bearing}, p.z), sigma.cwiseAbs2().asDiagonal());
    }
  }

  const std::vector<Frame>& frames_;
  std::vector<Pose> poses_;
  std::map<uint32_t, Point> features_;
  Eigen::MatrixXd information_;
  Eigen::VectorXd vector_;
};

/** Little noise: nearly linear. */
DriveOptions gentle() {
  DriveOptions options;
  options.sigma_xy = 0.005, options.sigma_phi = 0.001;
  options.sigma_range = 0.02, options.sigma_bearing = 0.002;
  options.frames = 25;
  return options;
}

LandmarkMapperParams paramsOf(const std::string& method, const std::string& proposal = "fastslam2") {
  LandmarkMapperParams params;
  params.method = method;
  params.particles.proposal = proposal;
  params.particles.particles = 200;
  params.closing.max_features = 1000;
  params.closing.max_pose_sigma = 1e9;
  params.closing.depleted_scans = 1000;
  return params;
}

/** As in the paper: particles are paths. */
LandmarkMapperParams mixtureOf(LandmarkMapperParams params) {
  params.particles.gaussian = "particles";
  return params;
}

LandmarkSubmap::Ptr onlySubmap(const LandmarkMapperParams& params, const Drive& drive, uint64_t seed = 1) {
  const LandmarkSubmaps submaps = LandmarkMapper(params, seed).map(drive.stretch);
  EXPECT_EQ(submaps.size(), 1u);
  EXPECT_NO_THROW(requireUsable(*submaps[0]));
  return submaps[0];
}

void expectNear(const LandmarkSubmap& submap, const Batch& batch, double metres, double radians) {
  EXPECT_NEAR(submap.end_pose.x, batch.end()[0], metres);
  EXPECT_NEAR(submap.end_pose.y, batch.end()[1], metres);
  EXPECT_NEAR(submap.end_pose.phi, wrapped(batch.end()[2]), radians);
  ASSERT_EQ(submap.features.size(), batch.features().size());
  for (const auto& f : submap.features) {
    EXPECT_NEAR(f.x, batch.features().at(f.id).x(), metres) << f.id;
    EXPECT_NEAR(f.y, batch.features().at(f.id).y(), metres) << f.id;
  }
}

TEST(EkfFilter, AgreesWithBatchLeastSquares) {
  const Drive drive = simulateDrive(gentle());
  const Batch batch(drive);
  const auto submap = onlySubmap(paramsOf("ekf"), drive);
  expectNear(*submap, batch, 1e-3, 1e-4);
  const Eigen::Matrix3d ours = submap->covariance.asEigen().topLeftCorner<3, 3>();
  EXPECT_TRUE(ours.isApprox(batch.endCovariance(), 0.02));
}

TEST(RbpfFilter, SmoothedItIsBatchLeastSquares) {
  const Drive drive = simulateDrive(gentle());
  const Batch batch(drive);
  for (const char* proposal : {"fastslam1", "fastslam2"}) {
    const auto submap = onlySubmap(paramsOf("rbpf", proposal), drive);
    expectNear(*submap, batch, 1e-4, 1e-5);
    const Eigen::Matrix3d ours = submap->covariance.asEigen().topLeftCorner<3, 3>();
    EXPECT_TRUE(ours.isApprox(batch.endCovariance(), 1e-3)) << proposal;
  }
}

TEST(RbpfFilter, TheMixtureOfParticlesAgreesWithBatchLeastSquares) {
  const Drive drive = simulateDrive(gentle());
  const Batch batch(drive);
  expectNear(*onlySubmap(mixtureOf(paramsOf("rbpf", "fastslam2")), drive), batch, 0.02, 2e-3);
  expectNear(*onlySubmap(mixtureOf(paramsOf("rbpf", "fastslam1")), drive), batch, 0.03, 3e-3);
}

TEST(RbpfFilter, ASingleMapIsTheMixtureOfParticles) {
  const Drive drive = simulateDrive(gentle());
  LandmarkMapperParams params = paramsOf("rbpf");
  params.single_map = true;
  EXPECT_EQ(onlySubmap(params, drive)->covariance, onlySubmap(mixtureOf(params), drive)->covariance);
}

/** After a measurement without noise, which least squares cannot weigh. */
LandmarkEstimate estimateFromAnExactSensor(const LandmarkMapperParams& params) {
  const auto filter = makeLandmarkFilter(params, 1);
  MeasuredScan scan;
  scan.T_robot_sensor = Pose::Zero();
  scan.measurements.push_back({{{5, 0.2}, Eigen::Matrix2d::Zero()}, 7, 1});
  filter->predict({{1, 0, 0}, Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal()});
  filter->observe(scan);
  return filter->estimate();
}

TEST(RbpfFilter, IsTheMixtureOfParticlesWhereSmoothingFails) {
  const LandmarkEstimate estimate = estimateFromAnExactSensor(paramsOf("rbpf")),
                         mixture = estimateFromAnExactSensor(mixtureOf(paramsOf("rbpf")));
  ASSERT_EQ(estimate.features.size(), 1u);
  EXPECT_TRUE(estimate.covariance.allFinite());
  EXPECT_EQ(estimate.covariance, mixture.covariance);
  EXPECT_EQ(estimate.pose, mixture.pose);
}

/** Squared error of the end pose in sigmas, per dimension, over seeds. */
double meanNees(const LandmarkMapperParams& params, int runs) {
  double sum = 0;
  for (int run = 0; run < runs; ++run) {
    DriveOptions options;
    options.seed = static_cast<uint32_t>(run + 1);
    const Drive drive = simulateDrive(options);
    const auto submap = onlySubmap(params, drive, static_cast<uint64_t>(run));
    Eigen::VectorXd error(static_cast<Index>(submap->dimension()));
    error.head<3>() = toPose(submap->end_pose) - toPose(drive.path.back());
    error[2] = wrapped(error[2]);
    for (std::size_t i = 0; i < submap->features.size(); ++i) {
      const auto& f = submap->features[i];
      const auto& truth = drive.landmarks[f.id - 1];
      error.segment<2>(3 + 2 * static_cast<Index>(i)) << f.x - truth.x, f.y - truth.y;
    }
    sum += error.dot(submap->covariance.asEigen().llt().solve(error)) / static_cast<double>(error.size());
  }
  return sum / runs;
}

TEST(LandmarkFilter, IsConsistent) {
  EXPECT_NEAR(meanNees(paramsOf("ekf"), 40), 1, 0.15);
  LandmarkMapperParams rbpf = paramsOf("rbpf");
  for (const int particles : {40, LandmarkParticleParams{}.particles}) {
    rbpf.particles.particles = particles;
    EXPECT_NEAR(meanNees(rbpf, 40), 1, 0.1) << particles;
  }
}

/** The weakness that smoothing is for: with few particles the covariance is too small, by a factor of about
 * 2.6 with those of the default. It tends to 1 with their number. */
TEST(LandmarkFilter, AMixtureOfFewParticlesIsTooCertainWithinBounds) {
  LandmarkMapperParams rbpf = mixtureOf(paramsOf("rbpf"));
  rbpf.particles.particles = LandmarkParticleParams{}.particles;
  EXPECT_LT(meanNees(rbpf, 20), 4);
  rbpf.particles.particles = 1000;
  EXPECT_NEAR(meanNees(rbpf, 20), 1, 0.25);
}

TEST(LandmarkFilter, FindsTheSameFeaturesWithoutIds) {
  DriveOptions options = gentle();
  const auto known = onlySubmap(paramsOf("ekf"), simulateDrive(options));
  options.ids = false;
  for (const char* method : {"ekf", "rbpf"}) {
    const auto submap = onlySubmap(paramsOf(method), simulateDrive(options));
    EXPECT_FALSE(submap->ids_known);
    EXPECT_NEAR(submap->end_pose.x, known->end_pose.x, 0.02) << method;
    EXPECT_LE(submap->features.size(), known->features.size()) << method;
    EXPECT_GE(submap->features.size() + 2, known->features.size()) << method;
  }
}

/** The turn is 0.045 rad more than odometry says (2.2 σ), which sets every bearing off: a tree far away then
 * stands nearer to where its neighbour was expected. Trees that nothing rivals tell. */
TEST(LandmarkFilter, ATurnThatOdometryUnderratesIsToldByWhatStandsAlone) {
  const std::vector<std::pair<double, double>> alone{{9, -0.9}, {12, -0.3}, {10, 0.9}},
      pair{{30, 0.3}, {30, 0.23}};
  const Eigen::Matrix2d noise = Eigen::Vector2d(0.01, 3e-4).asDiagonal();
  const Pose turned(0, 0, 0.145);
  MeasuredScan before{Pose::Zero(), 0, 0, {}}, after = before;
  const auto see = [&](const std::pair<double, double>& tree, bool again) {
    const auto index = static_cast<uint32_t>(before.measurements.size() + 1);
    const Point at = locate(Pose::Zero(), Pose::Zero(), {tree.first, tree.second}).feature;
    before.measurements.push_back({{{tree.first, tree.second}, noise}, {}, index});
    if (again)
      after.measurements.push_back({{predictMeasurement(turned, Pose::Zero(), at).z, noise}, {}, 10 + index});
  };
  for (const auto& tree : alone) see(tree, true);
  see(pair[0], true);
  see(pair[1], false);
  for (const char* method : {"ekf", "rbpf"}) {
    LandmarkMapperParams params = paramsOf(method);
    params.association.min_hits = 1;
    const auto filter = makeLandmarkFilter(params, 1);
    filter->observe(before);
    filter->predict({{0, 0, 0.1}, Eigen::Vector3d(1e-4, 1e-4, 4e-4).asDiagonal()});
    filter->observe(after);
    std::map<uint32_t, uint32_t> hits;
    for (const SubmapFeature& feature : filter->estimate().features) hits[feature.id] = feature.hits;
    EXPECT_EQ(hits, (std::map<uint32_t, uint32_t>{{1, 2}, {2, 2}, {3, 2}, {4, 2}, {5, 1}})) << method;
  }
}

TEST(LandmarkFilter, IdsCanBeIgnored) {
  LandmarkMapperParams params = paramsOf("ekf");
  params.association.known_ids = false;
  EXPECT_FALSE(onlySubmap(params, simulateDrive(gentle()))->ids_known);
}

TEST(LandmarkFilter, TakesNoNanAndNoContradictingIds) {
  const Drive clean = simulateDrive(gentle());
  for (const char* method : {"ekf", "rbpf"}) {
    Drive drive = clean;
    auto& measurements = drive.stretch.frames[3].landmark_scans[0].measurements;
    measurements.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 900});
    measurements.push_back({-1, 0, 901});
    measurements.push_back({5, std::numeric_limits<double>::infinity(), 902});
    measurements.push_back({3, 0, 903});
    measurements.push_back({9, 1, 903});
    const auto submap = onlySubmap(paramsOf(method), drive), expected = onlySubmap(paramsOf(method), clean);
    EXPECT_EQ(submap->features.size(), expected->features.size()) << method;
    EXPECT_EQ(submap->end_pose.x, expected->end_pose.x) << method;
  }
}

TEST(RbpfFilter, AFeatureThatIsNotSeenAgainGoes) {
  DriveOptions options = gentle();
  options.ids = false;
  Drive drive = simulateDrive(options);
  LandmarkMapperParams params = paramsOf("rbpf");
  params.association.min_hits = 1;
  const std::size_t clean = onlySubmap(params, drive)->features.size();
  drive.stretch.frames[5].landmark_scans[0].measurements.push_back({8, 0.02, {}});  // a ghost ahead
  EXPECT_EQ(onlySubmap(params, drive)->features.size(), clean);
}

}  // namespace
}  // namespace submap_slam::testing
