#include <submap_slam/eval/error_statistics.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace submap_slam {
namespace {

double meanOf(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

double stdOf(const std::vector<double>& v, double mean) {
  if (v.size() < 2) return 0;
  double sum = 0;
  for (const double x : v) sum += (x - mean) * (x - mean);
  return std::sqrt(sum / static_cast<double>(v.size() - 1));
}

double quantile(const std::vector<double>& sorted, double fraction) {
  const auto i = static_cast<std::size_t>(fraction * static_cast<double>(sorted.size()));
  return sorted[std::min(i, sorted.size() - 1)];
}

}  // namespace

ErrorStatistics errorStatistics(std::vector<double> errors) {
  ErrorStatistics s;
  if (errors.empty()) return s;
  std::sort(errors.begin(), errors.end());
  std::vector<double> squares(errors);
  for (double& e : squares) e *= e;
  s.count = errors.size();
  s.mean = meanOf(errors);
  s.std = stdOf(errors, s.mean);
  s.squared_mean = meanOf(squares);
  s.squared_std = stdOf(squares, s.squared_mean);
  s.rmse = std::sqrt(s.squared_mean);
  s.median = quantile(errors, 0.5);
  s.percentile_95 = quantile(errors, 0.95);
  s.max = errors.back();
  return s;
}

}  // namespace submap_slam
