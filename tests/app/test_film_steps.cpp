// Time steps that are linearised once inside: with films alone, not where a stiffness may come and
// go within a step.
#include <deck/deck.hpp>
#include <run/job.hpp>
#include <steps/transient_step.hpp>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

namespace fs = std::filesystem;
using namespace whirl;

namespace {

/// Whether the run-up of the oil-whirl rotor, with one more bearing at its thrust bearing, is
/// linearised inside its steps.
bool linearized_inside(const model::BearingLaw* extra) {
  model::Model m = deck::load_model(fs::path(WHIRL_SOURCE) / "examples/20_oil_whirl/deck.toml", {});
  if (extra) {
    model::Bearing b;
    b.name = "extra";
    b.at = m.bearings.back().at;
    b.law = *extra;
    m.bearings.push_back(b);
  }
  const fs::path folder =
      fs::temp_directory_path() / ("whirl_film_steps_" + std::to_string(::getpid()));
  run::RunOptions o;
  o.quiet = true;
  bool out = false;
  {
    run::Job job(m, o, folder);
    const auto& law = std::get<model::TransientStep>(m.steps.back().law);
    job.build_for(m.steps.back());
    out = steps::transient_options(job, law, 0.0).integrator.linearize_inside;
  }
  fs::remove_all(folder);
  return out;
}

}  // namespace

TEST(FilmSteps, LinearisedInsideWithFilmsAlone) { EXPECT_TRUE(linearized_inside(nullptr)); }

// A clearance whose stiffness sets in smoothly has no corner that would say so by itself.
TEST(FilmSteps, NotBesideAGapWithASmoothEdge) {
  model::NonlinearSpring stop;
  stop.along = model::NonlinearSpring::Along::radial;
  stop.force.shape = model::ForceLaw::Shape::clearance;
  stop.force.gap_minus = stop.force.gap_plus = 5e-5;
  stop.force.stiffness = 1e7;
  stop.force.smooth = 1e-5;
  const model::BearingLaw law = stop;
  EXPECT_FALSE(linearized_inside(&law));
  model::NonlinearSpring duffing;
  duffing.along = model::NonlinearSpring::Along::radial;
  duffing.force.coefficients = {0, 1e5, 0, 1e12};
  const model::BearingLaw smooth = duffing;
  EXPECT_TRUE(linearized_inside(&smooth));
}
