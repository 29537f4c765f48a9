#include <results/campbell_lines.hpp>
#include <results/frequency.hpp>

namespace whirl::results {

std::vector<plot::CampbellLine> drawn_lines(const analysis::Campbell& c) {
  std::vector<plot::CampbellLine> out;
  for (const analysis::CampbellLine& l : c.lines) {
    plot::CampbellLine d;
    d.label = l.label;
    d.whirl = whirl_of(l.direction);
    d.speed = c.speeds;
    d.frequency = l.frequency;
    d.log_decrement = l.log_decrement;
    for (const analysis::Direction x : l.direction_at)
      d.whirl_at.push_back(l.kind == analysis::ModeKind::lateral ? whirl_of(x) : plot::Whirl::none);
    // at rest a mode is planar and moves like the line it belongs to
    for (std::size_t k = 0; k < d.whirl_at.size(); ++k)
      if (l.direction_at[k] == analysis::Direction::planar) d.whirl_at[k] = d.whirl;
    out.push_back(std::move(d));
  }
  return out;
}

}  // namespace whirl::results
