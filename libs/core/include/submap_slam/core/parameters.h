/** One description of every parameter: it loads the ini file, writes the effective one, checks values and
 * documents them. */
#pragma once

#include <cstdint>
#include <iosfwd>
#include <limits>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace submap_slam {

/** Closed interval of allowed values. */
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/** One key of an ini section, bound to the member of a parameter struct that holds its value. */
struct Parameter {
  using Target = std::variant<double*, int*, uint64_t*, bool*, std::string*>;

  std::string section, key;
  Target target;
  std::string unit;                  ///< "m", "rad", "" …
  std::string description;           ///< one sentence, with the source where there is one
  Range range;                       ///< for numbers
  std::vector<std::string> choices;  ///< for strings; empty: anything

  /** The value as it is written to an ini file; reading it back gives the same bits. */
  std::string value() const;
};

/** The parameters of a program, in the order they are documented.
 *
 * The table points into parameter structs, which must outlive it. Every setter throws ConfigError naming the
 * key, and for an unknown key the nearest known one.
 */
class ParameterTable {
 public:
  /** Starts a section; the text heads it in the reference. */
  void section(const std::string& name, const std::string& title);

  void add(const std::string& key, double& target, const std::string& unit, Range range,
           const std::string& description);
  void add(const std::string& key, int& target, const std::string& unit, Range range,
           const std::string& description);
  void add(const std::string& key, uint64_t& target, const std::string& description);
  void add(const std::string& key, bool& target, const std::string& description);
  void add(const std::string& key, std::string& target, const std::string& description,
           std::vector<std::string> choices = {});

  /** Sets one parameter from text. */
  void set(const std::string& section, const std::string& key, const std::string& value);

  /** Sets one parameter from "section.key=value". */
  void set(const std::string& assignment);

  /** Sets every key found in an ini file (form: see readIni); throws InputError if it cannot be read, and
   * ConfigError naming file and line for anything else than known sections and keys, each set once. */
  void loadIni(const std::string& file);

  /** The effective values as an ini file, with a comment above each key. */
  void writeIni(std::ostream& out) const;

  /** The reference in Markdown. */
  void writeReference(std::ostream& out) const;

  const std::vector<Parameter>& parameters() const { return parameters_; }

 private:
  Parameter& find(const std::string& section, const std::string& key);
  void checkSection(const std::string& name) const;
  void addTarget(const std::string& key, Parameter::Target target, const std::string& unit, Range range,
                 const std::string& description, std::vector<std::string> choices);

  struct Section {
    std::string name, title;
  };
  std::vector<Section> sections_;
  std::vector<Parameter> parameters_;
};

}  // namespace submap_slam
