#include <results/spectra_output.hpp>

#include <plot/plots.hpp>
#include <core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

namespace {

std::vector<analysis::Point> points_of(const run::Job& job) {
  std::vector<analysis::Point> p;
  for (const model::Probe& probe : job.model.probes) {
    const meshes::Place at = job.mesh.place(probe.at);
    p.push_back({at.node, at.offset});
  }
  return p;
}

}  // namespace

SpectraOutput::SpectraOutput(const run::Job& job, const model::Step& step, double t_begin,
                             std::vector<double> senses)
    : out_(job.model.output),
      options_(*job.model.output.spectra),
      step_(step.name),
      senses_(std::move(senses)),
      spectra_(points_of(job), job.reference(), t_begin, {options_.max_frequency, options_.lines},
               [this](const analysis::SpectrumBlock& b) { take(b); }) {
  content_ = fmt::format("{} {} {}", options_.max_frequency, options_.lines, options_.traces);
  for (const model::Probe& p : job.model.probes) {
    probes_.push_back(p.name);
    content_ += " " + p.name;
    if (out_.csv)
      sinks_.push_back(io::make_csv_series(
          job.folder.path(fmt::format("{}_{}_spectra.csv", step_, safe_name(p.name)))));
  }
  row_.resize(2 + 2 * static_cast<std::size_t>(options_.lines) + 1);
}

std::vector<io::Channel> SpectraOutput::channels() const {
  std::vector<io::Channel> c{{"t", "s", "middle of the block", {}, 1.0, {}},
                             {"speed", "rpm", "mean spin of the block", {}, 30.0 / pi, {}}};
  for (int k = -options_.lines; k <= options_.lines; ++k)
    c.push_back({fmt::format("{:.6g} Hz", k * options_.max_frequency / options_.lines / two_pi),
                 "m",
                 "amplitude of y + iz, 0-peak; negative: against the spin",
                 {},
                 1.0,
                 {}});
  return c;
}

void SpectraOutput::begin() {
  for (auto& s : sinks_)
    s->begin(channels());
}

void SpectraOutput::close() {
  for (auto& s : sinks_)
    s->close();
}

void SpectraOutput::take(analysis::SpectrumBlock b) {
  // positive frequencies: with the spin of the shaft there
  for (std::size_t p = 0; p < b.full.size(); ++p)
    if ((b.speed < 0 ? -1.0 : 1.0) * senses_[p] < 0)
      std::reverse(b.full[p].begin(), b.full[p].end());
  for (std::size_t p = 0; p < sinks_.size(); ++p) {
    row_[0] = b.t;
    row_[1] = b.speed;
    std::copy(b.full[p].begin(), b.full[p].end(), row_.begin() + 2);
    sinks_[p]->append(row_);
  }
  if (blocks_++ % stride_ != 0) return;
  if (traces_.size() == static_cast<std::size_t>(options_.traces)) {
    for (std::size_t k = 1; 2 * k < traces_.size(); ++k)
      traces_[k] = std::move(traces_[2 * k]);
    traces_.resize((traces_.size() + 1) / 2);
    stride_ *= 2;
    if ((blocks_ - 1) % stride_ != 0) return;
  }
  traces_.push_back({b.t, b.speed, b.full, b.y});
}

void SpectraOutput::save(OutArchive& out) {
  for (auto& s : sinks_)
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
  }
  spectra_.save(out);
}

void SpectraOutput::restore(InArchive& in) {
  const std::uint64_t rows = in.count();
  for (auto& s : sinks_)
    s->resume(channels(), rows);
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
  }
  spectra_.restore(in);
}

void SpectraOutput::report(io::ReportSection& section) const {
  if (traces_.empty()) {
    section.text += fmt::format(
        "\n\nThe run is shorter than one block of the spectra ({:.3g} s): none is shown.",
        spectra_.block_seconds());
    return;
  }
  const auto convention =
      out_.peak_to_peak ? plot::Amplitude::peak_to_peak : plot::Amplitude::zero_to_peak;
  const double factor = out_.peak_to_peak ? 2.0 : 1.0,
               resolution = options_.max_frequency / options_.lines;
  double low = infinity, high = -infinity;
  for (const Trace& t : traces_) {
    low = std::min(low, std::abs(t.speed));
    high = std::max(high, std::abs(t.speed));
  }
  const bool varies = traces_.size() > 2 && high - low > 0.02 * high;
  const std::vector<double> orders{0.5, 1.0, 2.0};
  for (std::size_t p = 0; p < probes_.size(); ++p) {
    const std::string id = step_ + "_" + safe_name(probes_[p]);
    // the largest of the blocks, forward and backward
    std::size_t best = 0;
    double largest = 0.0;
    for (std::size_t k = 0; k < traces_.size(); ++k)
      if (const double m = *std::max_element(traces_[k].full[p].begin(), traces_[k].full[p].end());
          m > largest) {
        largest = m;
        best = k;
      }
    const plot::DisplayUnit unit = plot::length_unit(factor * largest);
    plot::Figure f;
    f.name = id + "_full_spectrum";
    f.title = fmt::format("{}: full spectrum of the largest block, {:.0f} rpm, t = {:.4g} s",
                          probes_[p], traces_[best].speed * 30.0 / pi, traces_[best].t);
    f.caption =
        "Spectrum of y + iz: positive frequencies whirl with the spin of the shaft there, negative "
        "ones against it.";
    plot::Axes a;
    a.x = plot::Axis("frequency, backward < 0 < forward", "Hz");
    a.y = plot::Axis(std::string("amplitude, ") + plot::to_string(convention), unit.name);
    a.y.include_zero = true;
    plot::Series s;
    s.style.width = 1.2;
    for (std::size_t k = 0; k < traces_[best].full[p].size(); ++k) {
      s.x.push_back((static_cast<double>(k) - options_.lines) * resolution / two_pi);
      s.y.push_back(unit.factor * factor * traces_[best].full[p][k]);
    }
    a.series.push_back(std::move(s));
    const double spin = std::abs(traces_[best].speed) / two_pi;
    for (const double k : {-1.0, 1.0})
      if (std::abs(k * spin) <= options_.max_frequency / two_pi)
        a.rules.push_back(
            {true, k * spin, k > 0 ? "1X" : "-1X", {plot::ink, plot::Dash::dotted, 1.0}});
    f.axes.push_back(std::move(a));
    section.figures.push_back(std::move(f));

    std::vector<plot::SpectrumTrace> traces;
    for (const Trace& t : traces_) {
      plot::SpectrumTrace x;
      x.speed = varies ? std::abs(t.speed) : t.t;
      for (std::size_t k = 0; k < t.y[p].size(); ++k) {
        x.frequency.push_back(static_cast<double>(k) * resolution);
        x.amplitude.push_back(factor * t.y[p][k]);
      }
      traces.push_back(std::move(x));
    }
    if (varies) {
      section.figures.push_back(
          plot::plot_waterfall(id + "_waterfall", probes_[p] + ": spectra of y against speed",
                               traces, "displacement y", "m", convention, orders));
      section.figures.push_back(plot::plot_spectrogram(
          id + "_spectrogram", probes_[p] + ": spectra of y against speed, map", traces,
          "displacement y", "m", convention));
    }
    if (out_.csv)
      section.files.emplace_back("spectra of " + probes_[p],
                                 fmt::format("{}_{}_spectra.csv", step_, safe_name(probes_[p])));
  }
}

}  // namespace whirl::results
