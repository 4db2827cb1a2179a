#include "lane_kernel.h"

#include <cmath>
#include <limits>
#include <type_traits>

namespace submap_slam::grid_joining {
namespace {

constexpr int kBlock = EvidenceLevel::kBlock, kBlockMask = kBlock - 1,
              kBlockShift = EvidenceLevel::kBlockShift;
constexpr int kStride = EvidenceLevel::kStride, kStored = EvidenceLevel::kStored;

#define SUBMAP_SLAM_INLINE [[gnu::always_inline]] inline

/** The loops for machines that work on `bytes` bytes at once, written with the compiler's vector types. Rows
 * are walked in vectors of kWidth values; sums are walked once for each vector of kLanes, so that their
 * partial sums stay in registers and are the same for every width. */
template <class Scalar, std::size_t bytes>
struct Loops {
  static constexpr std::size_t kWidth = bytes / sizeof(Scalar);
  using Vector [[gnu::vector_size(bytes), gnu::may_alias]] = Scalar;
  using Integers [[gnu::vector_size(kWidth * sizeof(int32_t)), gnu::may_alias]] = int32_t;
  using Four [[gnu::vector_size(16), gnu::may_alias]] = float;
  using Two [[gnu::vector_size(8), gnu::may_alias, gnu::aligned(4)]] = float;  // cells next to each other
  using FourScalars [[gnu::vector_size(4 * sizeof(Scalar)), gnu::may_alias]] = Scalar;

  static const Vector& at(const Row<Scalar>& row, std::size_t k) {
    return reinterpret_cast<const Vector&>(row[k]);
  }
  static Vector& at(Row<Scalar>& row, std::size_t k) { return reinterpret_cast<Vector&>(row[k]); }

  /** Index coordinates of points: the cell, the fractions beyond it, and where the cell is stored. */
  struct Located {
    SUBMAP_SLAM_INLINE Located(const TileView<Scalar>& view, const Vector& a, const Vector& b)
        : u(view.u0 + view.u_a * a - view.v_a * b), v(view.v0 + view.v_a * a + view.u_a * b) {
      column = __builtin_convertvector(u, Integers);
      row = __builtin_convertvector(v, Integers);
      block = (row >> kBlockShift) * view.table.stride + (column >> kBlockShift);
    }
    Vector u, v;
    Integers column, row, block;
  };

  SUBMAP_SLAM_INLINE static void mark(const TileView<Scalar>& view,
                                      std::array<uint8_t, kTilePoints>& marked) {
    alignas(64) std::array<Scalar, kTile> first_row;
    alignas(64) std::array<int32_t, kTilePoints> block, bit;
    for (std::size_t a = 0; a < kTile; ++a) first_row[a] = static_cast<Scalar>(a);
    for (std::size_t k = 0; k < kTilePoints; k += kWidth) {
      const std::size_t row = k / kTile;
      const Vector b = Vector{} + static_cast<Scalar>(row);
      const Located point(view, reinterpret_cast<const Vector&>(first_row[k % kTile]), b);
      reinterpret_cast<Integers&>(block[k]) = point.block;
      reinterpret_cast<Integers&>(bit[k]) = (point.row & kBlockMask) * kBlock + (point.column & kBlockMask);
    }
    for (std::size_t k = 0; k < kTilePoints; ++k)
      marked[k] |=
          static_cast<uint8_t>(view.table.blocks[view.table.numbers[block[k]]].surface >> bit[k] & 1);
  }

  /** Values of the four cells around points, (0, 0), (1, 0), (0, 1) and (1, 1): L, then N. */
  using Corners = std::array<Row<float>, 8>;

  /** Those of one point. */
  SUBMAP_SLAM_INLINE static Four cornersAt(const float* cell) {
    const Two low = *reinterpret_cast<const Two*>(cell), high = *reinterpret_cast<const Two*>(cell + kStride);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3);
  }

  /** Writes those of four points, of L or of N, to four rows. */
  SUBMAP_SLAM_INLINE static void transpose(const Four& p, const Four& q, const Four& r, const Four& s,
                                           Corners& corners, std::size_t first, std::size_t point) {
    const Four pq_low = __builtin_shufflevector(p, q, 0, 4, 1, 5);
    const Four rs_low = __builtin_shufflevector(r, s, 0, 4, 1, 5);
    const Four pq_high = __builtin_shufflevector(p, q, 2, 6, 3, 7);
    const Four rs_high = __builtin_shufflevector(r, s, 2, 6, 3, 7);
    const auto put = [&](std::size_t k, const Four& value) {
      reinterpret_cast<Four&>(corners[first + k][point]) = value;
    };
    put(0, __builtin_shufflevector(pq_low, rs_low, 0, 1, 4, 5));
    put(1, __builtin_shufflevector(pq_low, rs_low, 2, 3, 6, 7));
    put(2, __builtin_shufflevector(pq_high, rs_high, 0, 1, 4, 5));
    put(3, __builtin_shufflevector(pq_high, rs_high, 2, 3, 6, 7));
  }

  using Floats [[gnu::vector_size(kWidth * sizeof(float)), gnu::may_alias]] = float;
  SUBMAP_SLAM_INLINE static void interpolate(const Corners& corners, std::size_t first, std::size_t point,
                                             const Vector& fu, const Vector& fv, Vector& value, Vector& du,
                                             Vector& dv) {
    Vector c[4];  // std::array would lose that they are vectors
    for (std::size_t k = 0; k < 4; ++k) {
      const Floats& corner = reinterpret_cast<const Floats&>(corners[first + k][point]);
      if constexpr (std::is_same_v<Scalar, float>)
        c[k] = corner;  // GCC would convert one by one
      else
        c[k] = __builtin_convertvector(corner, Vector);
    }
    const Vector &c00 = c[0], &c10 = c[1], &c01 = c[2], &c11 = c[3];
    const Vector lower = c10 - c00, upper = c11 - c01;
    const Vector bottom = c00 + fu * lower, top = c01 + fu * upper;
    value = bottom + fv * (top - bottom);
    du = lower + fv * (upper - lower);
    dv = top - bottom;
  }

  /** In three passes: a vector that is loaded right after its parts were stored would have to wait for them.
   */
  SUBMAP_SLAM_INLINE static void sample(const TileView<Scalar>& view, const PointList<Scalar>& points,
                                        MemberRows<Scalar>& m) {
    alignas(64) Row<int32_t> block, within;
    alignas(64) Row<Scalar> fu, fv;
    alignas(64) Corners corners;
    const std::size_t padded = points.padded();
    for (std::size_t k = 0; k < padded; k += kWidth) {
      const Located point(view, at(points.a, k), at(points.b, k));
      reinterpret_cast<Integers&>(block[k]) = point.block;
      reinterpret_cast<Integers&>(within[k]) =
          (point.row & kBlockMask) * kStride + (point.column & kBlockMask);
      at(fu, k) = point.u - __builtin_convertvector(point.column, Vector);
      at(fv, k) = point.v - __builtin_convertvector(point.row, Vector);
      at(m.x, k) = view.x0 + point.u;
      at(m.y, k) = view.y0 + point.v;
    }
    const EvidenceBlockTable& table = view.table;
    const auto number = [&](std::size_t k) { return table.numbers[block[k]]; };
    const auto log_odds = [&](std::size_t k) {
      return cornersAt(table.log_odds + table.blocks[number(k)].log_odds + within[k]);
    };
    const auto hits = [&](std::size_t k) {
      return cornersAt(table.hits + (kStored * number(k) + within[k]));
    };
    for (std::size_t k = 0; k < points.count; k += 4) {
      transpose(log_odds(k), log_odds(k + 1), log_odds(k + 2), log_odds(k + 3), corners, 0, k);
      transpose(hits(k), hits(k + 1), hits(k + 2), hits(k + 3), corners, 4, k);
    }
    for (Row<float>& row : corners)
      for (std::size_t k = points.count; k < padded; ++k) row[k] = 0;
    for (std::size_t k = 0; k < padded; k += kWidth) {
      interpolate(corners, 0, k, at(fu, k), at(fv, k), at(m.log_odds, k), at(m.log_odds_u, k),
                  at(m.log_odds_v, k));
      interpolate(corners, 4, k, at(fu, k), at(fv, k), at(m.hits, k), at(m.hits_u, k), at(m.hits_v, k));
    }
  }

  SUBMAP_SLAM_INLINE static void fuse(const MemberRows<Scalar>* members, std::size_t count,
                                      std::size_t points, MapRows<Scalar>& map) {
    constexpr auto kSmallest = std::numeric_limits<Scalar>::min();
    const Vector zero{}, one = zero + 1;
    Vector cells{}, observations{};
    for (std::size_t k = 0; k < points; k += kWidth) {
      Vector ww{}, wl{}, seen{};
      for (std::size_t i = 0; i < count; ++i) {
        const Vector &w = at(members[i].hits, k), &l = at(members[i].log_odds, k);
        ww += w * w;
        wl += w * l;
        seen += w > 0 ? one : zero;
      }
      const Vector valid = seen > 1 ? one : zero;
      const Vector inverse = valid / (ww > kSmallest ? ww : zero + kSmallest);
      at(map.valid, k) = valid;
      at(map.joint_value, k) = wl * inverse;
      at(map.inverse_root, k) = inverse;
      cells += valid;
      observations += valid * seen;
    }
    for (std::size_t k = 0; k < points; ++k) map.inverse_root[k] = std::sqrt(map.inverse_root[k]);
    map.cells = map.observations = 0;
    for (std::size_t l = 0; l < kWidth; ++l) {  // whole numbers: exact in any order
      map.cells += static_cast<std::size_t>(cells[l]);
      map.observations += static_cast<std::size_t>(observations[l]);
    }
  }

  SUBMAP_SLAM_INLINE static void divide(const MemberRows<Scalar>& member, std::size_t points,
                                        Row<Scalar>& per_hit) {
    const Vector one = Vector{} + 1;
    for (std::size_t k = 0; k < points; k += kWidth) {
      const Vector& hits = at(member.hits, k);
      at(per_hit, k) = at(member.log_odds, k) / (hits > 0 ? hits : one);
    }
  }

  /** kLanes partial sums of one quantity. */
  using Lanes = std::array<Scalar, kLanes>;

  /** Four partial sums from kLanes in single and then double precision. */
  SUBMAP_SLAM_INLINE static void addTo(PartialSum& sum, const Lanes& lanes) {
    const auto four = [&lanes](std::size_t l) { return reinterpret_cast<const FourScalars&>(lanes[l]); };
    const FourScalars added = (four(0) + four(8)) + (four(4) + four(12));
    for (std::size_t l = 0; l < 4; ++l) sum[l] += static_cast<double>(added[l]);
  }

  SUBMAP_SLAM_INLINE static bool linearise(const Row<Scalar>& share, const MapRows<Scalar>& map,
                                           std::size_t points, MemberRows<Scalar>& m, OwnSums& sums) {
    alignas(64) std::array<Lanes, 11> lanes;
    const Vector zero{}, one = zero + 1;
    for (std::size_t first = 0; first < kLanes; first += kWidth) {
      Vector uu{}, uv{}, ut{}, vv{}, vt{}, tt{}, ru{}, rv{}, rt{}, rr{}, ll{};
      for (std::size_t k = first; k < points; k += kLanes) {
        const Vector counts = at(m.hits, k) > 0 ? at(map.valid, k) : zero;
        const Vector u = counts * (at(m.log_odds_u, k) - at(share, k) * at(m.hits_u, k));
        const Vector v = counts * (at(m.log_odds_v, k) - at(share, k) * at(m.hits_v, k));
        const Vector turn = u * at(m.y, k) - v * at(m.x, k);
        const Vector l = counts * at(m.log_odds, k), w = counts * at(m.hits, k);
        const Vector residual = l - w * at(map.joint_value, k);
        const Vector weight = w * at(map.inverse_root, k), rest = one - weight * weight;
        at(m.weighted[0], k) = weight * u;
        at(m.weighted[1], k) = weight * v;
        at(m.weighted[2], k) = weight * turn;
        const Vector rest_u = rest * u, rest_v = rest * v;
        uu += rest_u * u;
        uv += rest_u * v;
        ut += rest_u * turn;
        vv += rest_v * v;
        vt += rest_v * turn;
        tt += rest * turn * turn;
        ru += residual * u;
        rv += residual * v;
        rt += residual * turn;
        rr += residual * residual;
        ll += l * l;
      }
      std::size_t quantity = 0;
      for (const Vector& sum : {uu, uv, ut, vv, vt, tt, ru, rv, rt, rr, ll})
        reinterpret_cast<Vector&>(lanes[quantity++][first]) = sum;
    }
    for (std::size_t q = 0; q < 6; ++q) addTo(sums.block[q], lanes[q]);
    for (std::size_t q = 0; q < 3; ++q) addTo(sums.gradient[q], lanes[6 + q]);
    addTo(sums.cost, lanes[9]);
    addTo(sums.energy, lanes[10]);
    bool moves = false;
    for (std::size_t l = 0; l < kLanes; ++l) moves = moves || lanes[0][l] > 0 || lanes[3][l] > 0;
    return moves;
  }

  SUBMAP_SLAM_INLINE static void link(const MemberRows<Scalar>& i, const MemberRows<Scalar>& j,
                                      std::size_t points, LinkSums& sums) {
    alignas(64) std::array<Lanes, 9> lanes;
    for (std::size_t first = 0; first < kLanes; first += kWidth) {
      Vector uu{}, uv{}, ut{}, vu{}, vv{}, vt{}, tu{}, tv{}, tt{};
      for (std::size_t k = first; k < points; k += kLanes) {
        const Vector u = at(i.weighted[0], k), v = at(i.weighted[1], k), t = at(i.weighted[2], k);
        const Vector u_j = at(j.weighted[0], k), v_j = at(j.weighted[1], k), t_j = at(j.weighted[2], k);
        uu += u * u_j;
        uv += u * v_j;
        ut += u * t_j;
        vu += v * u_j;
        vv += v * v_j;
        vt += v * t_j;
        tu += t * u_j;
        tv += t * v_j;
        tt += t * t_j;
      }
      std::size_t quantity = 0;
      for (const Vector& sum : {uu, uv, ut, vu, vv, vt, tu, tv, tt})
        reinterpret_cast<Vector&>(lanes[quantity++][first]) = sum;
    }
    for (std::size_t q = 0; q < 9; ++q) addTo(sums[q], lanes[q]);
  }
};

// An attribute can't be put in parentheses. NOLINTBEGIN(bugprone-macro-parentheses)
/** The loops compiled for one instruction set: `target` is what the compiler may use. */
#define SUBMAP_SLAM_LANE_KERNEL(name, bytes, target)                                                        \
  template <class Scalar>                                                                                   \
  struct name {                                                                                             \
    using L = Loops<Scalar, bytes>;                                                                         \
    target static void mark(const TileView<Scalar>& view, std::array<uint8_t, kTilePoints>& marked) {       \
      L::mark(view, marked);                                                                                \
    }                                                                                                       \
    target static void sample(const TileView<Scalar>& view, const PointList<Scalar>& points,                \
                              MemberRows<Scalar>& member) {                                                 \
      L::sample(view, points, member);                                                                      \
    }                                                                                                       \
    target static void fuse(const MemberRows<Scalar>* members, std::size_t count, std::size_t points,       \
                            MapRows<Scalar>& map) {                                                         \
      L::fuse(members, count, points, map);                                                                 \
    }                                                                                                       \
    target static void divide(const MemberRows<Scalar>& member, std::size_t points, Row<Scalar>& per_hit) { \
      L::divide(member, points, per_hit);                                                                   \
    }                                                                                                       \
    target static bool linearise(const Row<Scalar>& share, const MapRows<Scalar>& map, std::size_t points,  \
                                 MemberRows<Scalar>& member, OwnSums& sums) {                               \
      return L::linearise(share, map, points, member, sums);                                                \
    }                                                                                                       \
    target static void link(const MemberRows<Scalar>& first, const MemberRows<Scalar>& second,              \
                            std::size_t points, LinkSums& sums) {                                           \
      L::link(first, second, points, sums);                                                                 \
    }                                                                                                       \
    static constexpr LaneKernel<Scalar> kernel{mark, sample, fuse, divide, linearise, link};                \
  }
// NOLINTEND(bugprone-macro-parentheses)

SUBMAP_SLAM_LANE_KERNEL(Baseline, 16, );
#ifdef __x86_64__
SUBMAP_SLAM_LANE_KERNEL(Avx2, 32, [[gnu::target("avx2")]]);
SUBMAP_SLAM_LANE_KERNEL(Avx512, 64, [[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]]);
#endif

}  // namespace

template <class Scalar>
TileView<Scalar>::TileView(const Tile& tile, const PlacedLevel& submap)
    : u_a(static_cast<Scalar>(submap.columnStep())), v_a(static_cast<Scalar>(submap.rowStep())) {
  const EvidenceLevel& level = submap.level();
  const double u = submap.columnOf(tile.a, tile.b), v = submap.rowOf(tile.a, tile.b);
  constexpr double kBelow = 2 * kTile;  // no point of the tile lies that far below its first one
  const int column = static_cast<int>(std::floor((u - kBelow) / kBlock)) * kBlock;
  const int row = static_cast<int>(std::floor((v - kBelow) / kBlock)) * kBlock;
  u0 = static_cast<Scalar>(u - column);
  v0 = static_cast<Scalar>(v - row);
  x0 = static_cast<Scalar>(level.xOf(column) / level.resolution());
  y0 = static_cast<Scalar>(level.yOf(row) / level.resolution());
  table = level.tableAt(column, row);
}

bool isSupported(InstructionSet set) {
#ifdef __x86_64__
  if (set == InstructionSet::kAvx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  if (set == InstructionSet::kAvx2) return __builtin_cpu_supports("avx2");
#endif
  return set == InstructionSet::kBaseline;
}

InstructionSet bestInstructionSet() {
  for (const InstructionSet set : {InstructionSet::kAvx512, InstructionSet::kAvx2})
    if (isSupported(set)) return set;
  return InstructionSet::kBaseline;
}

template <class Scalar>
const LaneKernel<Scalar>& laneKernel(InstructionSet set) {
#ifdef __x86_64__
  if (set == InstructionSet::kAvx512) return Avx512<Scalar>::kernel;
  if (set == InstructionSet::kAvx2) return Avx2<Scalar>::kernel;
#endif
  static_cast<void>(set);
  return Baseline<Scalar>::kernel;
}

template struct TileView<float>;
template struct TileView<double>;
template const LaneKernel<float>& laneKernel<float>(InstructionSet);
template const LaneKernel<double>& laneKernel<double>(InstructionSet);

}  // namespace submap_slam::grid_joining
