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

std::string add_stability_map(results::FrequencyStep& s, const model::StabilityMap& law,
                              const analysis::StabilityOptions& options) {
  if (!s.job.options.variant)
    throw run_error(
        "E89",
        fmt::format(
            "step '{}': the deck of this run cannot be read again with another value of '{}'",
            s.step.name, law.parameter),
        "", s.step.name);
  const Values values = values_of(law);
  std::vector<double> place(values.number.size());
  for (std::size_t k = 0; k < place.size(); ++k)
    place[k] = static_cast<double>(k);
  const analysis::StabilityMap map = analysis::stability_map(
      [&](double k) {
        const model::Model m =
            variant_of(s.job.options, s.step, law, law.values[static_cast<std::size_t>(k)]);
        return std::move(assembly::build_system(m, meshes::make_mesh(m), s.step.name).system);
      },
      s.linear.running().running(), place, options);

  const std::string unit = values.unit;
  io::Table onset, rates;
  onset.title = "Onset of instability against " + law.parameter;
  onset.nan_means = "there is no onset: see the remark";
  onset.columns = {{law.parameter, unit, ""},
                   {"onset speed", "rpm", "lowest at which a mode becomes unstable"},
                   {"whirl frequency", "Hz", ""},
                   {"remark", "-", ""}};
  rates.title = "Least log decrement against speed and " + law.parameter;
  rates.columns.push_back({"speed", "rpm", ""});
  plot::Axes curve, lines;
  curve.x = plot::Axis(law.parameter, unit);
  curve.y = plot::Axis("onset speed of instability", "rpm");
  curve.y.include_zero = true;
  lines.x = plot::Axis("speed", "rpm");
  lines.y = plot::Axis("least log decrement (unstable below 0)", "-");
  lines.y.include_zero = true;
  plot::Series edge;
  edge.label = "onset";
  edge.style = {1, plot::Dash::solid, 1.8, plot::Marker::circle};
  io::Value& v = s.summary()["map"];
  v = io::Value::array();
  int found = 0;
  for (std::size_t k = 0; k < place.size(); ++k) {
    const double o = map.onset[k];
    const bool at_once = std::isinf(o), never = std::isnan(o);
    onset.add({values.number[k], at_once || never ? nan : to_rpm(o), to_hz(map.frequency[k]),
               std::string(at_once ? "unstable at all speeds from the first"
                           : never ? "stable at all speeds"
                                   : "")});
    io::Value e = io::Value::object();
    e[law.parameter] = law.values[k];
    e["onset [rpm]"] = at_once || never ? nan : to_rpm(o);
    v.push(std::move(e));
    found += !at_once && !never;
    edge.x.push_back(values.number[k]);
    edge.y.push_back(at_once ? to_rpm(map.speeds.front()) : never ? nan : to_rpm(o));
    rates.columns.push_back({law.parameter + " = " + law.values[k], "-", "log decrement"});
    plot::Series line;
    line.label = law.values[k];
    for (std::size_t i = 0; i < map.speeds.size(); ++i) {
      line.x.push_back(to_rpm(map.speeds[i]));
      line.y.push_back(map.least_log_decrement[k][i]);
    }
    lines.series.push_back(std::move(line));
  }
  for (std::size_t i = 0; i < map.speeds.size(); ++i) {
    std::vector<io::Table::Cell> row{to_rpm(map.speeds[i])};
    for (std::size_t k = 0; k < place.size(); ++k)
      row.emplace_back(map.least_log_decrement[k][i]);
    rates.add(std::move(row));
  }
  curve.series.push_back(edge);
  lines.rules.push_back({false, 0, "", {plot::ink, plot::Dash::solid, 1.0}});
  if (equally_spaced(values.number) && equally_spaced(map.speeds)) {
    // cells round each value and speed; the onset drawn over them
    const double dx = values.number[1] - values.number[0],
                 dy = to_rpm(map.speeds[1] - map.speeds[0]);
    plot::HeatMap heat;
    heat.nx = static_cast<int>(place.size());
    heat.ny = static_cast<int>(map.speeds.size());
    heat.x0 = values.number.front() - 0.5 * dx;
    heat.x1 = values.number.back() + 0.5 * dx;
    heat.y0 = to_rpm(map.speeds.front()) - 0.5 * dy;
    heat.y1 = to_rpm(map.speeds.back()) + 0.5 * dy;
    for (std::size_t i = 0; i < map.speeds.size(); ++i)
      for (std::size_t k = 0; k < place.size(); ++k)
        heat.values.push_back(map.least_log_decrement[k][i]);
    heat.label = "least log decrement";
    heat.unit = "-";
    curve.y.label = "speed";
    curve.heat.push_back(std::move(heat));
    curve.x.min = values.number.front() - 0.5 * dx;
    curve.x.max = values.number.back() + 0.5 * dx;
    curve.y.min = std::max(0.0, to_rpm(map.speeds.front()) - 0.5 * dy);
    curve.y.max = to_rpm(map.speeds.back()) + 0.5 * dy;
  }
  s.add_table("map_onset", std::move(onset));
  s.add_table("map", std::move(rates), false);
  plot::Figure f;
  f.name = s.file("map");
  f.title = "Stability against speed and " + law.parameter;
  f.caption =
      "Line: onset of instability, solved for at each value" +
      std::string(curve.heat.empty() ? "." : "; colours: log decrement of the least stable mode.");
  f.height = 460;
  f.axes.push_back(std::move(curve));
  s.add_figure(std::move(f));
  plot::Figure g;
  g.name = s.file("map_lines");
  g.title = "Log decrement of the least stable mode, for values of " + law.parameter;
  g.axes.push_back(std::move(lines));
  s.add_figure(std::move(g));
  return fmt::format("; onset found at {} of {} values of {}", found, place.size(), law.parameter);
}

}  // namespace whirl::steps
