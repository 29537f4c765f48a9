// Clearance diagrams: how near a motion brings the machine to the walls about it.
#pragma once
#include <results/channels.hpp>
#include <assembly/build_system.hpp>
#include <plot/plots.hpp>

#include <string>
#include <vector>

namespace whirl::results {

/// A gap and the most that a motion took of it.
struct UsedGap {
  std::size_t bearing = 0;    ///< of the model
  double gap = 0, reach = 0;  ///< m: radial; largest displacement against the other side
  std::string at;             ///< "3000 rpm", "t = 0.2 s"
};

/// Annular seals of the model, whose clearance is no condition of its own.
std::vector<std::size_t> seals_of(const model::Model& m);
double seal_gap(const model::Bearing& seal);
/// Of the shaft against the other side of a support, across the axis, m.
double displacement_at(const meshes::BearingNodes& at, const assembly::NodeAt& node);

/// All stations, line by line, with where they are looked at.
std::vector<analysis::Point> station_points(const run::Job& job);

/// Adds diagram and table. reach: largest distance of each station from its place at rest, m, in the
/// order of the mesh. of: what moves, "response to unbalance"; id: of figure and table.
void add_clearances(const run::Job& job, io::ReportSection& section, const std::string& id,
                    const std::string& of, const std::vector<double>& reach,
                    const std::vector<UsedGap>& gaps);

}  // namespace whirl::results
