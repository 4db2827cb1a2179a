/** Poles and tree trunks in scans of a laser. */
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <submap_slam/core/frame.h>
#include <submap_slam/core/parameters.h>

#include <vector>

namespace submap_slam {

/** Parameters of the detector, ini section [detector]; the defaults are those that Guivant published for
 * tree trunks and a scanner with beams every half degree. */
struct PoleDetectorParams {
  bool enabled = false;                      ///< whether scans give landmarks
  double min_range = 1;                      ///< m
  double max_range = 75;                     ///< m
  double split_distance = 1.5;               ///< m
  double split_angle = 0.08726646259971647;  ///< rad
  double clearance = 3;                      ///< m
  double min_gap = 0.017453292519943295;     ///< rad
  double max_width = 1;                      ///< m
  double edge = 0.051333213293950866;        ///< rad
  double max_slant = 1.0 / 3;                ///< difference of the outer ranges / diameter
};

/** Adds section [detector]. */
void describe(ParameterTable& table, PoleDetectorParams& params);

/** A pole seen from the scanner. */
struct Pole {
  double range = 0;     ///< to its centre (m)
  double bearing = 0;   ///< rad, from the scanner's x axis, left positive (right, if it hangs upside down)
  double diameter = 0;  ///< m
};

/** The poles in a scan, in the order of its beams.
 *
 * Detector of J. Guivant (1999, for the Victoria Park data). Valid beams below `max_range` are split into
 * clusters where the range from one to the next changes by more than `split_distance` or the angle by more
 * than `split_angle`. Dropped are clusters that are closer than `clearance` to one of the next three, with
 * these; of two with a gap below `min_gap` the farther one; those wider than `max_width`, nearer than
 * `min_range`, within `edge` of the first or the last beam, or aslant. The diameter is the angle, with the
 * width of one beam, times the mean range; the centre is half of it behind the middle beam.
 *
 * Where a scanner's step divides an angle of the parameters, rounding decides about equal ones, as it did in
 * the published results; angles are computed as there. */
std::vector<Pole> detectPoles(const mrpt::obs::CObservation2DRangeScan& scan,
                              const PoleDetectorParams& params);

/** The poles in a scan as landmarks that nobody has named. */
LandmarkScan poleLandmarks(const mrpt::obs::CObservation2DRangeScan& scan, const PoleDetectorParams& params);

}  // namespace submap_slam
