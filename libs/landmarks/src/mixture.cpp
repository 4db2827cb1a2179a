#include <submap_slam/landmarks/mixture.h>

#include <algorithm>
#include <cmath>

namespace submap_slam::landmark_mapping {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const MixtureComponent& bestOf(const std::vector<MixtureComponent>& components) {
  return *std::max_element(
      components.begin(), components.end(),
      [](const MixtureComponent& a, const MixtureComponent& b) { return a.weight < b.weight; });
}

std::size_t indexById(const MixtureComponent& component, uint32_t id) {
  const auto& features = component.features;
  return static_cast<std::size_t>(
      std::find_if(features.begin(), features.end(), [id](const Feature& f) { return f.id == id; }) -
      features.begin());
}

/** Which features the Gaussian has, where each component holds them, and which components are in it. */
struct Correspondence {
  std::vector<Feature> standard;
  std::vector<std::vector<std::size_t>> index;  ///< of each component, one for each standard feature
};

bool has(const MixtureComponent& component, std::size_t index) { return index < component.features.size(); }

bool lacksOne(const MixtureComponent& component, const std::vector<std::size_t>& index) {
  return std::any_of(index.begin(), index.end(), [&](std::size_t i) { return !has(component, i); });
}

Correspondence correspond(const std::vector<MixtureComponent>& components, const MixtureOptions& options) {
  Correspondence c;
  for (const Feature& f : bestOf(components).features)
    if (f.known || f.hits >= static_cast<uint32_t>(options.min_hits)) c.standard.push_back(f);
  std::sort(c.standard.begin(), c.standard.end(),
            [](const Feature& a, const Feature& b) { return a.id < b.id; });
  for (const auto& component : components) {
    c.index.emplace_back();
    for (const Feature& f : c.standard) c.index.back().push_back(indexById(component, f.id));
  }
  return c;
}

void erase(Correspondence& c, std::size_t feature) {
  const auto at = static_cast<std::ptrdiff_t>(feature);
  c.standard.erase(c.standard.begin() + at);
  for (auto& index : c.index) index.erase(index.begin() + at);
}

/** Leaves out features that too much of the weight lacks, those that most lack first. */
void dropRareFeatures(const std::vector<MixtureComponent>& components, double most_left_out,
                      Correspondence& c) {
  for (;;) {
    double left_out = 0;
    VectorXd lacking = VectorXd::Zero(static_cast<Index>(c.standard.size()));
    for (std::size_t j = 0; j < components.size(); ++j) {
      if (lacksOne(components[j], c.index[j])) left_out += components[j].weight;
      for (std::size_t i = 0; i < c.standard.size(); ++i)
        if (!has(components[j], c.index[j][i])) lacking[static_cast<Index>(i)] += components[j].weight;
    }
    if (left_out <= most_left_out) return;
    Index rarest = 0;
    lacking.maxCoeff(&rarest);
    erase(c, static_cast<std::size_t>(rarest));
  }
}

/** Q_j times the weight is added. */
void addCovariance(const MixtureComponent& component, const std::vector<std::size_t>& index, double weight,
                   MatrixXd& sum) {
  if (component.covariance.size() > 0) {
    const auto rows = rowsOf(index);
    sum += weight * component.covariance(rows, rows);
    return;
  }
  sum.topLeftCorner<3, 3>() += weight * component.pose_covariance;
  for (std::size_t i = 0; i < index.size(); ++i) {
    const Index row = 3 + 2 * static_cast<Index>(i);
    sum.block<2, 2>(row, row) += weight * component.features[index[i]].covariance;
  }
}

/** x_j, the heading near to another. */
VectorXd stateOf(const MixtureComponent& component, const std::vector<std::size_t>& index, double heading) {
  VectorXd x(3 + 2 * static_cast<Index>(index.size()));
  x.head<3>() = component.pose;
  x[2] = heading + wrapped(component.pose[2] - heading);
  for (std::size_t i = 0; i < index.size(); ++i)
    x.segment<2>(3 + 2 * static_cast<Index>(i)) = component.features[index[i]].mean;
  return x;
}

double spreadCorrection(const std::vector<double>& weights) {
  double squares = 0;
  for (const double w : weights) squares += w * w;
  constexpr double kAllInOne = 0.999;
  return squares < kAllInOne ? (1 + squares) / (1 - squares) : 1;
}

}  // namespace

std::vector<Index> rowsOf(const std::vector<std::size_t>& features) {
  std::vector<Index> rows{0, 1, 2};
  for (const std::size_t i : features)
    for (const Index axis : {0, 1}) rows.push_back(3 + 2 * static_cast<Index>(i) + axis);
  return rows;
}

LandmarkEstimate toGaussian(const std::vector<MixtureComponent>& components, const MixtureOptions& options,
                            std::vector<std::size_t>& kept) {
  Correspondence c = correspond(components, options);
  dropRareFeatures(components, options.most_left_out, c);
  kept.clear();
  double sum = 0;
  for (std::size_t j = 0; j < components.size(); ++j)
    if (!lacksOne(components[j], c.index[j])) kept.push_back(j), sum += components[j].weight;

  const Index size = 3 + 2 * static_cast<Index>(c.standard.size());
  const double heading = bestOf(components).pose[2];
  MatrixXd covariance = MatrixXd::Zero(size, size), states(size, static_cast<Index>(kept.size()));
  std::vector<double> weights;
  for (const std::size_t j : kept) {
    const auto column = static_cast<Index>(weights.size());
    weights.push_back(components[j].weight / sum);
    states.col(column) = stateOf(components[j], c.index[j], heading);
    addCovariance(components[j], c.index[j], weights.back(), covariance);
  }
  const Eigen::Map<const VectorXd> w(weights.data(), static_cast<Index>(weights.size()));
  const VectorXd mean = states * w;  // (7)
  const MatrixXd spread = states.colwise() - mean;
  const double correction = options.small_sample_correction ? spreadCorrection(weights) : 1;
  covariance += correction * spread * w.asDiagonal() * spread.transpose();  // (8)

  LandmarkEstimate estimate;
  estimate.pose = mean.head<3>();
  for (std::size_t i = 0; i < c.standard.size(); ++i) {
    const Index row = 3 + 2 * static_cast<Index>(i);
    estimate.features.push_back({c.standard[i].id, mean[row], mean[row + 1], c.standard[i].hits});
  }
  estimate.covariance = (covariance + covariance.transpose()) / 2;
  return estimate;
}

}  // namespace submap_slam::landmark_mapping
