// Spectra of a transient's probes: CSV block by block, waterfall, map and full spectrum (forward
// and backward whirl apart).
#include <analysis/transient/spectrum.hpp>
#include <results/transient_output.hpp>

#include <plot/plots.hpp>
#include <core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace whirl::results {

namespace {

class SpectraOutput final : public TransientOutput {
 public:
  explicit SpectraOutput(const TransientSetup& s);
  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&spectra_);
    parts.add_output({run::Part::spectra, content_}, *this);
  }
  analysis::Observer& observer() { return spectra_; }
  void begin();
  void save(OutArchive& out);
  void restore(InArchive& in);
  void close() override;
  void report(TransientEnd& end) override;

 private:
  /// full: at equal angles where the speed changes; [probe][line].
  struct Trace {
    double t = 0, speed = 0;
    std::vector<std::vector<double>> full, y;
    std::vector<analysis::Ridge> ridge;  ///< [probe]
    double change = 0;                   ///< of the speed within the block
    bool at_equal_angles = false;
  };
  void take(analysis::SpectrumBlock block);
  std::vector<io::Channel> channels() const;
  std::vector<io::Channel> ridge_channels() const;
  std::string csv_name(const std::string& probe, const char* what = "spectra") const;
  void write(const analysis::SpectrumBlock& b);
  std::string how_taken() const;
  void add_ridge(plot::Figure& map, std::span<const Trace> traces, std::size_t probe) const;
  bool speed_varies() const;
  std::vector<std::span<const Trace>> sweeps() const;
  static std::string sweep_name(const std::vector<std::span<const Trace>>& parts,
                                std::size_t which);
  void add_against_speed(std::vector<plot::Figure>& figures, std::span<const Trace> traces,
                         const std::string& sweep, std::size_t probe) const;
  const Trace& largest_block(std::size_t probe) const;
  plot::Figure full_spectrum(std::size_t probe) const;
  std::vector<plot::SpectrumTrace> full_traces(std::span<const Trace> traces,
                                               std::size_t probe) const;
  std::vector<plot::SpectrumTrace> traces_of_y(std::span<const Trace> traces,
                                               std::size_t probe) const;
  double factor() const { return plot::factor_of(convention_); }
  double resolution() const { return options_.max_frequency / options_.lines; }  ///< rad/s
  const model::Output& out_;
  const plot::Amplitude convention_ = plot::amplitude(out_.peak_to_peak);
  model::SpectraOutput options_;
  std::string step_, content_;
  std::vector<std::string> probes_;
  std::vector<double> senses_;
  std::vector<io::TimeSeriesPtr> sinks_, ridges_;  ///< one a probe
  std::vector<Trace> traces_;
  std::size_t blocks_ = 0, stride_ = 1;
  std::vector<double> row_;
  analysis::Spectra spectra_;
};

SpectraOutput::SpectraOutput(const TransientSetup& s)
    : out_(s.job.model.output),
      options_(*out_.spectra),
      step_(s.step.name),
      senses_(probe_senses(s.job, s.start)),
      spectra_(probe_points(s.job), s.job.reference(), s.t_begin,
               {options_.max_frequency, options_.lines},
               [this](const analysis::SpectrumBlock& b) { take(b); }) {
  content_ =
      fmt::format("{} {} {} and ridges", options_.max_frequency, options_.lines, options_.traces);
  for (const model::Probe& p : s.job.model.probes) {
    probes_.push_back(p.name);
    content_ += " " + p.name;
    if (!out_.csv) continue;
    sinks_.push_back(io::make_csv_series(s.job.folder.path(csv_name(p.name))));
    ridges_.push_back(io::make_csv_series(s.job.folder.path(csv_name(p.name, "ridge"))));
  }
  row_.resize(2 + 2 * static_cast<std::size_t>(options_.lines) + 1);
}

std::vector<io::Channel> SpectraOutput::channels() const {
  std::vector<io::Channel> c{{"t", "s", "middle of the block", {}, 1.0, {}},
                             {"speed", "rpm", "mean spin of the block", {}, to_rpm(1.0), {}}};
  for (int k = -options_.lines; k <= options_.lines; ++k)
    c.push_back({fmt::format("{:.6g} Hz", to_hz(k * options_.max_frequency / options_.lines)),
                 "m",
                 "amplitude of y + iz, 0-peak; negative: against the spin",
                 {},
                 1.0,
                 {}});
  return c;
}

std::vector<io::Channel> SpectraOutput::ridge_channels() const {
  return {{"t", "s", "middle of the block", {}, 1.0, {}},
          {"speed", "rpm", "mean spin of the block", {}, to_rpm(1.0), {}},
          {"change of speed", "rpm", "within the block", {}, to_rpm(1.0), {}},
          {"frequency",
           "Hz",
           "of the strongest component; negative: against the spin",
           {},
           to_hz(1.0),
           {}},
          {"amplitude", "m", "of y + iz, 0-peak", {}, 1.0, {}},
          {"equal angles", "-", "1: from samples at equal angles, 0: at equal times", {}, 1.0, {}}};
}

void SpectraOutput::begin() {
  for (auto& s : sinks_)
    s->begin(channels());
  for (auto& s : ridges_)
    s->begin(ridge_channels());
}

void SpectraOutput::close() {
  for (auto* list : {&sinks_, &ridges_})
    for (auto& s : *list)
      s->close();
}

void SpectraOutput::write(const analysis::SpectrumBlock& b) {
  for (std::size_t p = 0; p < sinks_.size(); ++p) {
    row_[0] = b.t;
    row_[1] = b.speed;
    std::copy(b.full[p].begin(), b.full[p].end(), row_.begin() + 2);
    sinks_[p]->append(row_);
    const analysis::Ridge& r = b.ridge[p];
    const std::array<double, 6> row{b.t,         b.speed,     b.change,
                                    r.frequency, r.amplitude, r.at_equal_angles ? 1.0 : 0.0};
    ridges_[p]->append(row);
  }
}

void SpectraOutput::take(analysis::SpectrumBlock b) {
  // positive frequencies: with the spin of the shaft there
  for (std::size_t p = 0; p < b.full.size(); ++p) {
    if ((b.speed < 0 ? -1.0 : 1.0) * senses_[p] > 0) continue;
    std::reverse(b.full[p].begin(), b.full[p].end());
    if (!b.ordered.empty()) std::reverse(b.ordered[p].begin(), b.ordered[p].end());
    b.ridge[p].frequency *= -1;
  }
  write(b);
  if (blocks_++ % stride_ != 0) return;
  if (traces_.size() == static_cast<std::size_t>(options_.traces)) {
    for (std::size_t k = 1; 2 * k < traces_.size(); ++k)
      traces_[k] = std::move(traces_[2 * k]);
    traces_.resize((traces_.size() + 1) / 2);
    stride_ *= 2;
    if ((blocks_ - 1) % stride_ != 0) return;
  }
  const bool angles = !b.ordered.empty();
  traces_.push_back({b.t, b.speed, angles ? std::move(b.ordered) : std::move(b.full),
                     std::move(b.y), std::move(b.ridge), b.change, angles});
}

void SpectraOutput::save(OutArchive& out) {
  for (auto* list : {&sinks_, &ridges_})
    for (auto& s : *list)
      s->flush();
  out.put_count(sinks_.empty() ? 0 : sinks_.front()->rows());
  out.put_count(blocks_);
  out.put_count(stride_);
  out.put_count(traces_.size());
  for (const Trace& t : traces_) {
    out.put(t.t);
    out.put(t.speed);
    for (const auto& x : t.full)
      out.put(x);
    for (const auto& x : t.y)
      out.put(x);
    for (const analysis::Ridge& r : t.ridge)
      for (const double x : {r.frequency, r.amplitude, r.at_equal_angles ? 1.0 : 0.0})
        out.put(x);
    out.put(t.change);
    out.put(t.at_equal_angles ? 1.0 : 0.0);
  }
  spectra_.save(out);
}

void SpectraOutput::restore(InArchive& in) {
  const std::uint64_t rows = in.count();
  for (auto& s : sinks_)
    s->resume(channels(), rows);
  for (auto& s : ridges_)
    s->resume(ridge_channels(), rows);
  blocks_ = in.count();
  stride_ = in.count();
  traces_.resize(in.count());
  for (Trace& t : traces_) {
    t.t = in.number();
    t.speed = in.number();
    t.full.resize(probes_.size());
    t.y.resize(probes_.size());
    for (auto& x : t.full)
      x = in.numbers();
    for (auto& x : t.y)
      x = in.numbers();
    t.ridge.resize(probes_.size());
    for (analysis::Ridge& r : t.ridge) {
      r.frequency = in.number();
      r.amplitude = in.number();
      r.at_equal_angles = in.number() != 0;
    }
    t.change = in.number();
    t.at_equal_angles = in.number() != 0;
  }
  spectra_.restore(in);
}

std::string SpectraOutput::csv_name(const std::string& probe, const char* what) const {
  return fmt::format("{}_{}_{}.csv", step_, safe_name(probe), what);
}

/// What was done where the speed changes within blocks, in lines of the spectrum; empty: it does not.
std::string SpectraOutput::how_taken() const {
  double most = 0;
  std::size_t sharp = 0;
  for (const Trace& t : traces_) {
    most = std::max(most, std::abs(t.change) / resolution());
    sharp += t.at_equal_angles ? 1 : 0;
  }
  if (sharp == 0) return {};
  return fmt::format(
      " The speed changes by up to {:.2g} lines ({:.0f} rpm) within a block: {} of {} spectra are "
      "from samples at equal angles, their frequencies orders times the mean speed. Orders are "
      "sharp there, fixed frequencies are spread.",
      most, to_rpm(most * resolution()), sharp, traces_.size());
}

/// The strongest component of each block.
void SpectraOutput::add_ridge(plot::Figure& map, std::span<const Trace> traces,
                              std::size_t probe) const {
  plot::Series s;
  s.label = "ridge: strongest component";
  s.style.color = 1;  // seen on dark and bright parts of the map
  s.style.width = 0;
  s.style.marker = plot::Marker::circle;
  s.style.marker_size = 4.5;
  for (const Trace& t : traces) {
    if (!(t.ridge[probe].amplitude > 0)) continue;
    s.x.push_back(to_rpm(std::abs(t.speed)));
    s.y.push_back(to_hz(std::abs(t.ridge[probe].frequency)));
  }
  plot::Axes& a = map.axes.front();
  const plot::HeatMap& h = a.heat.front();
  a.x.min = h.x0;  // no wider than the map
  a.x.max = h.x1;
  a.y.min = h.y0;
  a.y.max = h.y1;
  a.series.push_back(std::move(s));
  map.caption =
      "Samples at equal times: fixed frequencies are sharp, orders smear where the speed changes "
      "within a block. Dots: the strongest component of y + iz in each block, from samples at "
      "equal angles where these show it higher.";
}

bool SpectraOutput::speed_varies() const {
  double low = infinity, high = -infinity;
  for (const Trace& t : traces_) {
    low = std::min(low, std::abs(t.speed));
    high = std::max(high, std::abs(t.speed));
  }
  return traces_.size() > 2 && high - low > 0.02 * high;
}

/// Parts of the run in which the speed rises or falls by more than a fifth of its range: what whirls
/// on the way up need not on the way down, and would lie on top of it.
std::vector<std::span<const SpectraOutput::Trace>> SpectraOutput::sweeps() const {
  const auto speed = [&](std::size_t k) { return std::abs(traces_[k].speed); };
  double low = infinity, high = -infinity;
  for (std::size_t k = 0; k < traces_.size(); ++k) {
    low = std::min(low, speed(k));
    high = std::max(high, speed(k));
  }
  const double turn = 0.2 * (high - low);
  std::vector<std::size_t> corners{0};
  int direction = 0;  // not known before the speed has changed by so much
  std::size_t lowest = 0, highest = 0;
  for (std::size_t k = 1; k < traces_.size(); ++k) {
    if (speed(k) < speed(lowest)) lowest = k;
    if (speed(k) > speed(highest)) highest = k;
    if (direction >= 0 && speed(k) < speed(highest) - turn) {
      if (direction > 0) corners.push_back(highest);
      direction = -1;
      lowest = k;
    } else if (direction <= 0 && speed(k) > speed(lowest) + turn) {
      if (direction < 0) corners.push_back(lowest);
      direction = 1;
      highest = k;
    }
  }
  corners.push_back(traces_.size() - 1);
  constexpr std::size_t most = 4;  // pictures; else all in one
  std::vector<std::span<const Trace>> parts;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k)
    parts.emplace_back(&traces_[corners[k]], corners[k + 1] - corners[k] + 1);
  const auto too_short = [](const std::span<const Trace>& part) { return part.size() < 3; };
  const bool apart = parts.size() <= most && std::none_of(parts.begin(), parts.end(), too_short);
  return apart ? parts : std::vector<std::span<const Trace>>{traces_};
}

/// "rising speed", with a number where there are several; empty where there is one sweep only.
std::string SpectraOutput::sweep_name(const std::vector<std::span<const Trace>>& parts,
                                      std::size_t which) {
  if (parts.size() < 2) return {};
  const auto rises = [&](std::size_t k) {
    return std::abs(parts[k].back().speed) > std::abs(parts[k].front().speed);
  };
  int number = 0, count = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (rises(k) != rises(which)) continue;
    ++count;
    if (k <= which) ++number;
  }
  const std::string name = rises(which) ? "rising speed" : "falling speed";
  return count > 1 ? fmt::format("{} {}", name, number) : name;
}

void SpectraOutput::add_against_speed(std::vector<plot::Figure>& figures,
                                      std::span<const Trace> traces, const std::string& sweep,
                                      std::size_t probe) const {
  const std::vector<double> orders{0.5, 1.0, 2.0};
  const std::string id = step_ + "_" + safe_name(probes_[probe]),
                    place = sweep.empty() ? "" : "_" + safe_name(sweep),
                    said = sweep.empty() ? "" : ", " + sweep;
  figures.push_back(plot::plot_waterfall(
      id + "_waterfall" + place, probes_[probe] + ": full spectra against speed (cascade)" + said,
      full_traces(traces, probe), "displacement y + iz", "m", convention_, orders));
  figures.back().caption += how_taken();
  figures.push_back(plot::plot_spectrogram(
      id + "_spectrogram" + place, probes_[probe] + ": spectra of y against speed, map" + said,
      traces_of_y(traces, probe), "displacement y", "m", convention_));
  add_ridge(figures.back(), traces, probe);
}

void SpectraOutput::report(TransientEnd& end) {
  if (!out_.report) return;
  io::ReportSection& section = end.section;
  if (traces_.empty()) {
    section.text += fmt::format(
        "\n\nThe run is shorter than one block of the spectra ({:.3g} s): none is shown.",
        spectra_.block_seconds());
    return;
  }
  for (std::size_t p = 0; p < probes_.size(); ++p) {
    section.figures.push_back(full_spectrum(p));
    if (speed_varies()) {
      const std::vector<std::span<const Trace>> parts = sweeps();
      for (std::size_t k = 0; k < parts.size(); ++k)
        add_against_speed(section.figures, parts[k], sweep_name(parts, k), p);
    }
    if (!out_.csv) continue;
    section.files.emplace_back("spectra of " + probes_[p], csv_name(probes_[p]));
    section.files.emplace_back("ridge of " + probes_[p], csv_name(probes_[p], "ridge"));
  }
}

const SpectraOutput::Trace& SpectraOutput::largest_block(std::size_t probe) const {
  const Trace* best = &traces_.front();
  double largest = 0.0;
  for (const Trace& t : traces_)
    if (const double m = *std::max_element(t.full[probe].begin(), t.full[probe].end());
        m > largest) {
      largest = m;
      best = &t;
    }
  return *best;
}

/// Of the largest of the blocks, forward and backward.
plot::Figure SpectraOutput::full_spectrum(std::size_t probe) const {
  const Trace& block = largest_block(probe);
  const std::vector<double>& amplitude = block.full[probe];
  const double largest = std::max(0.0, *std::max_element(amplitude.begin(), amplitude.end()));
  const plot::DisplayUnit unit = plot::length_unit(factor() * largest);
  plot::Figure f;
  f.name = step_ + "_" + safe_name(probes_[probe]) + "_full_spectrum";
  f.title = fmt::format("{}: full spectrum of the largest block, {:.0f} rpm, t = {:.4g} s",
                        probes_[probe], to_rpm(block.speed), block.t);
  f.caption =
      "Spectrum of y + iz: positive frequencies whirl with the spin of the shaft there, negative "
      "ones against it.";
  if (block.at_equal_angles)
    f.caption += fmt::format(
        " The speed changes by {:.0f} rpm within the block: samples at equal angles, frequencies "
        "are orders times the mean speed.",
        to_rpm(std::abs(block.change)));
  plot::Axes a;
  a.x = plot::Axis("frequency, backward < 0 < forward", "Hz");
  a.y = plot::Axis(std::string("amplitude, ") + plot::to_string(convention_), unit.name);
  a.y.include_zero = true;
  plot::Series s;
  s.style.width = 1.2;
  for (std::size_t k = 0; k < amplitude.size(); ++k) {
    s.x.push_back(to_hz((static_cast<double>(k) - options_.lines) * resolution()));
    s.y.push_back(unit.factor * factor() * amplitude[k]);
  }
  a.series.push_back(std::move(s));
  const double spin = to_hz(std::abs(block.speed));
  for (const double order : {-1.0, 1.0})
    if (std::abs(order * spin) <= to_hz(options_.max_frequency))
      a.rules.push_back(
          {true, order * spin, order > 0 ? "1X" : "-1X", {plot::ink, plot::Dash::dotted, 1.0}});
  f.axes.push_back(std::move(a));
  return f;
}

std::vector<plot::SpectrumTrace> SpectraOutput::full_traces(std::span<const Trace> of,
                                                            std::size_t probe) const {
  std::vector<plot::SpectrumTrace> traces;
  for (const Trace& t : of) {
    plot::SpectrumTrace x;
    x.speed = std::abs(t.speed);
    for (std::size_t k = 0; k < t.full[probe].size(); ++k) {
      x.frequency.push_back((static_cast<double>(k) - options_.lines) * resolution());
      x.amplitude.push_back(factor() * t.full[probe][k]);
    }
    traces.push_back(std::move(x));
  }
  return traces;
}

std::vector<plot::SpectrumTrace> SpectraOutput::traces_of_y(std::span<const Trace> of,
                                                            std::size_t probe) const {
  std::vector<plot::SpectrumTrace> traces;
  for (const Trace& t : of) {
    plot::SpectrumTrace x;
    x.speed = std::abs(t.speed);
    for (std::size_t k = 0; k < t.y[probe].size(); ++k) {
      x.frequency.push_back(static_cast<double>(k) * resolution());
      x.amplitude.push_back(factor() * t.y[probe][k]);
    }
    traces.push_back(std::move(x));
  }
  return traces;
}

}  // namespace

void add_spectra(const TransientSetup& setup, TransientOutputs& outputs) {
  const model::Output& o = setup.job.model.output;
  if (o.spectra && !setup.job.model.probes.empty() && (o.csv || o.report))
    outputs.push_back(std::make_unique<SpectraOutput>(setup));
}

}  // namespace whirl::results
