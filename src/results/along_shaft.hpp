// Figures of what a static state is along a shaft: rows of axes over the position. Names of its parts.
#pragma once
#include <plot/plots.hpp>
#include <run/job.hpp>

namespace whirl::results {

/// Shaft and extent of an element of the mesh.
std::string element_name(const meshes::Mesh& mesh, std::size_t element);
/// A curve that keeps all its points.
plot::Series curve_of(std::string label);
/// Largest |y|.
double largest_of(const plot::Series& s);
/// An empty figure of one line of the mesh: `<step>_<what>`, numbered where there are several
/// lines.
plot::Figure figure_of_line(const run::Job& job, const std::string& step, const char* what,
                            std::size_t line);
/// Adds a row of axes, supports marked. curves: SI in `unit`, drawn in the one that suits (angles
/// in rad); not empty. of_several: the axis names the curve where only one is left of them.
void add_row(plot::Figure& f, const run::Job& job, std::size_t line, const char* label,
             const std::string& unit, std::vector<plot::Series> curves, bool of_several);

}  // namespace whirl::results
