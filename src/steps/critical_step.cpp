// A critical-speed step: undamped and damped critical speeds of any order, solved for directly.
#include <analysis/spectra/critical.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>

#include <fmt/format.h>

#include <cmath>

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

}  // namespace

void run_critical_step(run::Job& job, const model::Step& step, const model::CriticalStep& law) {
  results::FrequencyStep s(job, step, "critical_speeds", "critical speeds", law.max_speed);
  io::Value& v = s.summary();
  v["max speed [rpm]"] = results::to_rpm(law.max_speed);
  std::string line;
  results::MeshAccuracy mesh(s);
  const run::PhaseTimer timer(job, "critical speeds");
  const bool damping = is_damped(s.linear, law.max_speed);
  int drawn = 0;
  results::warn_of_held_tables(job, step.name, law.min_speed, law.max_speed);
  for (const bool damped : {false, true}) {
    if (damped && !damping) continue;
    const char* word = damped ? "damped" : "undamped";
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
    }
    std::size_t found = 0;
    for (const double order : law.orders) {
      analysis::CriticalOptions o;
      o.order = order;
      o.min_speed = law.min_speed;
      o.max_speed = law.max_speed;
      o.damped = damped;
      o.motion = results::motion_of(law.motion);
      analysis::SpectrumCertificate certificate;
      std::vector<analysis::Critical> list = analysis::critical_speeds(s.linear, o, &certificate);
      if (damped) s.certify(certificate, fmt::format("damped, order {:g}", order));
      if (list.size() > static_cast<std::size_t>(law.modes))
        list.resize(static_cast<std::size_t>(law.modes));
      found += list.size();
      io::Value& speeds =
          v[fmt::format("{} critical speeds [rpm]", word)][fmt::format("{:g}x", order)];
      if (list.empty()) speeds = io::Value::array();
      for (std::size_t k = 0; k < list.size(); ++k) {
        const analysis::Critical& c = list[k];
        mesh.of(c.mode, c.speed, fmt::format("{} critical speed {}", word, k + 1));
        std::vector<io::Table::Cell> row{order,
                                         static_cast<int>(k + 1),
                                         results::to_rpm(c.speed),
                                         results::to_hz(c.frequency),
                                         std::string(to_string(c.mode.kind)),
                                         results::direction_text(c.mode)};
        if (damped) {
          row.emplace_back(results::tidy(c.mode.log_decrement));
          row.emplace_back(results::tidy(c.mode.damping_ratio));
          row.emplace_back(c.amplification());
        }
        table.add(std::move(row));
        speeds.push(results::to_rpm(c.speed));
        if (damped != damping || drawn >= law.shapes)
          continue;  // shapes once: with damping where there is any
        ++drawn;
        const std::string name = fmt::format("critical_{}", drawn);
        s.linear.at(c.speed);  // the equilibrium the shape belongs to
        results::add_shape_figures(
            s, {name,
                fmt::format("{:g}x critical speed {:.6g} rpm, {}", order, results::to_rpm(c.speed),
                            results::description(c.mode)),
                {},
                &c.mode.x,
                c.mode.kind});
        results::write_shape_frames(s, name, c.mode.x);
      }
      if (damped == damping && line.size() < 60)
        for (std::size_t k = 0; k < std::min<std::size_t>(list.size(), 4); ++k)
          line +=
              fmt::format("{}{:.6g} ({})", line.empty() ? "" : ", ", results::to_rpm(list[k].speed),
                          list[k].mode.direction == analysis::Direction::none
                              ? to_string(list[k].mode.kind)
                              : to_string(list[k].mode.direction));
    }
    if (found == 0)
      s.section.text += fmt::format(
          "No {} critical speed lies {} {:.6g} rpm. ", word,
          law.min_speed > 0 ? fmt::format("between {:.6g} and", results::to_rpm(law.min_speed))
                            : "below",
          results::to_rpm(law.max_speed));
    mesh.report();
    s.add_table(word, std::move(table));
  }
  if (!damping)
    s.section.text += "The model has no damping: damped and undamped critical speeds are the same.";
  else
    s.section.text +=
        "Damped: the damped natural frequency meets the order line. Undamped: damping and "
        "circulation left out.";
  s.finish(line.empty()
               ? fmt::format("no critical speed below {:.0f} rpm", results::to_rpm(law.max_speed))
               : line + " rpm");
}

}  // namespace whirl::steps
