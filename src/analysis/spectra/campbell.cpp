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

namespace {

/// The direction at most speeds, of several at equally many that at the highest speed. Planar motion
/// and rest, where two circles at one frequency may come out as any two motions of their plane,
/// decide only when there is nothing else.
Direction common_direction(const CampbellLine& line, const std::vector<double>& speeds) {
  std::array<int, 5> turning{}, others{};
  Direction highest = Direction::none;
  double top = -infinity;
  for (std::size_t k = 0; k < line.frequency.size(); ++k) {
    if (std::isnan(line.frequency[k])) continue;
    const Direction now = line.direction_at[k];
    const bool decides = speeds[k] != 0.0 && now != Direction::planar;
    ++(decides ? turning : others)[static_cast<std::size_t>(now)];
    if (!decides || speeds[k] < top) continue;
    top = speeds[k];
    highest = now;
  }
  const auto most = std::max_element(turning.begin(), turning.end());
  if (*most > 0)
    return turning[static_cast<std::size_t>(highest)] == *most
               ? highest
               : static_cast<Direction>(most - turning.begin());
  return static_cast<Direction>(std::max_element(others.begin(), others.end()) - others.begin());
}

double first_frequency(const CampbellLine& line) {
  for (double f : line.frequency)
    if (!std::isnan(f)) return f;
  return infinity;
}

double mean_frequency(const CampbellLine& line) {
  double s = 0;
  int c = 0;
  for (double f : line.frequency)
    if (!std::isnan(f)) {
      s += f;
      ++c;
    }
  return s / std::max(c, 1);
}

/// By the first frequency. Lines that start together (a pair at rest) go on by their mean: backward
/// before forward.
void sort_lines(std::vector<CampbellLine>& lines) {
  std::stable_sort(lines.begin(), lines.end(), [](const CampbellLine& a, const CampbellLine& b) {
    return first_frequency(a) < first_frequency(b);
  });
  for (auto i = lines.begin(); i != lines.end();) {
    auto j = i + 1;
    while (j != lines.end() &&
           first_frequency(*j) - first_frequency(*i) <= 1e-9 * first_frequency(*j))
      ++j;
    std::stable_sort(i, j, [](const CampbellLine& a, const CampbellLine& b) {
      return mean_frequency(a) < mean_frequency(b);
    });
    i = j;
  }
}

void label_lines(std::vector<CampbellLine>& lines) {
  std::map<std::string, int> count;
  for (CampbellLine& l : lines) {
    const std::string letter = l.kind == ModeKind::torsional        ? "T"
                               : l.kind == ModeKind::axial          ? "A"
                               : l.direction == Direction::forward  ? "F"
                               : l.direction == Direction::backward ? "B"
                               : l.direction == Direction::mixed    ? "M"
                                                                    : "L";
    const std::string number = std::to_string(++count[letter]);
    if (l.kind == ModeKind::lateral) {
      l.label = number;
      l.label += " ";
      l.label += letter;
    } else {
      l.label = letter + number;
    }
  }
}

}  // namespace

Campbell CampbellRecorder::finish(long speeds_solved) {
  Campbell out = std::move(out_);
  out.speeds_solved = speeds_solved;
  // A line met only between the speeds asked for has nothing to show.
  std::vector<CampbellLine> kept;
  for (std::size_t l = 0; l < out.lines.size(); ++l) {
    CampbellLine& line = out.lines[l];
    if (std::all_of(line.frequency.begin(), line.frequency.end(),
                    [](double f) { return std::isnan(f); }))
      continue;
    const auto& votes = votes_[l];
    line.kind = static_cast<ModeKind>(std::max_element(votes.begin(), votes.end()) - votes.begin());
    line.direction = common_direction(line, out.speeds);
    kept.push_back(std::move(line));
  }
  out.lines = std::move(kept);
  sort_lines(out.lines);
  label_lines(out.lines);
  return out;
}

Campbell campbell(Linearizer& linear, const CampbellOptions& options,
                  const ModeTracker::Visit& visit) {
  CampbellRecorder recorder(options.speeds, options.shapes);
  TrackOptions track = options.track;
  track.ahead = options.speeds;
  ModeTracker tracker(linear, track);
  std::vector<SpectrumCertificate> certificates;
  std::vector<WhirlMode> last;
  for (std::size_t k = 0; k < options.speeds.size(); ++k) {
    const auto& modes = tracker.advance(options.speeds[k], visit);
    recorder.take(k, modes, tracker.lines());
    certificates.push_back(tracker.certificate());
    if (k + 1 < options.speeds.size()) continue;
    for (const TrackedMode& m : modes)
      last.push_back(m.now);
  }
  Campbell out = recorder.finish(tracker.speeds_solved());
  out.last = std::move(last);
  out.certificates = std::move(certificates);
  return out;
}

}  // namespace whirl::analysis
