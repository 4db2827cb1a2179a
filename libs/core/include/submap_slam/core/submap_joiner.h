#pragma once

#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>
#include <submap_slam/core/joined_map.h>
#include <submap_slam/core/parameters.h>
#include <submap_slam/core/progress.h>
#include <submap_slam/core/version.h>

#include <string>

namespace submap_slam {

/** What every joiner plugin offers: it finds the submap frames (and the map) that fit together best.
 *
 * A plugin is a shared library with one or more classes derived from this one, each made known by
 * SUBMAP_SLAM_REGISTER_JOINER. Only std exceptions may leave it. docs/extending.md walks through an example.
 */
class SubmapJoiner : public mrpt::rtti::CObject {
  DEFINE_VIRTUAL_MRPT_OBJECT(SubmapJoiner)

 public:
  ~SubmapJoiner() override = default;

  /** Name in `[joining] chain` and of the ini section with the joiner's parameters. */
  virtual std::string name() const = 0;

  /** One line for --list-joiners. */
  virtual std::string description() const = 0;

  /** Adds the joiner's section and keys; the table points into this object, whose parameters it sets. */
  virtual void describe(ParameterTable& table) = 0;

  /** Throws ConfigError if the parameters contradict each other; called once before join. */
  virtual void validate() const {}

  /** Joins.
   * @param submaps  in log order, at least one
   * @param initial  frames to start from, one for each submap (from the chain or the joiner before), with the
   * constraints so far
   * @param progress may be empty; false from it ends the iteration early with the best frames so far
   * @return frames with the first one fixed; a status instead of an exception for every numerical outcome.
   * The global map may be left empty: the caller then fuses it by eq. (15). The result must not depend on the
   * number of threads. */
  virtual JoinedMap join(const GridSubmaps& submaps, const JoinedMap& initial,
                         const ProgressCallback& progress) const = 0;
};

}  // namespace submap_slam

/** Put once into one source file of a plugin for each joiner class; `function` is any unused identifier. */
#define SUBMAP_SLAM_REGISTER_JOINER(function, Class) \
  MRPT_INITIALIZER(function) { mrpt::rtti::registerClass(CLASS_ID(Class)); }

/** Put exactly once into a plugin: tells the loader which interface it was built against. */
#define SUBMAP_SLAM_PLUGIN()                                                             \
  extern "C" __attribute__((visibility("default"))) int submap_slam_plugin_interface() { \
    return submap_slam::kPluginInterfaceVersion;                                         \
  }
