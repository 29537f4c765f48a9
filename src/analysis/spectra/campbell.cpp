#include <analysis/spectra/campbell.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace whirl::analysis {

CampbellRecorder::CampbellRecorder(std::vector<double> speeds, bool shapes) : shapes_(shapes) {
  out_.speeds = std::move(speeds);
}

void CampbellRecorder::take(std::size_t k, const std::vector<TrackedMode>& modes, Index lines) {
  WHIRL_EXPECTS(k < out_.speeds.size());
  WHIRL_EXPECTS(lines >= 0);
  const std::size_t n = out_.speeds.size();
  for (Index id = static_cast<Index>(out_.lines.size()); id < lines; ++id) {
    CampbellLine line;
    line.frequency.assign(n, nan);
    line.damping_ratio.assign(n, nan);
    line.log_decrement.assign(n, nan);
    line.direction_at.assign(n, Direction::none);
    line.lambda.assign(n, Complex(nan, nan));
    if (shapes_) line.shape.resize(n);
    out_.lines.push_back(std::move(line));
    votes_.push_back({0, 0, 0});
  }
  for (const TrackedMode& m : modes) {
    CampbellLine& line = out_.lines[at(m.id)];
    line.frequency[k] = m.now.frequency;
    line.damping_ratio[k] = m.now.damping_ratio;
    line.log_decrement[k] = m.now.log_decrement;
    line.direction_at[k] = m.now.direction;
    line.lambda[k] = m.now.lambda;
    if (shapes_) line.shape[k] = m.now.x;
    ++votes_[at(m.id)][static_cast<std::size_t>(m.now.kind)];
  }
}

Campbell CampbellRecorder::finish(long speeds_solved) {
  Campbell out = std::move(out_);
  const auto& votes = votes_;
  const std::size_t n = out.speeds.size();
  out.speeds_solved = speeds_solved;
  // A line met only between the speeds asked for has nothing to show.
  std::vector<CampbellLine> kept;
  for (std::size_t l = 0; l < out.lines.size(); ++l) {
    CampbellLine& line = out.lines[l];
    if (std::all_of(line.frequency.begin(), line.frequency.end(),
                    [](double f) { return std::isnan(f); }))
      continue;
    line.kind = static_cast<ModeKind>(std::max_element(votes[l].begin(), votes[l].end()) -
                                      votes[l].begin());
    std::array<int, 5> directions{};
    for (std::size_t k = 0; k < n; ++k)
      if (!std::isnan(line.frequency[k]))
        ++directions[static_cast<std::size_t>(line.direction_at[k])];
    // planar (at rest) decides only when there is nothing else
    const int planar = directions[3];
    directions[3] = 0;
    line.direction = static_cast<Direction>(std::max_element(directions.begin(), directions.end()) -
                                            directions.begin());
    if (directions[static_cast<std::size_t>(line.direction)] == 0 && planar > 0)
      line.direction = Direction::planar;
    kept.push_back(std::move(line));
  }
  out.lines = std::move(kept);
  const auto first = [](const CampbellLine& l) {
    for (double f : l.frequency)
      if (!std::isnan(f)) return f;
    return infinity;
  };
  const auto mean = [](const CampbellLine& l) {
    double s = 0;
    int c = 0;
    for (double f : l.frequency)
      if (!std::isnan(f)) {
        s += f;
        ++c;
      }
    return s / std::max(c, 1);
  };
  // Lines that start together (a pair at rest) go on by their mean: backward before forward.
  std::stable_sort(
      out.lines.begin(), out.lines.end(),
      [&](const CampbellLine& a, const CampbellLine& b) { return first(a) < first(b); });
  for (auto i = out.lines.begin(); i != out.lines.end();) {
    auto j = i + 1;
    while (j != out.lines.end() && first(*j) - first(*i) <= 1e-9 * first(*j))
      ++j;
    std::stable_sort(
        i, j, [&](const CampbellLine& a, const CampbellLine& b) { return mean(a) < mean(b); });
    i = j;
  }
  std::map<std::string, int> count;
  for (CampbellLine& l : out.lines) {
    const std::string letter = l.kind == ModeKind::torsional        ? "T"
                               : l.kind == ModeKind::axial          ? "A"
                               : l.direction == Direction::forward  ? "F"
                               : l.direction == Direction::backward ? "B"
                               : l.direction == Direction::mixed    ? "M"
                                                                    : "L";
    const std::string number = std::to_string(++count[letter]);
    l.label = l.kind == ModeKind::lateral ? number + " " + letter : letter + number;
  }
  return out;
}

Campbell campbell(Linearizer& linear, const CampbellOptions& options,
                  const ModeTracker::Visit& visit) {
  CampbellRecorder recorder(options.speeds, options.shapes);
  ModeTracker tracker(linear, options.track);
  std::vector<SpectrumCertificate> certificates;
  for (std::size_t k = 0; k < options.speeds.size(); ++k) {
    const auto& modes = tracker.advance(options.speeds[k], visit);
    recorder.take(k, modes, tracker.lines());
    certificates.push_back(tracker.solver().certificate());
  }
  Campbell out = recorder.finish(tracker.speeds_solved());
  out.certificates = std::move(certificates);
  return out;
}

}  // namespace whirl::analysis
