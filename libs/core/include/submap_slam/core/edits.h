/** What the user changes about joining by hand. */
#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/joined_map.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace submap_slam {

/** One line of an edits file. */
struct Edit {
  enum class Kind {
    kReject,  ///< the loop closure between two submaps must not be used
    kAdd,     ///< a constraint between the frames of two submaps
    kFix,     ///< the frame of a submap, in the global map frame
    kMask     ///< a submap takes no part in loop search and map; its frame follows the chain
  };
  Kind kind = Kind::kMask;
  uint32_t from = 0, to = 0;  ///< submap ids; fix and mask have only `to`
  mrpt::math::TPose2D pose;   ///< add: T_from_to; fix: T_w_to (m, rad)
  double sigma_xy = 0;        ///< m, standard deviation of `pose`
  double sigma_phi = 0;       ///< rad
  std::size_t line = 0;       ///< from 1
  std::string text;           ///< the line without comment and needless blanks
};

struct Edits {
  std::string file;  ///< for errors
  std::vector<Edit> list;

  bool masks(uint32_t submap) const;
};

/** One edit from its line (see readEdits). Throws InputError beginning with `where` for any other line. */
Edit readEdit(const std::string& line, const std::string& where);

/** Reads an edits file: one edit per line, `#` begins a comment,
 *
 *     reject FROM TO
 *     add FROM TO X Y PHI [SIGMA_XY SIGMA_PHI]
 *     fix ID X Y PHI
 *     mask ID
 *
 * (ids of submaps, m, rad). Throws InputError naming file and line for a line of another form and for one
 * that repeats another. Whether the submaps exist is for checkEdits to say. */
Edits readEdits(const std::string& file);

/** Throws InputError naming file and line for an edit that these submaps do not allow: an id that none of
 * them has, the rejection of a link of the chain, a pose for the first frame, no submap left. */
void checkEdits(const Edits& edits, const GridSubmaps& submaps);

/** Edits as joiners take them: constraints by hand, the rejected ones not accepted. A fixed frame is a
 * relation to the first frame, which is that of the map. The edits must fit the submaps (checkEdits). */
std::vector<Constraint> constraintsOf(const Edits& edits, const GridSubmaps& submaps);

/** The same submaps, but copies without evidence and scans in the place of masked ones: nothing can match
 * them and the map gets nothing from them, whatever joins. */
GridSubmaps maskSubmaps(const GridSubmaps& submaps, const Edits& edits);

}  // namespace submap_slam
