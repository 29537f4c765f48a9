#include <python/linear_rotor.hpp>
#include <results/frequency.hpp>
#include <results/steady_rotation.hpp>
#include <fmt/format.h>
#include <utility>

namespace whirl::python {

namespace {

analysis::EquilibriumOptions equilibrium_options(const model::Model& model) {
  analysis::EquilibriumOptions o;
  o.chart_change = model.chart_change;
  return o;
}

std::vector<std::string> notes_of(const model::Model& model, const assembly::Built& built) {
  std::vector<std::string> notes = built.held;
  notes.insert(notes.end(), built.notes.begin(), built.notes.end());
  const bool stiffness = results::turns_with_stiffness(model);
  if (stiffness || results::turns_with_inertia(model))
    notes.push_back(
        fmt::format("the {} of the asymmetric rotor enters as its mean over a revolution",
                    stiffness ? "stiffness" : "inertia"));
  if (!built.table_frequencies.empty())
    notes.emplace_back(
        "supports depend on the frequency of the motion: matrices are for one of them");
  return notes;
}

}  // namespace

LinearRotor::LinearRotor(std::shared_ptr<const deck::Deck> deck, const std::string& step,
                         bool undeformed)
    : deck_(std::move(deck)),
      mesh_(meshes::make_mesh(deck_->model)),
      built_(assembly::build_system(deck_->model, mesh_, step)),
      linear_(built_.system, results::steady_rotation_of(deck_->model, mesh_, built_, 0.0),
              equilibrium_options(deck_->model)),
      notes_(notes_of(deck_->model, built_)) {
  if (undeformed) linear_.stay_undeformed();
  const auto active = linear_.active();
  row_of_.assign(active.size(), -1);
  for (std::size_t k = 0; k < active.size(); ++k) {
    if (!active[k]) continue;
    row_of_[k] = static_cast<std::int32_t>(free_.size());
    free_.push_back(static_cast<Index>(k));
  }
}

/// own A + transposed A^T.
SparseRows LinearRotor::rows_of(const la::BlockMatrix<6>& m, double own, double transposed) const {
  SparseRows out;
  out.starts.push_back(0);
  const la::BlockPattern& pattern = m.pattern();
  for (const Index unknown : free_) {
    const Index node = unknown / 6, r = unknown % 6;
    for (Index k = pattern.row_start()[at(node)]; k < pattern.row_start()[at(node) + 1]; ++k) {
      const Index other = pattern.cols()[at(k)];
      const auto block = m.block(k);
      const auto mirrored = m.block(pattern.slot(other, node));
      for (Index c = 0; c < 6; ++c) {
        const std::int32_t column = row_of_[at(6 * other + c)];
        if (column < 0) continue;
        const double value =
            own * block(r, c) + (transposed != 0 ? transposed * mirrored(c, r) : 0.0);
        if (value == 0.0) continue;
        out.values.push_back(value);
        out.columns.push_back(column);
      }
    }
    out.starts.push_back(static_cast<std::int32_t>(out.values.size()));
  }
  return out;
}

Matrices LinearRotor::matrices(double speed, std::optional<double> frequency) {
  const la::MCK& m = frequency ? linear_.at_frequency(speed, *frequency) : linear_.at(speed);
  return {rows_of(m.M, 1, 0), rows_of(m.C, 0.5, 0.5), rows_of(m.C, 0.5, -0.5), rows_of(m.K, 1, 0),
          speed};
}

std::vector<analysis::WhirlMode> LinearRotor::modes(double speed,
                                                    const analysis::ModesOptions& options,
                                                    analysis::SpectrumCertificate& certificate) {
  return analysis::whirl_modes(linear_, speed, options, &certificate);
}

std::vector<std::string> LinearRotor::names() const {
  std::vector<std::string> out;
  for (const Index unknown : free_) {
    const system::NodeDef& node = built_.system.node(unknown / 6);
    const auto component = system::component_name(static_cast<int>(unknown % 6));
    out.push_back(node.scalar ? node.name : fmt::format("{}: {}", node.name, component));
  }
  return out;
}

std::vector<double> LinearRotor::stations() const {
  std::vector<double> out;
  for (const Index unknown : free_) {
    const std::size_t node = at(unknown / 6);
    const bool on_line = node < mesh_.nodes.size() && !built_.system.node(unknown / 6).scalar;
    out.push_back(on_line ? mesh_.nodes[node].s : nan);
  }
  return out;
}

std::vector<std::int32_t> LinearRotor::components() const {
  std::vector<std::int32_t> out;
  for (const Index unknown : free_)
    out.push_back(static_cast<std::int32_t>(unknown % 6));
  return out;
}

std::vector<double> LinearRotor::equilibrium() const {
  const VecX& q = linear_.equilibrium().state.q;
  std::vector<double> out;
  for (const Index unknown : free_)
    out.push_back(unknown < q.size() ? q[unknown] : nan);
  return out;
}

VecXc LinearRotor::free_part(const VecXc& x) const {
  VecXc out(static_cast<Index>(free_.size()));
  for (Index k = 0; k < out.size(); ++k)
    out[k] = x[free_[at(k)]];
  return out;
}

}  // namespace whirl::python
