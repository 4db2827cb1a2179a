#pragma once

#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>
#include <submap_slam/core/parameters.h>
#include <submap_slam/core/version.h>

#include <string>

namespace submap_slam {

/** What every joiner plugin has, whatever form of submaps it joins: SubmapJoiner those with grids,
 * LandmarkJoiner those with landmarks.
 *
 * A plugin is a shared library with one or more classes derived from one of these, each made known by
 * SUBMAP_SLAM_REGISTER_JOINER. Only std exceptions may leave it. docs/extending.md walks through an example.
 */
class Joiner : public mrpt::rtti::CObject {
  DEFINE_VIRTUAL_MRPT_OBJECT(Joiner)

 public:
  ~Joiner() override = default;

  /** Name in section [joining] and of the ini section with the joiner's parameters. */
  virtual std::string name() const = 0;

  /** One line for --list-joiners. */
  virtual std::string description() const = 0;

  /** Adds the joiner's section and keys; the table points into this object, whose parameters it sets. */
  virtual void describe(ParameterTable& table) = 0;

  /** Throws ConfigError if the parameters contradict each other; called once before join. */
  virtual void validate() const {}
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
