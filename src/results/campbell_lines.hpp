// Lines of a Campbell diagram as the plots take them.
#pragma once
#include <analysis/spectra/campbell.hpp>
#include <plot/plots.hpp>
#include <vector>

namespace whirl::results {

std::vector<plot::CampbellLine> drawn_lines(const analysis::Campbell& c);

}  // namespace whirl::results
