// Undamped forward modes at their critical speeds, and their shapes along a shaft.
#pragma once
#include <analysis/spectra/critical.hpp>
#include <results/frequency.hpp>

namespace whirl::steps {

/// Lateral modes that an unbalance drives, in ascending order, up to max_speed, rad/s of the
/// reference. order: speed of the unbalanced shaft over that.
std::vector<analysis::Critical> undamped_forward(analysis::Linearizer& linear, double max_speed,
                                                 double order = 1.0);
/// Whether a shape moves a line across its axis, rigid parts beyond its nodes included, by more than this
/// share of its largest deflection. mesh: of the system.
bool moves(const meshes::Mesh& mesh, const system::System& system, const VecXc& shape,
           std::size_t line, double share);
/// Keeps the modes that move a line by a hundredth: those of other rotors in the deck are none of its
/// own.
void keep_modes_of(const meshes::Mesh& mesh, const system::System& system, std::size_t line,
                   std::vector<analysis::Critical>& modes);

/// A shape along a line, real, its largest 1: places s (m) and deflections u, with the cubic between
/// the stations.
struct RealShape {
  std::vector<double> s, u;
  double at(double place) const;  ///< straight between the places
};
/// @pre the linearisation of the step stands at the speed of the mode
RealShape shape_along(const results::FrequencyStep& s, const VecXc& x, std::size_t line);

}  // namespace whirl::steps
