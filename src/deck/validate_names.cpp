// Names that become names of files: no two may meet.
#include <deck/validate_parts.hpp>

#include <core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <type_traits>

namespace whirl::deck {

namespace {

/// "speed 1" and "speed_1" are one file.
template <class Entity>
void check_file_names_of(const std::vector<Entity>& entities, const char* kind, Problems& out) {
  std::map<std::string, const Entity*> first;
  for (const Entity& e : entities) {
    if (e.name.empty()) continue;
    const auto [before, fresh] = first.emplace(safe_stem(e.name), &e);
    if (fresh || before->second->name == e.name) continue;
    report(out, "E16",
           fmt::format("the results of {} '{}' and {} '{}' would have one name, '{}'", kind,
                       before->second->name, kind, e.name, before->first),
           "in names of files all but letters, digits, '-' and '_' becomes '_': rename one",
           e.where);
  }
}

/// What the tables of a step are called after its name, where a time history could be called so.
std::vector<std::string_view> tables_of(const model::StepLaw& law) {
  return std::visit(
      [](const auto& x) -> std::vector<std::string_view> {
        using T = std::decay_t<decltype(x)>;
        if constexpr (std::is_same_v<T, model::TransientStep>)
          return {"events", "peaks", "torques", "rainflow", "tracking", "orbits", "response_peaks"};
        else if constexpr (std::is_same_v<T, model::StaticStep>)
          return {"deflection", "supports",     "sections",        "path",
                  "films",      "pads",         "rings",           "magnets",
                  "equilibria", "coefficients", "critical_points", "unstable_direction"};
        else if constexpr (std::is_same_v<T, model::ModalStep>)
          return {"modes", "energy", "energy_parts", "real_roots"};
        else if constexpr (std::is_same_v<T, model::CampbellStep>)
          return {"campbell", "critical_speeds"};
        else if constexpr (std::is_same_v<T, model::CriticalStep>)
          return {"damped", "undamped"};
        else if constexpr (std::is_same_v<T, model::CriticalMapStep>)
          return {"critical_map"};
        else if constexpr (std::is_same_v<T, model::UnbalanceStep>)
          return {"response", "peaks", "margins", "multiples"};
        else if constexpr (std::is_same_v<T, model::HarmonicStep>)
          return {"response", "peaks"};
        else if constexpr (std::is_same_v<T, model::StabilityStep>)
          return {"bands",     "growth",    "log_decrement", "map",
                  "map_lines", "map_onset", "onset",         "verdicts"};
        else if constexpr (std::is_same_v<T, model::TorsionalStep>)
          return {"torsional", "critical_speeds"};
        else if constexpr (std::is_same_v<T, model::SensitivityStep>)
          return {"curves", "sensitivity"};
        else if constexpr (std::is_same_v<T, model::BucklingStep>)
          return {"buckling"};
        else if constexpr (std::is_same_v<T, model::BalancingStep>)
          return {"corrections", "residuals", "influence"};
        else
          return {"compliance", "masses",   "stations", "events", "margins",
                  "modes",      "stresses", "train",    "bodies", "interferences"};
      },
      law);
}

/// The history of a transient is NAME.csv.
void check_histories(const model::Model& m, Problems& out) {
  for (const model::Step& history : m.steps) {
    if (!std::holds_alternative<model::TransientStep>(history.law)) continue;
    for (const model::Step& s : m.steps) {
      if (s.name.empty() || !history.name.starts_with(s.name + "_")) continue;
      const std::string_view rest = std::string_view(history.name).substr(s.name.size() + 1);
      const std::vector<std::string_view> tables = tables_of(s.law);
      if (std::find(tables.begin(), tables.end(), rest) == tables.end()) continue;
      report(out, "E16",
             fmt::format(
                 "the history of step '{}' and a table of step '{}' would be one file, '{}.csv'",
                 history.name, s.name, history.name),
             "rename one of the steps", history.where);
    }
  }
}

}  // namespace

void check_names(const model::Model& m, Problems& out) {
  check_file_names_of(m.steps, "step", out);
  check_file_names_of(m.probes, "probe", out);
  check_file_names_of(m.shafts, "shaft", out);
  for (const model::Step& s : m.steps)
    if (const auto* report_step = std::get_if<model::ApiLateralStep>(&s.law))
      check_file_names_of(report_step->sets, "set", out);
  check_histories(m, out);
}

}  // namespace whirl::deck
