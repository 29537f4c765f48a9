// A deck given as text, built; and an observer of how far a node goes.
#pragma once
#include <analysis/steady_rotation.hpp>
#include <analysis/transient/transient.hpp>
#include <assembly/build_system.hpp>
#include <deck/deck.hpp>

#include "../app/lateral_mass.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

namespace whirl::test {

constexpr double rpm = pi / 30;

struct DeckModel {
  deck::Deck deck;
  meshes::Mesh mesh;
  assembly::Built built;
  explicit DeckModel(const std::string& text) : deck(deck::read_deck_text(text, "deck.toml")) {
    if (!deck.ok()) throw std::runtime_error(deck.report());
    mesh = meshes::make_mesh(deck.model);
    built = assembly::build_system(deck.model, mesh);
  }
  analysis::SteadyRotation running() const {
    analysis::SteadyRotation r;
    for (const auto& s : deck.model.shafts)
      r.ratio.push_back(s.rotating ? s.speed_ratio : 0.0);
    r.table_frequencies = built.table_frequencies;
    r.axially_free = built.axially_free;
    return r;
  }
  /// Node of the first disk.
  Index disk() const { return mesh.place(deck.model.disks[0].at).node; }
};

/// Largest distance of a node from `centre` in each window of time and when it was first reached,
/// with extremes and mean of its (y, z) there (the mean of steps that lie wholly in the window).
struct Windows final : analysis::Observer {
  Index node;
  Vec2 centre;
  std::vector<std::array<double, 2>> windows;
  std::vector<double> peak, peak_time, span;
  std::vector<Vec2> least, most, mean;
  double dissipated_least = infinity;
  Windows(Index n, Vec2 c, std::vector<std::array<double, 2>> w)
      : node(n),
        centre(c),
        windows(std::move(w)),
        peak(windows.size(), 0.0),
        peak_time(windows.size(), 0.0),
        span(windows.size(), 0.0),
        least(windows.size(), Vec2::Constant(infinity)),
        most(windows.size(), Vec2::Constant(-infinity)),
        mean(windows.size(), Vec2::Zero()) {}
  void look(const analysis::Snapshot& s) {
    const Vec2 u = s.node(node).u.tail<2>();
    for (std::size_t k = 0; k < windows.size(); ++k)
      if (s.t() >= windows[k][0] && s.t() <= windows[k][1]) {
        if (const double away = (u - centre).norm(); away > peak[k]) {
          peak[k] = away;
          peak_time[k] = s.t();
        }
        least[k] = least[k].cwiseMin(u);
        most[k] = most[k].cwiseMax(u);
      }
    dissipated_least = std::min(dissipated_least, s.energy().dissipated);
  }
  void begin(const analysis::Snapshot& s) override { look(s); }
  void step(analysis::StepAccess& s) override {
    const double dt = s.t1() - s.t0();
    for (int k = 1; k <= 8; ++k)
      look(s.at(s.t0() + dt * k / 8));  // peaks of a smooth orbit to 1e-3 of the step's arc
    for (std::size_t k = 0; k < windows.size(); ++k) {
      if (s.t0() < windows[k][0] || s.t1() > windows[k][1]) continue;
      Vec2 sum = Vec2::Zero();
      for (int i = 0; i < 8; ++i)
        sum += s.at(s.t0() + dt * (i + 0.5) / 8).node(node).u.tail<2>();
      span[k] += dt;
      mean[k] += (dt / span[k]) * (sum / 8 - mean[k]);
    }
  }
};

}  // namespace whirl::test
