#include "tile_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace submap_slam::grid_joining {
namespace {

constexpr int kBlock = EvidenceLevel::kBlock, kBlockMask = kBlock - 1;

/** Index coordinates of a tile's lattice points, counted from a cell on a block border so that they are small
 * and positive: a float holds their fractions, and a cast rounds down. */
template <class Scalar>
struct TileCoordinates {
  TileCoordinates(const Tile& tile, const PlacedLevel& submap)
      : a_u(static_cast<Scalar>(submap.columnStep())), a_v(static_cast<Scalar>(submap.rowStep())) {
    const double u = submap.columnOf(tile.a, tile.b), v = submap.rowOf(tile.a, tile.b);
    constexpr double kBelow = 2 * kTile;  // no point of the tile lies that far below its first one
    first_column = static_cast<int>(std::floor((u - kBelow) / kBlock)) * kBlock;
    first_row = static_cast<int>(std::floor((v - kBelow) / kBlock)) * kBlock;
    u0 = static_cast<Scalar>(u - first_column);
    v0 = static_cast<Scalar>(v - first_row);
  }
  Scalar column(int a, int b) const {
    return u0 + a_u * static_cast<Scalar>(a) - a_v * static_cast<Scalar>(b);
  }
  Scalar row(int a, int b) const { return v0 + a_v * static_cast<Scalar>(a) + a_u * static_cast<Scalar>(b); }

  Scalar u0, v0, a_u, a_v;
  int first_column, first_row;
};

}  // namespace

template <class Scalar>
bool TileKernel<Scalar>::evaluate(const Tile& tile, const PlacedLevels& placed) {
  cost_ = energy_ = 0;
  observations_ = cells_ = 0;
  listCells(tile, placed);
  if (listed_ == 0) return false;
  makeRoom(tile.members.size());
  for (std::size_t i = 0; i < count_; ++i) sample(tile, placed.submaps[tile.members[i].submap], members_[i]);
  reduceMap();
  for (std::size_t i = 0; i < count_; ++i) linearise(i);
  const auto columns = 3 * static_cast<Eigen::Index>(count_);
  const auto weighted = weighted_rows_.topLeftCorner(listed_, columns);
  auto linked = linked_.topLeftCorner(columns, columns);
  linked.setZero();
  linked.template selfadjointView<Eigen::Lower>().rankUpdate(weighted.transpose());
  return cells_ > 0;
}

template <class Scalar>
void TileKernel<Scalar>::makeRoom(std::size_t members) {
  count_ = members;
  if (members <= members_.size()) return;
  const auto columns = 3 * static_cast<Eigen::Index>(members);
  members_.resize(members);
  contributes_.resize(members);
  residual_.resize(kPaddedCells, static_cast<Eigen::Index>(members));
  jacobian_rows_.resize(kPaddedCells, columns);
  weighted_rows_.resize(kPaddedCells, columns);
  linked_.resize(columns, columns);
}

template <class Scalar>
void TileKernel<Scalar>::listCells(const Tile& tile, const PlacedLevels& placed) {
  marked_.fill(0);
  for (const TileMember& member : tile.members)
    if (member.surface) markSurface(tile, placed.submaps[member.submap]);
  std::size_t n = 0;
  for (std::size_t k = 0; k < kCells; ++k) {
    a_[n] = static_cast<uint8_t>(k % kTile);
    b_[n] = static_cast<uint8_t>(k / kTile);
    n += marked_[k];
  }
  listed_ = static_cast<Eigen::Index>(n);
}

template <class Scalar>
void TileKernel<Scalar>::markSurface(const Tile& tile, const PlacedLevel& submap) {
  const TileCoordinates<Scalar> at(tile, submap);
  const EvidenceLevel& level = submap.level();
  for (int b = 0, k = 0; b < kTile; ++b)
    for (int a = 0; a < kTile; ++a, ++k) {
      const int column = static_cast<int>(at.column(a, b)), row = static_cast<int>(at.row(a, b));
      const uint64_t surface = level.surface(at.first_column + column, at.first_row + row);
      const int bit = (row & kBlockMask) * kBlock + (column & kBlockMask);
      marked_[static_cast<std::size_t>(k)] |= static_cast<uint8_t>(surface >> bit & 1);
    }
}

template <class Scalar>
void TileKernel<Scalar>::sample(const Tile& tile, const PlacedLevel& submap, Member& m) const {
  constexpr int kStride = EvidenceLevel::kStride;
  const TileCoordinates<Scalar> at(tile, submap);
  const EvidenceLevel& level = submap.level();
  const auto r = static_cast<Scalar>(level.resolution()), per_metre = static_cast<Scalar>(1) / r;
  const auto x0 = static_cast<Scalar>(level.xOf(at.first_column)),
             y0 = static_cast<Scalar>(level.yOf(at.first_row));
  for (std::size_t k = 0; k < static_cast<std::size_t>(listed_); ++k) {
    const Scalar u = at.column(a_[k], b_[k]), v = at.row(a_[k], b_[k]);
    const int column = static_cast<int>(u), row = static_cast<int>(v);
    const Scalar fu = u - static_cast<Scalar>(column), fv = v - static_cast<Scalar>(row);
    const int number = level.number(at.first_column + column, at.first_row + row);
    const EvidenceCell* low = level.cellsOf(number) + (row & kBlockMask) * kStride + (column & kBlockMask);
    const EvidenceCell* high = low + kStride;
    const auto interpolate = [&](float EvidenceCell::*field, Scalar& value, Scalar& du, Scalar& dv) {
      const auto c00 = static_cast<Scalar>(low[0].*field), c10 = static_cast<Scalar>(low[1].*field);
      const auto c01 = static_cast<Scalar>(high[0].*field), c11 = static_cast<Scalar>(high[1].*field);
      const Scalar lower = c10 - c00, upper = c11 - c01;
      const Scalar bottom = c00 + fu * lower, top = c01 + fu * upper;
      value = bottom + fv * (top - bottom);
      du = per_metre * (lower + fv * (upper - lower));
      dv = per_metre * (top - bottom);
    };
    interpolate(&EvidenceCell::log_odds, m.log_odds[k], m.log_odds_gradient[0][k], m.log_odds_gradient[1][k]);
    interpolate(&EvidenceCell::hits, m.hits[k], m.hits_gradient[0][k], m.hits_gradient[1][k]);
    m.point[0][k] = x0 + r * u;
    m.point[1][k] = y0 + r * v;
  }
}

template <class Scalar>
void TileKernel<Scalar>::reduceMap() {
  const auto n = static_cast<std::size_t>(listed_);
  Row ww, wl, seen;
  std::fill_n(ww.begin(), n, Scalar{0});
  std::fill_n(wl.begin(), n, Scalar{0});
  std::fill_n(seen.begin(), n, Scalar{0});
  for (std::size_t i = 0; i < count_; ++i) {
    const Member& m = members_[i];
    for (std::size_t k = 0; k < n; ++k) {
      ww[k] += m.hits[k] * m.hits[k];
      wl[k] += m.hits[k] * m.log_odds[k];
      seen[k] += m.hits[k] > 0 ? Scalar{1} : Scalar{0};
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    valid_[k] = seen[k] > 1 ? Scalar{1} : Scalar{0};
    const Scalar inverse = valid_[k] / std::max(ww[k], std::numeric_limits<Scalar>::min());
    joint_value_[k] = wl[k] * inverse;
    inverse_root_[k] = std::sqrt(inverse);
    if (seen[k] > 1) ++cells_, observations_ += static_cast<std::size_t>(seen[k]);
  }
}

template <class Scalar>
void TileKernel<Scalar>::linearise(std::size_t i) {
  const auto n = static_cast<std::size_t>(listed_);
  Member& m = members_[i];
  Row share;
  for (std::size_t k = 0; k < n; ++k) {
    const Scalar per_hit = m.log_odds[k] / (m.hits[k] > 0 ? m.hits[k] : Scalar{1});
    share[k] = jacobian_ == JacobianKind::kPaper                ? Scalar{0}
               : jacobian_ == JacobianKind::kVariableProjection ? joint_value_[k]
                                                                : per_hit;
  }
  const auto column = static_cast<Eigen::Index>(i);
  Scalar* const residual = residual_.col(column).data();
  const std::array<Scalar*, 3> row{jacobian_rows_.col(3 * column).data(),
                                   jacobian_rows_.col(3 * column + 1).data(),
                                   jacobian_rows_.col(3 * column + 2).data()};
  const std::array<Scalar*, 3> weighted{weighted_rows_.col(3 * column).data(),
                                        weighted_rows_.col(3 * column + 1).data(),
                                        weighted_rows_.col(3 * column + 2).data()};
  Scalar largest = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Scalar counts = m.hits[k] > 0 ? valid_[k] : Scalar{0};
    const Scalar gx = counts * (m.log_odds_gradient[0][k] - share[k] * m.hits_gradient[0][k]);
    const Scalar gy = counts * (m.log_odds_gradient[1][k] - share[k] * m.hits_gradient[1][k]);
    const Scalar turn = gx * m.point[1][k] - gy * m.point[0][k], weight = m.hits[k] * inverse_root_[k];
    m.log_odds[k] *= counts;
    residual[k] = m.log_odds[k] - counts * m.hits[k] * joint_value_[k];
    row[0][k] = -gx, row[1][k] = -gy, row[2][k] = turn;
    weighted[0][k] = -weight * gx, weighted[1][k] = -weight * gy, weighted[2][k] = weight * turn;
    largest = std::max(largest, std::max(std::abs(gx), std::abs(gy)));
  }
  contributes_[i] = largest > 0;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  cost_ += static_cast<double>(residual_.col(column).head(listed_).squaredNorm());
  energy_ += static_cast<double>(Eigen::Map<const Vector>(m.log_odds.data(), listed_).squaredNorm());
}

template <class Scalar>
Eigen::Vector3d TileKernel<Scalar>::gradient(std::size_t member) const {
  const auto i = static_cast<Eigen::Index>(member);
  const Eigen::Matrix<Scalar, 3, 1> g =
      jacobian_rows_.block(0, 3 * i, listed_, 3).transpose().lazyProduct(residual_.col(i).head(listed_));
  return g.template cast<double>();
}

template <class Scalar>
Eigen::Matrix3d TileKernel<Scalar>::block(std::size_t i, std::size_t k) const {
  const auto row = 3 * static_cast<Eigen::Index>(i), column = 3 * static_cast<Eigen::Index>(k);
  const Eigen::Matrix3d linked =
      linked_.template block<3, 3>(column, row).transpose().template cast<double>();
  if (i != k) return -linked;
  const auto rows = jacobian_rows_.block(0, row, listed_, 3);
  const Eigen::Matrix<Scalar, 3, 3> own = rows.transpose().lazyProduct(rows);
  return own.template cast<double>() - linked.template selfadjointView<Eigen::Upper>().toDenseMatrix();
}

template class TileKernel<float>;
template class TileKernel<double>;

}  // namespace submap_slam::grid_joining
