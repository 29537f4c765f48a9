#include <steps/vibration_zones.hpp>

#include <analysis/response/balancing.hpp>
#include <meshes/mass_properties.hpp>
#include <results/response.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace whirl::steps {

using analysis::SteadyPoint;
using analysis::UnbalanceResponse;

namespace {

/// Borders of the zones of a shaft at a reference speed, m peak to peak. ratio: of its own speed.
std::vector<double> borders_at(const model::VibrationZones& z, double Omega, double ratio) {
  if (!z.limits.empty()) return z.limits;
  std::vector<double> out;
  for (const double c : z.constants)
    out.push_back(1e-6 * c / std::sqrt(to_rpm(std::abs(ratio * Omega))));
  return out;
}

/// Of the shaft of a probe; 1 where that stands.
double ratio_at(results::FrequencyStep& s, const analysis::ResponseProbe& p) {
  const double ratio = s.linear.running().ratio(s.linear.system().node(p.point.node).line);
  return ratio == 0 ? 1.0 : ratio;
}

/// Borders over the operating speeds, in the unit of an axis of amplitudes.
class Borders {
 public:
  Borders(const model::VibrationZones& zones, double ratio, double factor)
      : zones_(zones),
        ratio_(ratio),
        factor_(factor) {}
  double at(double Omega, std::size_t k) const {
    return factor_ * borders_at(zones_, Omega, ratio_)[k];
  }

 private:
  const model::VibrationZones& zones_;
  double ratio_, factor_;
};

constexpr std::size_t zone_count = 4;

/// The axis shows the zone that the response reaches whole, if it is not the last.
void set_limits(plot::Axes& a, const UnbalanceResponse& r, const Borders& borders,
                double first_speed) {
  double top = 0;
  for (const plot::Series& line : a.series)
    for (const double y : line.y)
      top = std::isfinite(y) ? std::max(top, y) : top;
  for (std::size_t k = 0; k + 1 < zone_count; ++k)
    if (const double b = borders.at(first_speed, k); b >= top) {
      top = b;
      break;
    }
  a.y.min = 0;
  a.y.max = 1.12 * top;
  const auto [low, high] = std::minmax_element(
      r.points.begin(), r.points.end(),
      [](const SteadyPoint& p, const SteadyPoint& q) { return p.Omega < q.Omega; });
  a.x.min = to_rpm(low->Omega);
  a.x.max = to_rpm(high->Omega);
}

/// Green, yellow, orange, red.
void add_patches(plot::Axes& a, const Borders& borders, const std::vector<double>& speeds,
                 const std::string& source) {
  constexpr std::array<int, zone_count> colors{2, 4, 1, 6};
  for (std::size_t k = 0; k < zone_count; ++k) {
    plot::Patch zone;
    zone.label = fmt::format("zone {}", static_cast<char>('A' + k));
    zone.tooltip = zone.label + " after " + source;
    zone.style = {colors[k], plot::Dash::solid, 0.0};
    zone.fill_opacity = 0.16;
    const auto add = [&](double Omega, double y) {
      zone.x.push_back(to_rpm(Omega));
      zone.y.push_back(std::min(y, a.y.max));
    };
    for (const double Omega : speeds)
      add(Omega, k == 0 ? 0.0 : borders.at(Omega, k - 1));
    if (zone.y.front() >= a.y.max && zone.y.back() >= a.y.max) break;
    for (auto Omega = speeds.rbegin(); Omega != speeds.rend(); ++Omega)
      add(*Omega, k + 1 == zone_count ? infinity : borders.at(*Omega, k));
    a.patches.push_back(std::move(zone));
  }
}

/// In the figures of the probes.
void color_zones(results::FrequencyStep& s, const UnbalanceResponse& r,
                 const std::vector<analysis::ResponseProbe>& probes,
                 const model::UnbalanceStep& law) {
  const double factor = s.job.model.output.peak_to_peak ? 1.0 : 0.5;
  std::vector<double> speeds;
  for (const SteadyPoint& x : r.points)
    if (x.Omega >= law.operating[0] && x.Omega <= law.operating[1]) speeds.push_back(x.Omega);
  if (speeds.size() < 2) return;
  for (plot::Figure& f : s.section.figures) {
    const auto probe = std::find_if(probes.begin(), probes.end(), [&](const auto& p) {
      return f.name == s.file(p.name + "_bode");
    });
    if (probe == probes.end()) continue;
    plot::Axes& a = f.axes.front();
    const double unit = a.y.unit == "m" ? 1 : a.y.unit == "mm" ? 1e3 : a.y.unit == "nm" ? 1e9 : 1e6;
    const Borders borders(*law.zones, ratio_at(s, *probe), unit * factor);
    set_limits(a, r, borders, speeds.front());
    add_patches(a, borders, speeds, law.zones->source);
  }
}

bool is_within(double Omega, const std::array<double, 2>& speeds) {
  constexpr double rounding = 1e-12;
  const double turns = std::abs(Omega);
  return turns >= speeds[0] * (1 - rounding) && turns <= speeds[1] * (1 + rounding);
}

}  // namespace

double peak_to_peak(const SteadyPoint& x, std::size_t probe) {
  double amplitude = 0;
  for (const auto& order : x.probe)
    amplitude += order[probe].orbit().major;
  for (std::size_t h = 2; h < x.multiple.size(); ++h)
    amplitude += x.multiple[h][probe].orbit().major;
  return 2 * amplitude;
}

void add_zones(results::FrequencyStep& s, const UnbalanceResponse& r,
               const std::vector<analysis::ResponseProbe>& probes,
               const std::vector<analysis::ResponsePeak>& peaks, const model::UnbalanceStep& law) {
  if (!law.zones) return;
  io::Table t;
  t.title = "Vibration zones after " + law.zones->source;
  t.nan_means = "without bound";
  t.columns = {{"probe", "-", ""},
               {"speed", "rpm", "of the operating speeds, where it comes nearest to the borders"},
               {"amplitude peak to peak", "um", "major axis"},
               {"A/B", "um", "border of the zones, at the speed of the probe's own shaft"},
               {"B/C", "um", ""},
               {"C/D", "um", ""},
               {"zone", "-", ""}};
  for (std::size_t p = 0; p < probes.size(); ++p) {
    double nearest = -1, speed = 0, largest = 0;
    const double ratio = ratio_at(s, probes[p]);
    for (const SteadyPoint& x : r.points) {
      if (!is_within(x.Omega, law.operating)) continue;
      const double pp = peak_to_peak(x, p);
      const double share = pp / borders_at(*law.zones, x.Omega, ratio).front();
      if (share <= nearest) continue;
      nearest = share;
      speed = x.Omega;
      largest = pp;
    }
    const auto endless = std::find_if(peaks.begin(), peaks.end(), [&](const auto& peak) {
      return peak.probe == p && !peak.bounded && is_within(peak.speed, law.operating);
    });
    if (endless != peaks.end()) {
      speed = endless->speed;
      largest = infinity;
    } else if (nearest < 0) {
      continue;
    }
    const std::vector<double> b = borders_at(*law.zones, speed, ratio);
    const std::string zone(1, static_cast<char>('A' + analysis::zone_of(largest, b)));
    io::Table::Cell cell = zone;
    using Mark = io::Table::Cell::Mark;
    cell.mark = zone == "A" || zone == "B" ? Mark::passed : Mark::failed;
    t.add({probes[p].name, to_rpm(speed), std::isfinite(largest) ? 1e6 * largest : nan, 1e6 * b[0],
           1e6 * b[1], 1e6 * b[2], std::move(cell)});
    s.summary()["zones"][probes[p].name] = zone;
  }
  s.add_table("zones", std::move(t));
  color_zones(s, r, probes, law);
}

namespace {

/// Sum over the places on a shaft of what unbalances, as they are at time 0, and disks off their axis
/// amount to there, kg m.
double unbalance_of(const model::Model& m, std::size_t shaft) {
  const double near = 1e-9 * m.shafts[shaft].length();
  struct Place {
    double from, to;
    Vec2 amount;
  };
  std::vector<Place> places;
  const auto add = [&](double from, double to, const Vec2& amount) {
    const auto there = std::find_if(places.begin(), places.end(), [&](const Place& p) {
      return std::abs(p.from - from) <= near && std::abs(p.to - to) <= near;
    });
    if (there == places.end())
      places.push_back({from, to, amount});
    else
      there->amount += amount;
  };
  for (const model::Unbalance& u : m.unbalances) {
    if (u.at.shaft != shaft) continue;
    const double amount = u.amount * (u.factor ? u.factor->at(0.0).f : 1.0);
    add(u.at.s, u.to ? u.to->s : u.at.s, amount * Vec2(std::cos(u.phase), std::sin(u.phase)));
  }
  for (const model::Disk& d : m.disks)
    if (d.at.shaft == shaft) add(d.at.s, d.at.s, d.mass * d.offset.tail<2>());
  double sum = 0.0;
  for (const Place& p : places)
    sum += p.amount.norm();
  return sum;
}

}  // namespace

void add_grades(results::FrequencyStep& s, const model::UnbalanceStep& law) {
  if (!(law.balance_grade > 0)) return;
  const model::Model& m = s.job.model;
  io::Table t;
  t.title = "Balance grade after ISO 21940-11";
  t.columns = {{"shaft", "-", ""},
               {"mass", "kg", ""},
               {"unbalance", "g mm",
                "sum over the places of the resultants there, disks off the axis included"},
               {"permissible", "g mm", "of the grade, at the highest operating speed"},
               {"grade", "mm/s", "of the unbalances"},
               {"result", "-", ""}};
  for (std::size_t k = 0; k < m.shafts.size(); ++k) {
    const double speed = std::abs(m.shafts[k].speed_ratio) * law.operating[1];
    if (!m.shafts[k].rotating || speed == 0) continue;
    const double mass = meshes::shaft_mass(m, k).mass;
    const double sum = unbalance_of(m, k);
    const double grade = mass > 0 ? sum * speed / mass : 0.0;
    io::Table::Cell result = grade <= law.balance_grade * (1 + 1e-12) ? "passed" : "FAILED";
    result.mark =
        result.text == "passed" ? io::Table::Cell::Mark::passed : io::Table::Cell::Mark::failed;
    t.add({m.shafts[k].name, mass, 1e6 * sum, 1e6 * law.balance_grade * mass / speed, 1e3 * grade,
           std::move(result)});
  }
  s.add_table("balance_grade", std::move(t));
}

}  // namespace whirl::steps
