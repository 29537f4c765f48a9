// A critical-speed step: undamped and damped critical speeds of any order, solved for directly.
#include <analysis/spectra/critical.hpp>
#include <analysis/spectra/whirl_modes.hpp>
#include <model/resolution.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace whirl::steps {

namespace {

/// Anything that the conservative part leaves out: damping, circulation.
bool is_damped(analysis::Linearizer& linear, double Omega) {
  const la::MCK& all = linear.at(Omega);
  const auto distance = [](const la::BlockMatrix<6>& a, const la::BlockMatrix<6>& b) {
    double size = 0, apart = 0;
    for (std::size_t k = 0; k < a.value_count(); ++k) {
      size = std::max(size, std::abs(a.data()[k]));
      apart = std::max(apart, std::abs(a.data()[k] - b.data()[k]));
    }
    return size > 0 ? apart / size : 0.0;
  };
  const la::BlockMatrix<6> C = all.C, K = all.K;
  const la::MCK& conservative = linear.conservative_at(Omega);
  return distance(C, conservative.C) > 1e-12 ||
         distance(K, conservative.K) > 1e-12;  // rounding of the products
}

/// Critical speeds on their way, without damping and with it.
class CriticalRun {
 public:
  CriticalRun(run::Job& job, const model::Step& step, const model::CriticalStep& law)
      : law_(law),
        s_(job, step, "critical_speeds", "critical speeds", law.max_speed),
        mesh_(s_) {
    law_.orders = model::orders_of(job.model, law.orders);
  }
  void execute();

 private:
  void begin_where_tables_do();
  void find(bool damped);
  std::vector<analysis::Critical> solve(double order, bool damped);
  void add_rows(double order, bool damped, const std::vector<analysis::Critical>& list,
                io::Table& table);
  void look_below();
  void add_shapes(double order, const std::vector<analysis::Critical>& list);
  void add_to_line(double order, const std::vector<analysis::Critical>& list);

  model::CriticalStep law_;
  results::FrequencyStep s_;
  results::MeshAccuracy mesh_;
  bool damping_ = false;  ///< the model has any
  int drawn_ = 0;
  std::string line_;
};

io::Table empty_table(bool damped) {
  io::Table table;
  table.title = damped ? "Damped critical speeds" : "Undamped critical speeds";
  table.columns = {{"order", "-", "excitations a revolution"},
                   {"number", "-", ""},
                   {"speed", "rpm", ""},
                   {"frequency", "Hz", ""},
                   {"kind", "-", ""},
                   {"direction", "-", ""}};
  if (damped) {
    table.columns.push_back({"log decrement", "-", ""});
    table.columns.push_back({"damping ratio", "-", "of the mode"});
    table.columns.push_back({"amplification", "-", "1/(2 damping ratio)"});
    table.nan_means = "without damping the amplification has no limit";
  }
  return table;
}

std::vector<analysis::Critical> CriticalRun::solve(double order, bool damped) {
  analysis::CriticalOptions o;
  o.order = order;
  o.min_speed = law_.min_speed;
  o.max_speed = law_.max_speed;
  o.damped = damped;
  o.motion = results::motion_of(law_.motion);
  o.threads = s_.job.options.jobs;
  analysis::SpectrumCertificate certificate;
  std::vector<analysis::Critical> list = analysis::critical_speeds(s_.linear, o, &certificate);
  if (damped) s_.certify(certificate, fmt::format("damped, order {:g}", order));
  if (list.size() > static_cast<std::size_t>(law_.modes))
    list.resize(static_cast<std::size_t>(law_.modes));
  return list;
}

void CriticalRun::add_rows(double order, bool damped, const std::vector<analysis::Critical>& list,
                           io::Table& table) {
  const std::string key = fmt::format("{} critical speeds [rpm]", damped ? "damped" : "undamped");
  io::Value& speeds = s_.summary()[key][fmt::format("{:g}x", order)];
  if (list.empty()) speeds = io::Value::array();
  for (std::size_t k = 0; k < list.size(); ++k) {
    const analysis::Critical& c = list[k];
    mesh_.of(c.mode, c.speed, fmt::format("critical speed {}", k + 1));
    std::vector<io::Table::Cell> row{order,
                                     static_cast<int>(k + 1),
                                     to_rpm(c.speed),
                                     to_hz(c.frequency),
                                     std::string(to_string(c.mode.kind)),
                                     results::direction_text(c.mode)};
    if (damped) {
      row.emplace_back(results::tidy(c.mode.log_decrement));
      row.emplace_back(results::tidy(c.mode.damping_ratio));
      const double amplification = c.amplification();
      row.emplace_back(std::isinf(amplification) ? nan : amplification);
    }
    table.add(std::move(row));
    speeds.push(to_rpm(c.speed));
  }
}

/// What has met its order line before the search begins is not in the list.
void CriticalRun::look_below() {
  const double low = analysis::lowest_speed(law_.min_speed, law_.max_speed);
  const double order = *std::max_element(law_.orders.begin(), law_.orders.end());
  analysis::ModesOptions o;
  o.damped = o.certify = o.real_roots = false;
  o.motion = results::motion_of(law_.motion);
  o.count = 0;
  const auto count_at = [&](double Omega) {
    o.max_frequency = order * Omega;
    Index n = 0;
    for (const analysis::WhirlMode& m : analysis::whirl_modes(s_.linear, Omega, o))
      n += m.oscillates() && m.frequency < order * Omega;
    return n;
  };
  // but for what is always below it: the precession of a rotor that nothing holds
  constexpr double next_to_standstill = 1e-3;
  const Index below = law_.min_speed > 0 ? 0 : count_at(low) - count_at(next_to_standstill * low);
  if (below <= 0) return;
  const std::string said = fmt::format(
      "critical speeds below {:.6g} rpm are not looked for: {} natural frequenc{} there "
      "('min_speed' "
      "begins lower)",
      to_rpm(low), below, below == 1 ? "y lies" : "ies lie");
  s_.assume(said);
}

void CriticalRun::begin_where_tables_do() {
  if (law_.min_speed > 0) return;
  const results::TablesBegin tables = results::where_tables_begin(s_.job);
  if (tables.speed <= analysis::lowest_speed(0.0, law_.max_speed)) return;
  law_.min_speed = tables.speed;
  s_.assume(tables.said);
}

void CriticalRun::add_shapes(double order, const std::vector<analysis::Critical>& list) {
  for (const analysis::Critical& c : list) {
    if (drawn_ >= law_.shapes) return;
    const std::string name = fmt::format("critical_{}", ++drawn_);
    s_.linear.at(c.speed);  // the equilibrium the shape belongs to
    results::add_shape_figures(s_, {name,
                                    fmt::format("{:g}x critical speed {:.6g} rpm, {}", order,
                                                to_rpm(c.speed), results::description(c.mode)),
                                    {},
                                    &c.mode.x,
                                    c.mode.kind});
    results::write_shape_frames(s_, name, c.mode.x);
  }
}

void CriticalRun::add_to_line(double order, const std::vector<analysis::Critical>& list) {
  constexpr std::size_t most = 4;
  constexpr std::size_t long_enough = 100;
  const bool several = law_.orders.size() > 1;
  const bool full = line_.size() >= long_enough;
  if (several && !full && !list.empty())
    line_ += fmt::format("{}{:g}x: ", line_.empty() ? "" : "; ", order);
  for (std::size_t k = 0; k < std::min(list.size(), full ? 0 : most); ++k) {
    const analysis::WhirlMode& mode = list[k].mode;
    line_ += fmt::format("{}{:.6g} ({})", k == 0 ? "" : ", ", to_rpm(list[k].speed),
                         mode.direction == analysis::Direction::none ? to_string(mode.kind)
                                                                     : to_string(mode.direction));
  }
  if (list.size() > (full ? 0 : most) && !line_.ends_with("..")) line_ += ", ..";
}

void CriticalRun::find(bool damped) {
  const char* word = damped ? "damped" : "undamped";
  io::Table table = empty_table(damped);
  for (const double order : law_.orders) {
    const std::vector<analysis::Critical> list = solve(order, damped);
    add_rows(order, damped, list, table);
    if (damped != damping_) continue;  // shown once: with damping where there is any
    add_shapes(order, list);
    add_to_line(order, list);
  }
  if (!damped) look_below();
  if (table.rows.empty())
    s_.section.text += fmt::format(
        "No {} critical speed lies between {:.6g} and {:.6g} rpm. ", word,
        to_rpm(analysis::lowest_speed(law_.min_speed, law_.max_speed)), to_rpm(law_.max_speed));
  mesh_.report();
  s_.add_table(word, std::move(table));
}

void CriticalRun::execute() {
  s_.summary()["max speed [rpm]"] = to_rpm(law_.max_speed);
  begin_where_tables_do();
  results::warn_of_tables(s_.job, s_.step.name, law_.min_speed, law_.max_speed);
  const run::PhaseTimer timer(s_.job, "critical speeds");
  damping_ = is_damped(s_.linear, law_.max_speed);
  find(false);
  if (damping_) find(true);
  s_.section.text +=
      damping_ ? "Damped: the damped natural frequency meets the order line. Undamped: damping and "
                 "circulation left out."
               : "The model has no damping: damped and undamped critical speeds are the same.";
  s_.finish(line_.empty()
                ? fmt::format("no critical speed between {:.6g} and {:.6g} rpm",
                              to_rpm(analysis::lowest_speed(law_.min_speed, law_.max_speed)),
                              to_rpm(law_.max_speed))
                : line_ + " rpm");
}

}  // namespace

void run_critical_step(run::Job& job, const model::Step& step, const model::CriticalStep& law) {
  CriticalRun(job, step, law).execute();
}

}  // namespace whirl::steps
