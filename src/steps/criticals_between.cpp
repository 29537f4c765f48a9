#include <steps/criticals_between.hpp>

#include <core/contract.hpp>
#include <results/turned_back.hpp>

#include <algorithm>

namespace whirl::steps {

std::vector<analysis::Critical> criticals_between(results::FrequencyStep& s,
                                                  analysis::CriticalOptions options, double from,
                                                  double to) {
  WHIRL_EXPECTS(from <= to);
  std::vector<analysis::Critical> out;
  if (from < 0.0 && from < to) {
    analysis::Linearizer backward = results::turned_back(s);
    options.min_speed = to < 0.0 ? -to : 0.0;
    options.max_speed = -from;
    for (analysis::Critical& c : analysis::critical_speeds(backward, options)) {
      c.speed = -c.speed;
      out.push_back(std::move(c));
    }
    std::reverse(out.begin(), out.end());
  }
  if (to > 0.0 && from < to) {
    options.min_speed = std::max(from, 0.0);
    options.max_speed = to;
    for (analysis::Critical& c : analysis::critical_speeds(s.linear, options))
      out.push_back(std::move(c));
  }
  return out;
}

}  // namespace whirl::steps
