#include <core/error.hpp>
#include <results/refined_modes.hpp>

#include <algorithm>

namespace whirl::results {
namespace {

meshes::Halved halved(const run::Job& job, const std::vector<std::string>& shafts) {
  std::vector<bool> lines;
  for (const meshes::Line& l : job.mesh.lines)
    lines.push_back(std::find(shafts.begin(), shafts.end(), l.name) != shafts.end());
  return meshes::halve(job.mesh, lines);
}

analysis::ModesOptions one_at_a_time(const FrequencyStep& s, bool damped) {
  analysis::ModesOptions o;
  o.damped = damped;
  o.certify = false;
  o.motion = s.motion();
  return o;
}

}  // namespace

RefinedModes::RefinedModes(FrequencyStep& s, const std::vector<std::string>& shafts)
    : fine_(halved(s.job, shafts)),
      built_(assembly::build_system(s.job.model, fine_.mesh, s.step.name)),
      linear_(s.linearizer_of(built_.system)),
      damped_(linear_, one_at_a_time(s, true)),
      undamped_(linear_, one_at_a_time(s, false)) {}

std::optional<double> RefinedModes::error(const analysis::WhirlMode& mode, double Omega) {
  analysis::WhirlMode start = mode;
  start.x = meshes::spread(fine_, mode.x.real()).cast<Complex>() +
            Complex(0, 1) * meshes::spread(fine_, mode.x.imag());
  if (start.x.size() != built_.system.size()) return std::nullopt;
  try {
    // "undamped" modes are those of the conservative part; where nothing damps both are the same
    const auto found = (mode.growth() == 0 ? undamped_ : damped_).follow(Omega, start);
    if (!found) return std::nullopt;
    return meshes::error_of_change * std::abs(found->lambda - mode.lambda);
  } catch (const Error&) {  // no equilibrium, or no factorisation: not judged
    return std::nullopt;
  }
}

}  // namespace whirl::results
