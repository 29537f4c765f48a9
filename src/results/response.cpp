#include <results/response.hpp>

#include <fmt/format.h>

namespace whirl::results {

std::vector<analysis::ResponseProbe> response_probes(const run::Job& job) {
  std::vector<analysis::ResponseProbe> out;
  for (const model::Probe& p : job.model.probes)
    out.push_back({p.name, point_of(job, p.at), p.angles});
  if (out.empty())
    for (const model::Disk& d : job.model.disks)
      out.push_back({"disk " + d.name, point_of(job, d.at), {}});
  return out;
}

ProbeCurves curves_of(const analysis::ResponseProbe& probe,
                      const std::vector<analysis::PointAmplitude>& amplitudes) {
  ProbeCurves c;
  if (probe.angles.empty()) {
    c.label = {"y", "z"};
    c.amplitude.resize(2);
    for (const analysis::PointAmplitude& a : amplitudes) {
      c.amplitude[0].push_back(a.y);
      c.amplitude[1].push_back(a.z);
    }
    return c;
  }
  for (const double angle : probe.angles) {
    c.label.push_back(fmt::format("{:g}°", angle * 180 / pi));
    std::vector<Complex> x;
    x.reserve(amplitudes.size());
    for (const analysis::PointAmplitude& a : amplitudes)
      x.push_back(a.along(angle));
    c.amplitude.push_back(std::move(x));
  }
  return c;
}

std::vector<plot::ResponseCurve> response_curves(const std::vector<double>& axis,
                                                 const ProbeCurves& curves,
                                                 const std::string& suffix) {
  std::vector<plot::ResponseCurve> out;
  for (std::size_t i = 0; i < curves.label.size(); ++i) {
    plot::ResponseCurve curve{curves.label[i] + suffix, axis, {}, {}};
    for (const Complex a : curves.amplitude[i]) {
      curve.amplitude.push_back(std::abs(a));
      curve.phase_lag.push_back(lag(a));
    }
    out.push_back(std::move(curve));
  }
  return out;
}

void add_probe_columns(io::Table& t, const analysis::ResponseProbe& probe) {
  const std::string& name = probe.name;
  t.columns.push_back({name + " y amplitude", "m", "0-peak"});
  t.columns.push_back({name + " y phase lag", "deg", "behind the rotor mark"});
  t.columns.push_back({name + " z amplitude", "m", "0-peak"});
  t.columns.push_back({name + " z phase lag", "deg", ""});
  for (const double angle : probe.angles) {
    const std::string direction = fmt::format("{} {:g}deg", name, angle * 180 / pi);
    t.columns.push_back({direction + " amplitude", "m", "0-peak"});
    t.columns.push_back({direction + " phase lag", "deg", ""});
  }
  t.columns.push_back({name + " major", "m", "half axis of the orbit"});
  t.columns.push_back({name + " minor", "m", "negative: the orbit is run against the spin"});
}

void add_probe_cells(std::vector<io::Table::Cell>& row, const analysis::ResponseProbe& probe,
                     const analysis::PointAmplitude& a) {
  const analysis::Orbit o = a.orbit();
  row.emplace_back(std::abs(a.y));
  row.emplace_back(lag(a.y) * 180 / pi);
  row.emplace_back(std::abs(a.z));
  row.emplace_back(lag(a.z) * 180 / pi);
  for (const double angle : probe.angles) {
    const Complex along = a.along(angle);
    row.emplace_back(std::abs(along));
    row.emplace_back(lag(along) * 180 / pi);
  }
  row.emplace_back(o.major);
  row.emplace_back(o.minor);
}

}  // namespace whirl::results
