// linear = true in a deck: what the summary says of it, and the same motion as the general run.
#include "../io/read_json.hpp"

#include <run/options.hpp>
#include <steps/run_deck.hpp>
#include <core/error.hpp>
#include <deck/deck.hpp>
#include <gtest/gtest.h>
#include <io/value.hpp>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace fs = std::filesystem;
using namespace whirl;

namespace {

io::Value run_loss(const fs::path& folder, bool linear, double scale) {
  model::Model m =
      deck::load_model(fs::path(WHIRL_SOURCE) / "examples/12_blade_loss/deck.toml", {});
  for (model::Unbalance& u : m.unbalances)
    u.amount *= scale;
  auto& t = std::get<model::TransientStep>(m.steps.front().law);
  t.linear = linear;
  t.integrator.tolerance = 1e-6;
  t.checkpoint = 0;
  m.output.report = false;
  m.output.csv = false;
  m.output.spectra.reset();
  m.output.vtk.clear();
  run::RunOptions o;
  o.quiet = true;
  o.output = folder;
  EXPECT_EQ(steps::run_deck(m, o), 0);
  return tests::read_json(folder / "summary.json").at("steps").at("loss");
}

}  // namespace

TEST(LinearStep, BladeLossInTheSummary) {
  const fs::path folder =
      fs::temp_directory_path() / ("whirl_linear_" + std::to_string(::getpid()));
  const io::Value general = run_loss(folder / "general", false, 0.1),
                  linear = run_loss(folder / "linear", true, 0.1);
  EXPECT_TRUE(general.at("equations").is_null());
  ASSERT_FALSE(linear.at("equations").is_null());
  const io::Value& i = linear.at("integrator");
  const double attempts = i.at("steps").number() + i.at("rejected by error").number();
  EXPECT_EQ(i.at("Newton iterations").number(), attempts);
  // a factorisation serves all steps of one length
  EXPECT_LT(i.at("factorisations complex").number(), attempts / 5);
  EXPECT_LT(i.at("Newton iterations").number(),
            general.at("integrator").at("Newton iterations").number());
  // peaks: 1e-6 each by accuracy, and second-order terms of a motion of 20 um
  for (const auto& [name, peak] : general.at("peaks").members()) {
    const double amplitude = peak.at("amplitude 0-peak [m]").number();
    EXPECT_NEAR(linear.at("peaks").at(name).at("amplitude 0-peak [m]").number(), amplitude,
                1e-5 * amplitude)
        << name;
  }
  fs::remove_all(folder);
}

TEST(LinearStep, ContradictionsAreSaid) {
  const fs::path file =
      fs::temp_directory_path() / ("whirl_linear_" + std::to_string(::getpid()) + ".toml");
  std::ifstream in(fs::path(WHIRL_SOURCE) / "examples/09_jeffcott_run_up/deck.toml");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::string key = "type       = \"transient\"";
  ASSERT_NE(text.find(key), std::string::npos);
  text.insert(text.find(key) + key.size(), "\nlinear = true");
  std::ofstream(file) << text;
  try {
    deck::load_model(file, {});
    ADD_FAILURE() << "a run-up was taken as linear";
  } catch (const Error& e) {
    ASSERT_EQ(e.diagnostics().size(), 1u);
    EXPECT_EQ(e.diagnostics().front().code, "E39");
    EXPECT_NE(e.diagnostics().front().message.find("changes the speed"), std::string::npos);
  }
  fs::remove(file);
}
