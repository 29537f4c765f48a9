// What a run will need of the memory. The numbers are measured (peak of the resident set, GCC 12,
// glibc 2.36), in kB a node unless said otherwise: blocks of the matrices and their factors, and what
// is kept of every mode and speed.
#include <deck/deck.hpp>
#include <deck/mesh_size.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::deck {

namespace {

constexpr double kB = 1e3, MB = 1e6;

double points_of(const model::SpeedRange& r) {
  return static_cast<double>(r.values.empty() ? static_cast<std::size_t>(r.points)
                                              : r.values.size());
}

double points_of(const model::FrequencyRange& r) {
  return static_cast<double>(r.values.empty() ? static_cast<std::size_t>(r.points)
                                              : r.values.size());
}

/// Of one step.
struct Need {
  double matrices = 39;  ///< kB a node
  double modes = 0;      ///< kB a node: shapes of modes, of every speed where they are followed
  double rows = 0;       ///< bytes: of every speed or frequency
};

struct NeedOfAStep {
  const model::Model& m;
  double more_threads;  ///< beside the first

  double watched() const { return static_cast<double>(m.probes.size() + m.bearings.size()); }

  /// What is kept of every speed of a response: of nodes, and of what is watched.
  Need response(double points, double nodes_kept) const {
    constexpr double of_a_node = 30, of_a_row = 500, of_one_watched = 600;
    Need n;
    n.matrices = 88 + 9.5 * more_threads;
    n.rows = points * (of_a_node * nodes_kept + of_a_row + of_one_watched * watched());
    return n;
  }
  /// Modes at a number of speeds, followed from one to the next.
  Need followed(double modes, double points) const {
    Need n;
    n.matrices = 58;
    n.modes = 1.24 * modes + 0.16 * modes * points + 2.4 * modes * more_threads;
    return n;
  }
  static Need a_few_modes(double modes) {
    Need n;
    n.modes = std::max(0.0, 1.83 * modes - 11);
    return n;
  }

  double nodes;

  Need operator()(const model::StaticStep&) const { return {}; }
  Need operator()(const model::ModalStep& x) const { return a_few_modes(x.modes); }
  Need operator()(const model::BucklingStep& x) const { return a_few_modes(x.modes); }
  Need operator()(const model::TorsionalStep& x) const { return a_few_modes(x.modes); }
  Need operator()(const model::CampbellStep& x) const {
    return followed(x.modes, points_of(x.speed));
  }
  Need operator()(const model::CriticalStep& x) const { return followed(x.modes, 1); }
  Need operator()(const model::CriticalMapStep& x) const { return followed(8, x.points); }
  Need operator()(const model::StabilityStep& x) const {
    Need n;
    n.matrices = 100;
    n.modes = 0.125 * x.modes * points_of(x.speed);
    return n;
  }
  Need operator()(const model::UnbalanceStep& x) const {
    return response(points_of(x.speed), nodes);
  }
  Need operator()(const model::HarmonicStep& x) const {
    return response(x.speeds ? points_of(*x.speeds) : points_of(*x.frequency), nodes);
  }
  Need operator()(const model::SensitivityStep& x) const {
    return response(points_of(x.frequency), 0);
  }
  Need operator()(const model::ApiLateralStep& x) const {
    Need n = response(x.points, nodes);
    n.modes = followed(12, 1).modes;
    return n;
  }
  Need operator()(const model::ApiTorsionalStep& x) const { return a_few_modes(x.modes); }
  Need operator()(const model::BalancingStep& x) const {
    return response(static_cast<double>(x.speeds.size()), nodes);
  }
  Need operator()(const model::TransientStep& x) const {
    Need n;  // two stages and more have a complex factor beside the real one
    n.matrices = x.integrator.method == "gauss4" || x.integrator.method == "radau5" ? 52 : 45;
    return n;
  }
};

/// A response that repeats with every turn only: several harmonics of it, and their Jacobian.
double harmonics_of(const model::Model& m, const model::Step& s, const NodeCount& nodes) {
  const bool response = std::holds_alternative<model::UnbalanceStep>(s.law) ||
                        std::holds_alternative<model::StabilityStep>(s.law);
  return !m.cracks.empty() && response ? 1.5 * MB * nodes.line : 0;
}

/// Frames on their way to the disk, and the surface they are drawn on.
double pictures_of(const model::Model& m, const model::Step& s, const NodeCount& nodes) {
  constexpr double of_a_point = 1.6 * kB, of_a_line_node = 4 * kB;
  double most = 0;
  for (const model::VtkOutput& o : m.output.vtk) {
    if (!o.step.empty() && o.step != s.name) continue;
    const bool surface =
        std::find(o.content.begin(), o.content.end(), "surface") != o.content.end();
    const double around = surface ? of_a_point * nodes.surface * o.points_around : 0;
    most = std::max(most, around + of_a_line_node * nodes.line);
  }
  return most;
}

/// Spectra of every probe over time, and their pictures.
double spectra_of(const model::Model& m, const model::Step& s) {
  if (!m.output.spectra || !std::holds_alternative<model::TransientStep>(s.law)) return 0;
  const double of_a_line = m.output.report ? 0.12 * MB : 0.02 * MB;
  return of_a_line * m.output.spectra->lines * static_cast<double>(m.probes.size());
}

MemoryEstimate need_of(const model::Model& m, const model::Step& s, const NodeCount& nodes,
                       int threads) {
  const Need n = std::visit(NeedOfAStep{m, static_cast<double>(threads - 1), nodes.line}, s.law);
  MemoryEstimate e;
  e.where = s.where;
  const std::string matrices =
      fmt::format("matrices of {:.0f} nodes, {:.0f} kB each", nodes.line, n.matrices);
  e.parts.push_back({matrices, n.matrices * kB * nodes.line});
  e.parts.push_back({"shapes of its modes", n.modes * kB * nodes.line});
  e.parts.push_back({"what is kept of every speed or frequency", n.rows});
  e.parts.push_back({"frames of pictures", pictures_of(m, s, nodes)});
  e.parts.push_back({"harmonics of a cracked rotor", harmonics_of(m, s, nodes)});
  e.parts.push_back({"spectra", spectra_of(m, s)});
  for (const MemoryEstimate::Part& p : e.parts)
    e.total += p.bytes;
  return e;
}

}  // namespace

MemoryEstimate estimate_memory(const model::Model& m, int threads) {
  constexpr double program = 14 * MB, of_a_report = 14 * MB, of_a_further_step = 2 * MB,
                   of_a_meshed_node = 2 * kB;
  const NodeCount nodes = count_of_nodes(m);
  MemoryEstimate most;  // what a step has needed the next one uses again
  most.parts.push_back(
      {fmt::format("the mesh of {:.0f} nodes", nodes.line), of_a_meshed_node * nodes.line});
  most.total = most.parts.front().bytes;
  for (const model::Step& s : m.steps) {
    MemoryEstimate e = need_of(m, s, nodes, threads);
    if (e.total > most.total) most = std::move(e);
  }
  const double further_steps = std::max(0.0, static_cast<double>(m.steps.size()) - 1);
  const double report = m.output.report ? of_a_report + of_a_further_step * further_steps : 0;
  most.parts.push_back({"the program and its report", program + report});
  most.total += most.parts.back().bytes;
  std::stable_sort(most.parts.begin(), most.parts.end(),
                   [](const auto& a, const auto& b) { return a.bytes > b.bytes; });
  return most;
}

double memory_of_steps_side_by_side(const model::Model& m, int threads) {
  const NodeCount nodes = count_of_nodes(m);
  std::vector<double> needs;
  for (const model::Step& s : m.steps)
    needs.push_back(need_of(m, s, nodes, threads).total);
  std::sort(needs.rbegin(), needs.rend());
  double total = estimate_memory(m, threads).total;  // with the step that needs most
  for (std::size_t k = 1; k < std::min(needs.size(), static_cast<std::size_t>(threads)); ++k)
    total += needs[k];
  return total;
}

std::vector<Diagnostic> check_memory(const model::Model& m, int threads, double limit,
                                     bool is_asked_for) {
  const MemoryEstimate e = estimate_memory(m, threads);
  if (e.total <= limit) return {};
  const NodeCount nodes = count_of_nodes(m);
  Diagnostic d;
  d.code = "E44";
  d.message =
      fmt::format("the run would take about {} of memory ({}: {}), but {}", size_text(e.total),
                  e.parts.front().what, size_text(e.parts.front().bytes),
                  is_asked_for ? fmt::format("the limit is {} (--max-memory)", size_text(limit))
                               : fmt::format("only {} are available", size_text(limit)));
  const bool is_fine = nodes.section != nullptr && nodes.in_section > 0.1 * nodes.line;
  if (is_fine && nodes.in_section > 1000)
    d.hint = fmt::format("section '{}' of shaft '{}' alone has {:.0f} elements; ",
                         nodes.section->name, nodes.shaft->name, nodes.in_section);
  d.hint += "--max-memory sets another limit, or none";
  d.where = e.where;
  return {d};
}

}  // namespace whirl::deck
