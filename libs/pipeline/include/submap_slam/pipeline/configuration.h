#pragma once

#include <submap_slam/core/landmark_joiner.h>
#include <submap_slam/core/parameters.h>
#include <submap_slam/core/submap_joiner.h>
#include <submap_slam/landmarks/landmark_mapper_params.h>
#include <submap_slam/landmarks/pole_detector.h>
#include <submap_slam/mapping/grid_mapper.h>
#include <submap_slam/mapping/node_refinement.h>
#include <submap_slam/mapping/stretch_splitter.h>
#include <submap_slam/rawlog/rawlog_reader.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace submap_slam {

using JoinerChain = std::vector<std::shared_ptr<SubmapJoiner>>;

/** Section [joining]. */
struct JoiningParams {
  std::string chain =
      "odometry_pose_graph, grid_gauss_newton";  ///< names of joiners, in the order in which they run
  bool incremental = false;                      ///< join while submaps are built
  double update_growth = 1.1;                    ///< then: submaps at an update / those at the one before
  std::string map = "scans";  ///< what the global map is made from: "scans" (mapFromScans) or "submaps"
  double map_resolution = 0;  ///< m per cell of the global map; 0: that of the submaps
  std::string landmark_joiner = "eif_tree";  ///< name of the joiner of landmark submaps
  double memory = 200;                       ///< MB that the program may take while it joins, about
};

/** Section [output]. */
struct OutputParams {
  bool report = true;  ///< write report.html
};

/** Every parameter of a run, with one table that loads, checks, writes and documents them all. */
class Configuration {
 public:
  /** The defaults. Loads the installed plugins and `plugin_files`; each joiner adds its own section. */
  explicit Configuration(const std::vector<std::string>& plugin_files = {});
  Configuration(const Configuration&) = delete;
  Configuration& operator=(const Configuration&) = delete;

  /** The joiners named in [joining] chain, configured; throws PluginError for a name that no plugin offers
   * and ConfigError if a joiner's parameters contradict each other. */
  JoinerChain joinerChain() const;

  /** The joiner named in [joining] landmark_joiner; errors as above. */
  std::shared_ptr<LandmarkJoiner> landmarkJoiner() const;

  /** Fingerprint of everything that the submaps depend on besides the log: parameters, seed and version. */
  std::string submapFingerprint() const;

  ReaderParams reader;
  StretchParams stretches;
  std::string maps = "auto";  ///< [mapping] maps, see mapForms()
  GridMapperParams mapper;
  PoleDetectorParams detector;
  LandmarkMapperParams landmark_mapper;
  uint64_t seed = 1;
  JoiningParams joining;
  NodeRefinementParams node_refinement;
  OutputParams output;
  std::string plugins;                           ///< [plugins] load, files
  std::vector<std::shared_ptr<Joiner>> joiners;  ///< all that are available, sorted by name
  ParameterTable table;                          ///< points into the members above and into the joiners

 private:
  std::size_t submap_parameters_;  ///< the first ones of the table are those that the submaps depend on
};

/** What the user said about the configuration; empty members keep what the ini file says. */
struct ConfigurationOptions {
  std::string config_file;            ///< empty: default.ini of the installation
  std::vector<std::string> settings;  ///< "section.key=value"
  std::vector<std::string> plugins;   ///< files
  std::optional<uint64_t> seed;
  std::string from, to, sensor_labels;
};

/** The configuration that the user asked for: defaults, then the ini file, then the options. Throws
 * ConfigError, InputError or PluginError. */
std::unique_ptr<Configuration> loadConfiguration(const ConfigurationOptions& options);

}  // namespace submap_slam
