#include <submap_slam/core/grid_submap.h>

#include <fmt/format.h>
#include <mrpt/core/Clock.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/stock_objects.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/stl_serialization.h>
#include <submap_slam/core/path_length.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <ostream>

IMPLEMENTS_SERIALIZABLE(GridSubmap, mrpt::obs::CObservation, submap_slam)

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::serialization::CArchive;

/** More than this in a count field is taken for a damaged file. */
constexpr uint32_t kMaxNodes = 10'000'000;

void writePose(CArchive& out, const TPose2D& p) { out << p.x << p.y << p.phi; }

TPose2D readPose(CArchive& in) {
  TPose2D p;
  in >> p.x >> p.y >> p.phi;
  return p;
}

void writeNode(CArchive& out, const SubmapNode& node, const SubmapScans& scans) {
  out << node.stamp;
  writePose(out, node.pose);
  out << static_cast<uint8_t>(node.odometry.has_value());
  if (node.odometry) writePose(out, *node.odometry);
  out << static_cast<uint32_t>(scans.size());
  for (const auto& scan : scans) out << *scan;
}

uint32_t readCount(CArchive& in) {
  const auto n = in.ReadAs<uint32_t>();
  if (n > kMaxNodes) throw std::runtime_error("implausible count in a submap");
  return n;
}

SubmapNode readNode(CArchive& in) {
  SubmapNode node;
  in >> node.stamp;
  node.pose = readPose(in);
  if (in.ReadAs<uint8_t>() != 0) node.odometry = readPose(in);
  for (uint32_t n = readCount(in); n > 0; --n)
    node.scans.push_back(in.ReadObject<mrpt::obs::CObservation2DRangeScan>());
  return node;
}

void writeStatistics(CArchive& out, const SubmapStatistics& s) {
  out << s.match_score_mean << s.match_score_min << s.match_score_max << s.rescues << s.max_particles
      << s.resamplings << s.ambiguous_scans << s.closed_because;
}

/** Sum over all cells. */
double totalHits(const PackedEvidence& evidence) {
  double sum = 0;
  evidence.forEachObserved([&sum](int, int, float, float hits) { sum += static_cast<double>(hits); });
  return sum;
}

SubmapStatistics readStatistics(CArchive& in) {
  SubmapStatistics s;
  in >> s.match_score_mean >> s.match_score_min >> s.match_score_max >> s.rescues >> s.max_particles >>
      s.resamplings >> s.ambiguous_scans >> s.closed_because;
  return s;
}

}  // namespace

std::size_t SubmapBulk::bytes() const {
  std::size_t sum = evidence->bytes() + scans.size() * sizeof(SubmapScans);
  for (const SubmapScans& of_node : scans)
    for (const auto& scan : of_node)
      sum += sizeof(*scan) + scan->getScanSize() * (sizeof(float) + sizeof(int32_t) + sizeof(char));
  return sum;
}

EvidenceSummary summaryOf(const PackedEvidence& evidence) {
  EvidenceSummary summary;
  summary.resolution = evidence.resolution();
  summary.x_min = evidence.xMin(), summary.y_min = evidence.yMin();
  summary.columns = evidence.sizeX(), summary.rows = evidence.sizeY();
  summary.stored_cells = evidence.storedCells();
  double least = std::numeric_limits<double>::infinity();
  evidence.forEachObserved([&](int, int, float log_odds, float hits) {
    ++summary.observed_cells;
    least = std::min(least, static_cast<double>(log_odds) / static_cast<double>(hits));
  });
  if (summary.observed_cells > 0) summary.least_log_odds_per_hit = least;
  return summary;
}

/** Version 0 held the evidence as a dense grid. */
uint8_t GridSubmap::serializeGetVersion() const { return 1; }

void GridSubmap::serializeTo(CArchive& out) const {
  out << sensorLabel << timestamp << id << first_frame << end_frame;
  packedEvidence()->writeTo(out);
  const std::vector<SubmapScans> scans_of_nodes = scans();
  out << static_cast<uint32_t>(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) writeNode(out, nodes[i], scans_of_nodes[i]);
  out << end_pose << static_cast<uint8_t>(has_successor);
  writeStatistics(out, statistics);
}

void GridSubmap::serializeFrom(CArchive& in, uint8_t version) {
  if (version > serializeGetVersion()) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  in >> sensorLabel >> timestamp >> id >> first_frame >> end_frame;
  packed_ = std::make_shared<const PackedEvidence>(version == 0 ? PackedEvidence(EvidenceGrid::readFrom(in))
                                                                : PackedEvidence::readFrom(in));
  summary_ = summaryOf(*packed_);
  source_.reset();
  freeGrid();
  nodes.clear();
  for (uint32_t n = readCount(in); n > 0; --n) nodes.push_back(readNode(in));
  in >> end_pose;
  has_successor = in.ReadAs<uint8_t>() != 0;
  statistics = readStatistics(in);
}

void GridSubmap::freeGrid() const {
  evidence = EvidenceGrid();
  loaded_ = false;
}

void GridSubmap::load() const {
  if (loaded_) return;
  evidence = packedEvidence()->unpacked();
  packed_.reset();
  loaded_ = true;
}

void GridSubmap::unload() const {
  if (!loaded_) return;
  const auto packed = std::make_shared<const PackedEvidence>(evidence);
  summary_ = summaryOf(*packed);
  if (!source_) packed_ = packed;
  freeGrid();
}

void GridSubmap::storeAway(std::shared_ptr<const SubmapBulkSource> source) {
  source_ = std::move(source);
  unload();
  packed_.reset();
  for (SubmapNode& node : nodes) {
    node.scans_are_stored_away = node.isKey();
    node.scans = {};
  }
}

std::shared_ptr<const PackedEvidence> GridSubmap::packedEvidence() const {
  if (loaded_) return std::make_shared<const PackedEvidence>(evidence);
  return packed_ ? packed_ : source_->bulk()->evidence;
}

std::vector<SubmapScans> GridSubmap::scans() const {
  if (source_) return source_->bulk()->scans;
  std::vector<SubmapScans> scans;
  for (const SubmapNode& node : nodes) scans.push_back(node.scans);
  return scans;
}

double GridSubmap::radius() const {
  const auto packed = packedEvidence();
  double r2 = 0;
  packed->forEachObserved([&](int cx, int cy, float, float) {
    const double x = packed->xMin() + (cx + 0.5) * packed->resolution();
    const double y = packed->yMin() + (cy + 0.5) * packed->resolution();
    r2 = std::max(r2, x * x + y * y);
  });
  return std::sqrt(r2);
}

double GridSubmap::pathLength() const { return submap_slam::pathLength(nodes); }

std::size_t GridSubmap::keyNodes() const {
  return static_cast<std::size_t>(
      std::count_if(nodes.begin(), nodes.end(), [](const SubmapNode& n) { return n.isKey(); }));
}

void GridSubmap::getSensorPose(mrpt::poses::CPose3D& pose) const { pose = mrpt::poses::CPose3D(); }

void GridSubmap::setSensorPose(const mrpt::poses::CPose3D&) {
  throw std::logic_error("a GridSubmap has no sensor pose; its frame is the robot pose at its first node");
}

void GridSubmap::getDescriptionAsText(std::ostream& out) const {
  CObservation::getDescriptionAsText(out);
  const EvidenceSummary grid = evidenceSummary();
  const auto end = end_pose.mean;
  out << fmt::format(
      "\nGrid submap {}\n"
      "  frames of the log : {} to {}\n"
      "  nodes             : {} ({} with scans), path {:.2f} m\n"
      "  grid              : {} x {} cells of {:.3f} m, {} observed, {:.0f} hits\n"
      "  end pose          : x {:.3f} m, y {:.3f} m, heading {:.2f} deg\n"
      "  its 1-sigma       : x {:.4f} m, y {:.4f} m, heading {:.3f} deg\n"
      "  match score       : mean {:.3f}, min {:.3f}, max {:.3f}\n"
      "  filter            : {} rescues, {} ambiguous scans, at most {} particles, {} resamplings\n"
      "  closed because    : {}\n",
      id, first_frame, end_frame, nodes.size(), keyNodes(), pathLength(), grid.columns, grid.rows,
      grid.resolution, grid.observed_cells, totalHits(*packedEvidence()), end.x(), end.y(),
      mrpt::RAD2DEG(end.phi()), std::sqrt(end_pose.cov(0, 0)), std::sqrt(end_pose.cov(1, 1)),
      mrpt::RAD2DEG(std::sqrt(end_pose.cov(2, 2))), statistics.match_score_mean, statistics.match_score_min,
      statistics.match_score_max, statistics.rescues, statistics.ambiguous_scans, statistics.max_particles,
      statistics.resamplings, statistics.closed_because);
}

std::string GridSubmap::exportTxtHeader() const {
  return "id first_frame end_frame nodes key_nodes path_m cells end_x_m end_y_m end_phi_rad "
         "hits end_sigma_x_m end_sigma_y_m end_sigma_phi_rad";
}

std::string GridSubmap::exportTxtDataRow() const {
  const EvidenceSummary grid = evidenceSummary();
  const auto sigma = [this](int i) { return std::sqrt(end_pose.cov(i, i)); };
  return fmt::format("{} {} {} {} {} {:.4f} {} {:.9g} {:.9g} {:.9g} {:.0f} {:.6g} {:.6g} {:.6g}", id,
                     first_frame, end_frame, nodes.size(), keyNodes(), pathLength(), grid.observed_cells,
                     end_pose.mean.x(), end_pose.mean.y(), end_pose.mean.phi(), totalHits(*packedEvidence()),
                     sigma(0), sigma(1), sigma(2));
}

void GridSubmap::getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const {
  out.clear();
  packedEvidence()->toOccupancyGrid().getVisualizationInto(out);
  auto path = mrpt::opengl::CSetOfLines::Create();
  path->setColor_u8(0x20, 0x60, 0xd0);
  path->setLineWidth(2);
  constexpr double kAboveGrid = 0.02;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const auto &a = nodes[i - 1].pose, &b = nodes[i].pose;
    path->appendLine(a.x, a.y, kAboveGrid, b.x, b.y, kAboveGrid);
  }
  out.insert(path);
  out.insert(mrpt::opengl::stock_objects::CornerXYZSimple(1.0f));
}

}  // namespace submap_slam
