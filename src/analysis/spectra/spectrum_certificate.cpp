#include <analysis/spectra/spectrum_certificate.hpp>

#include <core/units.hpp>

#include <fmt/format.h>

namespace whirl::analysis {

namespace {

std::string text_of(const SpectrumCertificate::Axis& a) {
  if (!a.counted)
    return "growing roots not certified: their count did not settle, or growth above the tables is "
           "not excluded";
  std::string out =
      a.unknown == 0 ? std::string("all growing roots counted (along the imaginary axis) and found")
      : a.unknown > 0 ? fmt::format("INCOMPLETE: {} growing roots more than found", a.unknown)
                      : fmt::format(
                            "IN DOUBT: {} growing roots fewer than found (supports that "
                            "grow by themselves where the rotor is held still, or tables "
                            "too coarse for their resonances)",
                            -a.unknown);
  if (!a.held_beyond)
    out += fmt::format(", with the ends of the tables held beyond them ({:.5g} Hz)", to_hz(a.top));
  return out;
}

}  // namespace

void SpectrumCertificate::take(const OwnFrequency::Known& k) {
  list.counted = k.counted;
  list.missing = k.missing;
  list.radius = k.top;
  list.reach = k.reach * k.top;
  list.where = k.where;
  list.factorizations = k.factorizations;
  list.recovered = k.recovered;
  by_frequency = ByFrequency{k.low, static_cast<Index>(k.rising.size())};
}

std::string SpectrumCertificate::text() const {
  if (axis && !open.empty()) return text_of(*axis) + "; completeness not certified: " + open;
  if (axis) return text_of(*axis) + "; " + text_of_list();
  return text_of_list();
}

std::string SpectrumCertificate::text_of_list() const {
  if (!open.empty()) return "completeness not certified: " + open;
  const double top = to_hz(list.radius);
  if (!list.counted && top == 0)
    return "completeness not certified: no frequency was found up to which roots could be counted "
           "(a "
           "model without mass has none)";
  if (!list.counted)
    return fmt::format("completeness not certified: the roots up to {:.5g} Hz could not be counted",
                       top);
  std::string band =
      cut() ? fmt::format("all roots up to {:.5g} Hz that decay no faster than {:.3g} 1/s", top,
                          list.reach)
            : fmt::format("all roots up to {:.5g} Hz and damping ratio {:.2g}", top,
                          list.damping_ratio());
  if (by_frequency)
    band = fmt::format("all modes from {:.3g} to {:.5g} Hz and up to damping ratio {:.2g}",
                       to_hz(by_frequency->low), top, list.damping_ratio());
  if (list.missing == 0 && list.taken_for_zero > 0)
    return band + fmt::format(
                      " counted and found; {} of them, within {:.2g} 1/s of zero, cannot be told "
                      "from zero and {} taken for free motion",
                      list.taken_for_zero, list.zeros_within,
                      list.taken_for_zero == 1 ? "is" : "are");
  const std::string pairs =
      by_frequency && axis
          ? " (but pairs in which one branch of frequencies rises through the line along "
            "which tables are read, as no support does that loses nothing)" +
                (by_frequency->rising > 0
                     ? fmt::format("; {} such rising roots are left out of the list",
                                   by_frequency->rising)
                     : std::string())
          : std::string();
  if (list.missing == 0) return band + " counted and found" + pairs;
  std::string out =
      list.missing > 0 ? fmt::format("INCOMPLETE: {} of {} not found", list.missing, band)
                       : fmt::format("IN DOUBT: {} more than the count of {}", -list.missing, band);
  for (const Complex z : list.where)
    out += fmt::format("; one near {:.4g} Hz, rate {:.3g} 1/s", to_hz(z.imag()), z.real());
  return out;
}

}  // namespace whirl::analysis
