// One table of what complies with a standard: value, limit, rule, passed or not, and the figure that
// shows it.
#pragma once
#include <run/job.hpp>

#include <optional>
#include <string>
#include <vector>

namespace whirl::results {

/// One number held against a limit.
struct Check {
  std::string what;        ///< "separation margin"
  std::string set, where;  ///< "minimum clearance"; "mode 1, DE, 4512 rpm"
  double value = nan;      ///< in `unit`
  std::string unit = "-";
  enum class Rule { at_least, at_most, none } rule = Rule::none;
  double limit = nan;  ///< in `unit`; nan: no limit applies
  bool passed = true;
  bool judged = true;                  ///< false: said, not judged
  std::string source, remark, figure;  ///< figure: name within the report
};

/// A check by comparison.
Check compare(std::string what, double value, std::string unit, Check::Rule rule, double limit);

class Compliance {
 public:
  void add(Check c) { checks_.push_back(std::move(c)); }
  const std::vector<Check>& checks() const { return checks_; }
  int failed() const;
  io::Table table(const std::string& title) const;
  /// An object a check.
  io::Value value() const;
  /// As aligned text, a line a check.
  std::string text() const;

 private:
  std::vector<Check> checks_;
};

/// "API 617 (default)", or what the deck says of the limits it sets.
std::string source_of(const std::string& standard, const std::vector<std::string>& given,
                      const std::string& source, std::initializer_list<const char*> keys);

/// Stations of the shafts (place, diameter, what is there) and masses (mass, centre, moments of
/// inertia about it).
io::Table station_table(const run::Job& job);
io::Table mass_table(const model::Model& m);

}  // namespace whirl::results
