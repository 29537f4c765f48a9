#include <results/compliance.hpp>

#include <core/text.hpp>
#include <meshes/mass_properties.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

namespace {

const char* sign_of(Check::Rule rule) {
  switch (rule) {
    case Check::Rule::at_least: return ">=";
    case Check::Rule::at_most: return "<=";
    case Check::Rule::none: break;
  }
  return "";
}

std::string result_of(const Check& c) {
  return !c.judged ? "for information" : c.passed ? "passed" : "FAILED";
}

std::string number_of(double x) { return std::isnan(x) ? std::string() : fmt::format("{:.5g}", x); }

}  // namespace

Check compare(std::string what, double value, std::string unit, Check::Rule rule, double limit) {
  Check c;
  c.what = std::move(what);
  c.value = value;
  c.unit = std::move(unit);
  c.rule = rule;
  c.limit = limit;
  c.judged = rule != Check::Rule::none;
  c.passed = rule == Check::Rule::at_least  ? value >= limit
             : rule == Check::Rule::at_most ? value <= limit
                                            : true;
  return c;
}

int Compliance::failed() const {
  return static_cast<int>(std::count_if(checks_.begin(), checks_.end(),
                                        [](const Check& c) { return c.judged && !c.passed; }));
}

io::Table Compliance::table(const std::string& title) const {
  io::Table t;
  t.title = title;
  t.columns = {{"check", "-", ""},  {"set", "-", ""},
               {"where", "-", ""},  {"value", "-", "in the unit of its row"},
               {"rule", "-", ""},   {"limit", "-", "in the unit of its row"},
               {"unit", "-", ""},   {"result", "-", ""},
               {"source", "-", ""}, {"figure", "-", ""},
               {"remark", "-", ""}};
  for (const Check& c : checks_) {
    using Cell = io::Table::Cell;
    const auto cell = [](double x) { return std::isnan(x) ? Cell(std::string()) : Cell(x); };
    Cell result = result_of(c), figure = c.figure;
    if (c.judged) result.mark = c.passed ? Cell::Mark::passed : Cell::Mark::failed;
    figure.figure = c.figure;
    t.add({c.what, c.set, c.where, cell(c.value), sign_of(c.rule), cell(c.limit), c.unit,
           std::move(result), c.source, std::move(figure), c.remark});
  }
  return t;
}

io::Value Compliance::value() const {
  io::Value list = io::Value::array();
  for (const Check& c : checks_) {
    io::Value e = io::Value::object();
    e["check"] = c.what;
    e["set"] = c.set;
    e["where"] = c.where;
    if (!std::isnan(c.value)) e["value"] = c.value;
    if (c.rule != Check::Rule::none) e["rule"] = sign_of(c.rule);
    if (!std::isnan(c.limit)) e["limit"] = c.limit;
    e["unit"] = c.unit;
    e["result"] = result_of(c);
    e["source"] = c.source;
    if (!c.figure.empty()) e["figure"] = c.figure;
    if (!c.remark.empty()) e["remark"] = c.remark;
    list.push(std::move(e));
  }
  return list;
}

std::string Compliance::text() const {
  std::size_t what = 5, set = 3, where = 5;
  for (const Check& c : checks_) {
    what = std::max(what, c.what.size());
    set = std::max(set, c.set.size());
    where = std::max(where, c.where.size());
  }
  std::string out =
      fmt::format("  {:<{}}  {:<{}}  {:<{}}  {:>10}  {:>13} {:<5} {}\n", "check", what, "set", set,
                  "where", where, "value", "limit", "unit", "result");
  for (const Check& c : checks_)
    out += fmt::format("  {:<{}}  {:<{}}  {:<{}}  {:>10}  {:>2} {:>10} {:<5} {}{}\n", c.what, what,
                       c.set, set, c.where, where, number_of(c.value), sign_of(c.rule),
                       number_of(c.limit), c.unit == "-" ? "" : c.unit, result_of(c),
                       c.remark.empty() ? "" : " (" + c.remark + ")");
  return out;
}

std::string source_of(const std::string& standard, const std::vector<std::string>& given,
                      const std::string& source, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (std::find(given.begin(), given.end(), key) != given.end())
      return source.empty() ? "set in the deck" : source;
  return standard;
}

io::Table station_table(const run::Job& job) {
  io::Table t;
  t.title = "Stations";
  t.columns = {{"shaft", "-", ""},
               {"s", "m", "from the left end of the shaft"},
               {"outer diameter", "mm", ""},
               {"node", "-", ""},
               {"station", "-", "sections, and what is attached there"}};
  for (const meshes::Station& s : job.mesh.stations) {
    if (s.labels.empty()) continue;
    const auto line = static_cast<std::size_t>(s.line);
    t.add({job.mesh.lines[line].name, s.s, 2e3 * job.mesh.radius(job.model, line, s.s),
           static_cast<int>(s.at.node), s.label()});
  }
  return t;
}

io::Table mass_table(const model::Model& m) {
  io::Table t;
  t.title = "Masses";
  t.columns = {{"shaft", "-", "with disks and added mass"},
               {"mass", "kg", ""},
               {"centre", "m", "along the machine"},
               {"Ip", "kg m2", "about the axis through the centre"},
               {"Id", "kg m2", "transverse, mean"}};
  const auto row = [&](const std::string& name, const meshes::MassProperties& p) {
    t.add({name, p.mass, p.centre().x(), p.Ip(), p.Id()});
  };
  for (std::size_t k = 0; k < m.shafts.size(); ++k)
    row(m.shafts[k].name, meshes::shaft_mass(m, k));
  if (m.shafts.size() > 1) row("together", meshes::total_mass(m));
  return t;
}

}  // namespace whirl::results
