// What a list of modes says of a machine, against all eigenvalues of the same matrices by a dense
// method.
#pragma once
#include "../la/dense_spectrum.hpp"
#include "../validation/deck_model.hpp"

#include <analysis/spectra/whirl_modes.hpp>
#include <core/error.hpp>
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace whirl::tests {

using namespace analysis;
using test::DeckModel;
using test::rpm;

inline std::vector<Complex> all_roots(const la::MCK& m, std::span<const unsigned char> active,
                                      double scale) {
  return la::test::dense_spectrum(m, la::test::Mask(active.begin(), active.end()), scale);
}

struct Tally {
  int machines = 0, solved = 0, without_equilibrium = 0, certified = 0, certain = 0, unstable = 0,
      diverging = 0, recovered = 0, unresolved = 0;
};

/// One machine at one speed: what the list says against all roots. strict: all lists are certified,
/// and whatever is said to grow does by the dense method.
inline void check_machine(const DeckModel& d, double Omega, Index count, const std::string& name,
                          Tally& tally, bool strict) {
  Linearizer linear(d.built.system, d.running());
  ModesOptions o;
  o.count = count;
  o.real_roots = true;
  o.judge = true;
  SpectrumCertificate certificate;
  std::vector<WhirlMode> modes;
  try {
    modes = whirl_modes(linear, Omega, o, &certificate);
  } catch (const Error& e) {
    const std::string code = e.diagnostics().front().code;
    ASSERT_TRUE(code == "E75" || code == "E76")
        << name << ": " << e.what();  // no equilibrium: not this check's matter
    ++tally.without_equilibrium;
    return;
  }
  ++tally.solved;
  tally.certified += certificate.complete();
  tally.certain += certificate.stability_certain();
  tally.recovered += certificate.list.recovered > 0;
  if (!certificate.complete())
    std::printf("%s at %g rpm: %s\n", name.c_str(), Omega / rpm, certificate.text().c_str());
  EXPECT_TRUE(certificate.complete() || !strict) << name << ": " << certificate.text();
  std::vector<Complex> all =
      all_roots(linear.at(Omega), linear.active(), 0.37 * certificate.list.radius);
  // of parts without mass: infinite but for rounding
  std::erase_if(all, [&](Complex s) { return std::abs(s) > 1e7 * certificate.list.radius; });
  double largest = 0;
  for (const Complex s : all)
    largest = std::max(largest, std::abs(s));
  const double rounding = 1e-13 * largest;  // what the dense method leaves of a simple root
  // A free motion is a double root: the dense method leaves the square root of its rounding,
  // relative to its shift.
  const double zero = 1e-6 * certificate.list.radius;
  // What grows is listed whatever its number: the list proper ends at the mode asked for.
  double last = 0;
  Index number = 0;
  for (const WhirlMode& m : modes)
    if (m.oscillates() && ++number <= count) last = m.frequency;
  const la::CountRegion region{certificate.list.radius, certificate.list.reach};
  bool grows = false;
  for (const Complex s : all) {
    if (s.imag() < 0) continue;
    const double near = 1e-6 * std::abs(s) + 1e4 * rounding;
    grows = grows || s.real() > std::max(near, zero);
    const bool oscillates = s.imag() > near;
    const bool inside = region.contains(s * (1 + 1e-9));
    const bool wanted = inside && ((oscillates && s.imag() < last * (1 - 1e-6)) || s.real() > near);
    if (!wanted || std::abs(s) < near || std::abs(s) < zero) continue;
    const bool listed = std::any_of(modes.begin(), modes.end(), [&](const WhirlMode& m) {
      return std::abs(m.lambda - s) < near;
    });
    EXPECT_TRUE(listed) << name << " at " << Omega / rpm << " rpm: " << s.real() << " " << s.imag()
                        << " i is not in the list; " << certificate.text();
  }
  Index oscillating = 0;
  bool said = false;
  for (const WhirlMode& m : modes) {
    if (m.oscillates()) ++oscillating;
    // In the long campaign what grows more slowly than the dense method can tell is not judged by
    // it: films drive an axial mode that has no damping of its own by 1e-10 of its frequency.
    const double resolved =
        strict ? 0.0 : std::max(1e-6 * std::abs(m.lambda) + 1e4 * rounding, zero);
    const bool grows_here = m.growth() > 0;
    said = said || (grows_here && m.lambda.real() > resolved);
    tally.unresolved += grows_here && m.lambda.real() <= resolved;
    tally.diverging += !m.oscillates() && m.growth() > 0;
    if (std::abs(m.lambda) < std::max(zero, 1e4 * rounding)) continue;
    const bool real = std::any_of(all.begin(), all.end(), [&](Complex s) {
      return std::abs(s - m.lambda) < 1e-5 * std::abs(s) + 1e5 * rounding;
    });
    EXPECT_TRUE(real) << name << ": " << m.lambda << " is no root";
  }
  EXPECT_GE(oscillating, count) << name;
  tally.unstable += said;
  if (!certificate.stability_certain()) return;
  EXPECT_EQ(said, grows) << name << " at " << Omega / rpm << " rpm";
}

inline void report(const Tally& t) {
  std::printf(
      "%d machines, %d spectra (%d without equilibrium), %d certified, %d certain at all "
      "frequencies, %d unstable, %d divergences, %d recovered by the count, %d growths below what "
      "the dense method tells\n",
      t.machines, t.solved, t.without_equilibrium, t.certified, t.certain, t.unstable, t.diverging,
      t.recovered, t.unresolved);
}

}  // namespace whirl::tests
