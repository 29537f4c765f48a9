// Lines of a Campbell diagram as the plots take them.
#pragma once
#include <analysis/campbell.hpp>
#include <io/plots.hpp>
#include <vector>

namespace whirl::app {

std::vector<io::CampbellLine> drawn_lines(const analysis::Campbell& c);

}  // namespace whirl::app
