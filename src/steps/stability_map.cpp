// Stability over a parameter of the deck: the least log decrement against speed at each of its
// values, and the onset speeds.
#include <results/frequency.hpp>
#include <steps/stability_map.hpp>
#include <assembly/build_system.hpp>
#include <meshes/mesh.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace whirl::steps {

namespace {

struct Values {
  std::vector<double> number;
  std::string unit;
};
Values values_of(const model::StabilityMap& m) {
  Values v;
  for (const std::string& text : m.values) {
    char* end = nullptr;
    v.number.push_back(std::strtod(text.c_str(), &end));
    v.unit = end;
  }
  v.unit.erase(0, std::min(v.unit.find_first_not_of(' '), v.unit.size()));
  if (v.unit.empty()) v.unit = "-";
  return v;
}

bool equally_spaced(const std::vector<double>& x) {
  const double step = (x.back() - x.front()) / static_cast<double>(x.size() - 1);
  for (std::size_t k = 1; k < x.size(); ++k)
    if (std::abs(x[k] - x[k - 1] - step) > 0.01 * step) return false;
  return x.size() > 2;
}

}  // namespace

model::Model variant_of(const run::RunOptions& options, const model::Step& step,
                        const model::StabilityMap& map, const std::string& value) {
  model::Model m = options.variant(fmt::format("parameters.{}={}", map.parameter, value));
  for (const Diagnostic& w : m.warnings)
    if (w.code == "W01" && w.message.find("'" + map.parameter + "'") != std::string::npos)
      throw run_error("E89",
                      fmt::format("step '{}': nothing in the deck depends on the parameter '{}'",
                                  step.name, map.parameter),
                      fmt::format("write \"${{{}}}\" where it belongs", map.parameter), step.name);
  return m;
}

namespace {

/// A parameter's values, what was found at each, and how that is shown.
class MapResults {
 public:
  MapResults(results::FrequencyStep& s, const model::StabilityMap& law,
             const analysis::StabilityOptions& options);
  void add_onset_table();
  void add_rate_table();
  void add_map_figure();
  void add_line_figure();
  int found() const;

 private:
  bool at_once(std::size_t k) const { return std::isinf(map_.onset[k]); }
  bool never(std::size_t k) const { return std::isnan(map_.onset[k]); }
  /// nan where there is none.
  double onset_rpm(std::size_t k) const {
    return at_once(k) || never(k) ? nan : to_rpm(map_.onset[k]);
  }
  std::string remark(std::size_t k) const;
  plot::Series edge() const;
  void add_heat(plot::Axes& a) const;

  results::FrequencyStep& s_;
  const model::StabilityMap& law_;
  const Values values_;
  analysis::StabilityMap map_;
};

MapResults::MapResults(results::FrequencyStep& s, const model::StabilityMap& law,
                       const analysis::StabilityOptions& options)
    : s_(s),
      law_(law),
      values_(values_of(law)) {
  std::vector<double> place(values_.number.size());
  for (std::size_t k = 0; k < place.size(); ++k)
    place[k] = static_cast<double>(k);
  map_ = analysis::stability_map(
      [&](double k) {
        const model::Model m =
            variant_of(s.job.options, s.step, law, law.values[static_cast<std::size_t>(k)]);
        return std::move(assembly::build_system(m, meshes::make_mesh(m), s.step.name).system);
      },
      s.linear.running().running(), place, options);
}

int MapResults::found() const {
  int n = 0;
  for (std::size_t k = 0; k < map_.onset.size(); ++k)
    n += !at_once(k) && !never(k);
  return n;
}

void MapResults::add_onset_table() {
  io::Table t;
  t.title = "Onset of instability against " + law_.parameter;
  t.nan_means = "there is no onset: see the remark";
  t.columns = {{law_.parameter, values_.unit, ""},
               {"onset speed", "rpm", "lowest at which a mode becomes unstable"},
               {"whirl frequency", "Hz", ""},
               {"remark", "-", ""}};
  io::Value& v = s_.summary()["map"];
  v = io::Value::array();
  for (std::size_t k = 0; k < values_.number.size(); ++k) {
    t.add({values_.number[k], onset_rpm(k), to_hz(map_.frequency[k]), remark(k)});
    io::Value e = io::Value::object();
    e[law_.parameter] = law_.values[k];
    e["onset [rpm]"] = onset_rpm(k);
    e["certified"] = static_cast<bool>(map_.certain[k]);
    e["growth begins there"] = static_cast<bool>(map_.placed[k]);
    v.push(std::move(e));
  }
  s_.add_table("map_onset", std::move(t));
}

void MapResults::add_rate_table() {
  io::Table t;
  t.title = "Least log decrement against speed and " + law_.parameter;
  t.columns.push_back({"speed", "rpm", ""});
  for (const std::string& value : law_.values)
    t.columns.push_back({law_.parameter + " = " + value, "-", "log decrement"});
  for (std::size_t i = 0; i < map_.speeds.size(); ++i) {
    std::vector<io::Table::Cell> row{to_rpm(map_.speeds[i])};
    for (std::size_t k = 0; k < values_.number.size(); ++k)
      row.emplace_back(map_.least_log_decrement[k][i]);
    t.add(std::move(row));
  }
  s_.add_table("map", std::move(t), false);
}

std::string MapResults::remark(std::size_t k) const {
  const std::string what =
      at_once(k) ? "unstable at all speeds from the first"
      : never(k) ? (map_.certain[k] ? "stable at all speeds" : "no growth found at any speed")
      : !map_.placed[k] ? "grows there; where that begins is not known"
                        : "";
  if (map_.certain[k]) return what;
  return what + (what.empty() ? "" : "; ") + "not certified";
}

plot::Series MapResults::edge() const {
  plot::Series edge;
  edge.label = "onset";
  edge.style = {1, plot::Dash::solid, 1.8, plot::Marker::circle};
  for (std::size_t k = 0; k < values_.number.size(); ++k) {
    edge.x.push_back(values_.number[k]);
    edge.y.push_back(at_once(k) ? to_rpm(map_.speeds.front()) : onset_rpm(k));
  }
  return edge;
}

/// Cells round each value and speed; the onset is drawn over them.
void MapResults::add_heat(plot::Axes& a) const {
  if (!equally_spaced(values_.number) || !equally_spaced(map_.speeds)) return;
  const double dx = values_.number[1] - values_.number[0],
               dy = to_rpm(map_.speeds[1] - map_.speeds[0]);
  plot::HeatMap heat;
  heat.nx = static_cast<int>(values_.number.size());
  heat.ny = static_cast<int>(map_.speeds.size());
  heat.x0 = values_.number.front() - 0.5 * dx;
  heat.x1 = values_.number.back() + 0.5 * dx;
  heat.y0 = to_rpm(map_.speeds.front()) - 0.5 * dy;
  heat.y1 = to_rpm(map_.speeds.back()) + 0.5 * dy;
  for (std::size_t i = 0; i < map_.speeds.size(); ++i)
    for (std::size_t k = 0; k < values_.number.size(); ++k)
      heat.values.push_back(map_.least_log_decrement[k][i]);
  heat.label = "least log decrement";
  heat.unit = "-";
  a.x.min = heat.x0;
  a.x.max = heat.x1;
  a.y.label = "speed";
  a.y.min = std::max(0.0, heat.y0);
  a.y.max = heat.y1;
  a.heat.push_back(std::move(heat));
}

void MapResults::add_map_figure() {
  plot::Axes a;
  a.x = plot::Axis(law_.parameter, values_.unit);
  a.y = plot::Axis("onset speed of instability", "rpm");
  a.y.include_zero = true;
  a.series.push_back(edge());
  add_heat(a);
  plot::Figure f;
  f.name = s_.file("map");
  f.title = "Stability against speed and " + law_.parameter;
  f.caption =
      "Line: onset of instability, solved for at each value" +
      std::string(a.heat.empty() ? "." : "; colours: log decrement of the least stable mode.");
  f.height = 460;
  f.axes.push_back(std::move(a));
  s_.add_figure(std::move(f));
}

void MapResults::add_line_figure() {
  plot::Axes a;
  a.x = plot::Axis("speed", "rpm");
  a.y = plot::Axis("least log decrement (unstable below 0)", "-");
  a.y.include_zero = true;
  for (std::size_t k = 0; k < values_.number.size(); ++k) {
    plot::Series line;
    line.label = law_.values[k];
    for (std::size_t i = 0; i < map_.speeds.size(); ++i) {
      line.x.push_back(to_rpm(map_.speeds[i]));
      line.y.push_back(map_.least_log_decrement[k][i]);
    }
    a.series.push_back(std::move(line));
  }
  a.rules.push_back({false, 0, "", {plot::ink, plot::Dash::solid, 1.0}});
  plot::Figure f;
  f.name = s_.file("map_lines");
  f.title = "Log decrement of the least stable mode, for values of " + law_.parameter;
  f.axes.push_back(std::move(a));
  s_.add_figure(std::move(f));
}

}  // namespace

std::string add_stability_map(results::FrequencyStep& s, const model::StabilityMap& law,
                              const analysis::StabilityOptions& options) {
  if (!s.job.options.variant)
    throw run_error(
        "E89",
        fmt::format(
            "step '{}': the deck of this run cannot be read again with another value of '{}'",
            s.step.name, law.parameter),
        "", s.step.name);
  MapResults map(s, law, options);
  map.add_onset_table();
  map.add_rate_table();
  map.add_map_figure();
  map.add_line_figure();
  return fmt::format("; onset found at {} of {} values of {}", map.found(), law.values.size(),
                     law.parameter);
}

}  // namespace whirl::steps
