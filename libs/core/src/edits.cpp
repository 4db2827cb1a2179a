#include <submap_slam/core/edits.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <tuple>

#include "text.h"

namespace submap_slam {
namespace {

using Kind = Edit::Kind;
using Words = std::vector<std::string>;

/** Of a constraint that comes without: as well as one can read it off a map. */
constexpr double kUsualSigma_m = 0.05, kUsualSigma_rad = 0.01;

/** Of a fixed frame. It is not infinitely sure, so that two that contradict each other are still solved. */
constexpr double kFixedSigma_m = 0.001, kFixedSigma_rad = 1e-4;

/** How a kind of edit is written. */
struct Form {
  Kind kind;
  const char* usage;
  std::size_t words, ids;  ///< in all, without what may be left out, and how many of them are ids
};
constexpr std::array<Form, 4> kForms{{{Kind::kReject, "reject FROM TO", 3, 2},
                                      {Kind::kAdd, "add FROM TO X Y PHI [SIGMA_XY SIGMA_PHI]", 6, 2},
                                      {Kind::kFix, "fix ID X Y PHI", 5, 1},
                                      {Kind::kMask, "mask ID", 2, 1}}};

const Form& formOf(const std::string& word, const std::string& where) {
  for (const Form& form : kForms)
    if (std::string_view(form.usage).substr(0, word.size() + 1) == word + " ") return form;
  throw InputError(fmt::format("{}: unknown word '{}'; expected reject, add, fix or mask", where, word));
}

uint32_t idOf(const std::string& word, const Form& form, const std::string& where) {
  uint32_t id = 0;
  const char* const word_end = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), word_end, id);
  if (error != std::errc() || end != word_end)
    throw InputError(fmt::format("{}: '{}' is not the id of a submap; expected {}", where, word, form.usage));
  return id;
}

double numberOf(const std::string& word, const Form& form, const std::string& where) {
  double number = 0;
  const char* const word_end = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), word_end, number);
  if (error != std::errc() || end != word_end || !std::isfinite(number))
    throw InputError(fmt::format("{}: '{}' is not a number; expected {}", where, word, form.usage));
  return number;
}

double sigmaOf(const std::string& word, const Form& form, const std::string& where) {
  const double sigma = numberOf(word, form, where);
  if (sigma <= 0)
    throw InputError(fmt::format("{}: '{}' is no standard deviation; expected one above 0", where, word));
  return sigma;
}

Edit editOf(const Words& words, const std::string& where) {
  const Form& form = formOf(words.front(), where);
  Edit edit;
  edit.kind = form.kind;
  edit.text = fmt::format("{}", fmt::join(words, " "));
  const bool with_sigmas = form.kind == Kind::kAdd && words.size() == form.words + 2;
  if (words.size() != form.words && !with_sigmas)
    throw InputError(fmt::format("{}: '{}': expected {}", where, edit.text, form.usage));
  if (form.ids == 2) edit.from = idOf(words[1], form, where);
  edit.to = idOf(words[form.ids], form, where);
  if (form.ids == 2 && edit.from == edit.to)
    throw InputError(fmt::format("{}: '{}': expected two submaps", where, edit.text));
  if (form.words > form.ids + 1) {
    const auto number = [&](std::size_t k) { return numberOf(words[form.ids + k], form, where); };
    edit.pose = {number(1), number(2), number(3)};
  }
  const bool fixed = form.kind == Kind::kFix;
  edit.sigma_xy = with_sigmas ? sigmaOf(words[6], form, where) : fixed ? kFixedSigma_m : kUsualSigma_m;
  edit.sigma_phi = with_sigmas ? sigmaOf(words[7], form, where) : fixed ? kFixedSigma_rad : kUsualSigma_rad;
  return edit;
}

Words wordsOf(const std::string& line) {
  std::istringstream text(line.substr(0, line.find('#')));
  return {std::istream_iterator<std::string>(text), {}};
}

/** Equal for edits that speak of the same thing; a pair of submaps has no direction. */
std::tuple<Kind, uint32_t, uint32_t> subjectOf(const Edit& edit) {
  return {edit.kind, std::min(edit.from, edit.to), std::max(edit.from, edit.to)};
}

using Positions = std::map<uint32_t, std::size_t>;

Positions positionsOf(const GridSubmaps& submaps) {
  Positions positions;
  for (std::size_t k = 0; k < submaps.size(); ++k) positions.emplace(submaps[k]->id, k);
  return positions;
}

std::size_t positionOf(uint32_t id, const Positions& positions, const std::string& where) {
  const auto found = positions.find(id);
  if (positions.empty()) throw InputError(where + ": there are no grid submaps that could be edited");
  if (found == positions.end())
    throw InputError(fmt::format("{}: there is no submap {}; expected {} to {}", where, id,
                                 positions.begin()->first, positions.rbegin()->first));
  return found->second;
}

void checkEdit(const Edit& edit, const Positions& positions, const std::string& where) {
  const std::size_t to = positionOf(edit.to, positions, where);
  if (edit.kind == Kind::kFix && to == 0)
    throw InputError(fmt::format("{}: the frame of submap {} is that of the map; expected another submap",
                                 where, edit.to));
  if (edit.kind != Kind::kReject && edit.kind != Kind::kAdd) return;
  const std::size_t from = positionOf(edit.from, positions, where);
  if (edit.kind == Kind::kReject && (from + 1 == to || to + 1 == from))
    throw InputError(fmt::format("{}: submaps {} and {} follow each other; expected a loop closure", where,
                                 edit.from, edit.to));
}

Constraint constraintOf(const Edit& edit, uint32_t first_submap) {
  const bool fixed = edit.kind == Kind::kFix;
  Constraint constraint;
  constraint.from = fixed ? first_submap : edit.from;
  constraint.to = edit.to;
  constraint.inter = true;
  constraint.by_hand = true;
  constraint.accepted = edit.kind != Kind::kReject;
  constraint.reason = fixed ? "fixed by hand" : constraint.accepted ? "added by hand" : "rejected by hand";
  constraint.T_a_b.cov.setZero();
  if (!constraint.accepted) return constraint;
  constraint.T_a_b.mean = mrpt::poses::CPose2D(edit.pose);
  constraint.T_a_b.cov(0, 0) = constraint.T_a_b.cov(1, 1) = edit.sigma_xy * edit.sigma_xy;
  constraint.T_a_b.cov(2, 2) = edit.sigma_phi * edit.sigma_phi;
  return constraint;
}

GridSubmap::Ptr withoutObservations(const GridSubmap& submap) {
  // Anew, not as a copy: that would know where evidence and scans are stored away.
  auto bare = GridSubmap::Create();
  bare->timestamp = submap.timestamp;
  bare->sensorLabel = submap.sensorLabel;
  bare->id = submap.id;
  bare->first_frame = submap.first_frame;
  bare->end_frame = submap.end_frame;
  bare->end_pose = submap.end_pose;
  bare->has_successor = submap.has_successor;
  bare->statistics = submap.statistics;
  const double cell = submap.resolution();
  bare->evidence = EvidenceGrid(0, cell, 0, cell, cell);
  for (SubmapNode node : submap.nodes) {
    node.scans.clear();
    node.scans_are_stored_away = false;
    bare->nodes.push_back(node);
  }
  return bare;
}

}  // namespace

bool Edits::masks(uint32_t submap) const {
  return std::any_of(list.begin(), list.end(),
                     [submap](const Edit& edit) { return edit.kind == Kind::kMask && edit.to == submap; });
}

Edit readEdit(const std::string& line, const std::string& where) {
  const Words words = wordsOf(line);
  if (words.empty()) throw InputError(fmt::format("{}: expected reject, add, fix or mask", where));
  return editOf(words, where);
}

Edits readEdits(const std::string& file) {
  if (!std::filesystem::is_regular_file(file)) throw InputError(fmt::format("{}: no such edits file", file));
  std::ifstream in(file);
  if (!in) throw InputError(fmt::format("{}: cannot be opened", file));
  Edits edits{file, {}};
  std::map<std::tuple<Kind, uint32_t, uint32_t>, std::size_t> line_of;
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (number == 1 && line.compare(0, kByteOrderMark.size(), kByteOrderMark) == 0)
      line.erase(0, kByteOrderMark.size());
    const Words words = wordsOf(line);
    if (words.empty()) continue;
    const std::string where = fmt::format("{}:{}", file, number);
    Edit edit = editOf(words, where);
    edit.line = number;
    const auto [before, fresh] = line_of.try_emplace(subjectOf(edit), number);
    if (!fresh)
      throw InputError(fmt::format("{}: '{}': line {} said so of the same submaps already; expected it once",
                                   where, edit.text, before->second));
    edits.list.push_back(std::move(edit));
  }
  if (in.bad()) throw InputError(fmt::format("{}: cannot be read", file));
  return edits;
}

void checkEdits(const Edits& edits, const GridSubmaps& submaps) {
  const Positions positions = positionsOf(submaps);
  for (const Edit& edit : edits.list) checkEdit(edit, positions, fmt::format("{}:{}", edits.file, edit.line));
  if (std::all_of(submaps.begin(), submaps.end(), [&](const auto& s) { return edits.masks(s->id); }))
    throw InputError(fmt::format("{}: masks every submap; expected one that is left", edits.file));
}

std::vector<Constraint> constraintsOf(const Edits& edits, const GridSubmaps& submaps) {
  std::vector<Constraint> constraints;
  for (const Edit& edit : edits.list)
    if (edit.kind != Kind::kMask) constraints.push_back(constraintOf(edit, submaps.front()->id));
  return constraints;
}

GridSubmaps maskSubmaps(const GridSubmaps& submaps, const Edits& edits) {
  GridSubmaps masked = submaps;
  for (auto& submap : masked)
    if (edits.masks(submap->id)) submap = withoutObservations(*submap);
  return masked;
}

}  // namespace submap_slam
