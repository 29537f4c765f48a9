#include <app/commands.hpp>
#include <run/checkpoint.hpp>
#include <run/diagnose.hpp>
#include <run/memory_limit.hpp>
#include <steps/prepare.hpp>
#include <run/results_folder.hpp>
#include <steps/run_deck.hpp>
#include <core/parallel.hpp>
#include <core/units.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <plot/plots.hpp>
#include <io/results.hpp>
#include <plot/rotor_drawing.hpp>
#include <plot/svg.hpp>
#include <meshes/mass_properties.hpp>
#include <meshes/mesh.hpp>
#include <meshes/mesh_tables.hpp>
#include <meshes/scene.hpp>
#include <cmath>
#include <functional>
#include <string>

namespace whirl::app {
namespace {

const char* kind_of(const model::StepLaw& law) {
  static constexpr const char* names[] = {
      "static",    "modal",        "campbell",          "critical_speeds", "unbalance_response",
      "stability", "critical_map", "harmonic_response", "sensitivity",     "torsional",
      "buckling",  "transient",    "api_lateral",       "api_torsional",   "balancing"};
  static_assert(std::size(names) == std::variant_size_v<model::StepLaw>);
  return names[law.index()];
}

std::string count(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

/// What a run would write, as far as that is known before it.
std::string size_line(const model::Model& m) {
  const deck::OutputEstimate e = deck::estimate_output(m);
  std::string r;
  if (e.histories > 0)
    r += fmt::format("  histories: {} {}{}\n", e.at_most ? "at most" : "about",
                     deck::size_text(e.histories),
                     e.open ? " and a row at each accepted step of the others" : "");
  else if (e.open)
    r += "  histories: a row at each accepted step, whose number the run finds out\n";
  if (e.frames > 0)
    r += fmt::format("  pictures: {} {}, some {}\n", e.fewer_frames ? "up to" : "about",
                     count(static_cast<std::size_t>(std::lround(e.frames)), "frame", "frames"),
                     deck::size_text(e.pictures));
  constexpr double worth_saying = 5e8;
  const double memory = deck::estimate_memory(m, processors()).total;
  if (memory >= worth_saying) r += fmt::format("  memory: about {}\n", deck::size_text(memory));
  return r;
}

std::string summary(const model::Model& m, const meshes::Mesh& mesh) {
  std::string r = fmt::format("{}{}{}\n", m.deck_path, m.title.empty() ? "" : ": ", m.title);
  r += fmt::format("  {}, {}, {}, {}, {}, {}\n", count(m.shafts.size(), "shaft", "shafts"),
                   count(m.disks.size(), "disk", "disks"),
                   count(m.bearings.size(), "bearing", "bearings"),
                   count(m.unbalances.size(), "unbalance", "unbalances"),
                   count(mesh.nodes.size(), "node", "nodes"),
                   count(mesh.elements.size(), "shaft element", "shaft elements"));
  if (!m.cracks.empty()) r += fmt::format("  {}\n", count(m.cracks.size(), "crack", "cracks"));
  if (!m.joints.empty()) r += fmt::format("  {}\n", count(m.joints.size(), "joint", "joints"));
  r += fmt::format("  gravity {} m/s^2 along ({:g}, {:g}, {:g})\n",
                   units::format_number(m.gravity.norm()), m.gravity.x(), m.gravity.y(),
                   m.gravity.z());
  for (const auto& s : m.steps)
    r += fmt::format("  step '{}': {}{}\n", s.name, kind_of(s.law),
                     s.from.empty() ? "" : ", from '" + s.from + "'");
  if (m.steps.empty()) r += "  no steps: nothing to run\n";
  return r + size_line(m);
}

io::Value summary_value(const model::Model& m, const meshes::Mesh& mesh) {
  io::Value v = io::Value::object();
  v["title"] = m.title;
  v["deck"] = m.deck_path;
  v["sha256"] = run::deck_hash(m);
  v["nodes"] = mesh.nodes.size();
  v["elements"] = mesh.elements.size();
  v["shafts"] = io::Value::array();
  for (std::size_t k = 0; k < m.shafts.size(); ++k) {
    const auto p = meshes::shaft_mass(m, k);
    io::Value s = io::Value::object();
    s["name"] = m.shafts[k].name;
    s["length_m"] = m.shafts[k].length();
    s["sections"] = m.shafts[k].sections.size();
    s["mass_kg"] = p.mass;
    s["centre_x_m"] = p.centre().x();
    s["Ip_kg_m2"] = p.Ip();
    s["Id_kg_m2"] = p.Id();
    v["shafts"].push(std::move(s));
  }
  const auto names = [&](const char* key, const auto& list) {
    v[key] = io::Value::array();
    for (const auto& x : list)
      v[key].push(x.name);
  };
  names("disks", m.disks);
  names("bearings", m.bearings);
  names("probes", m.probes);
  v["steps"] = io::Value::array();
  for (const auto& s : m.steps) {
    io::Value t = io::Value::object();
    t["name"] = s.name;
    t["type"] = kind_of(s.law);
    v["steps"].push(std::move(t));
  }
  const auto e = deck::estimate_output(m);
  v["output_bytes"] = e.total();
  v["output_frames"] = e.frames;
  v["memory_bytes"] = deck::estimate_memory(m, processors()).total;
  return v;
}

void write_mesh(const model::Model& m, const meshes::Mesh& mesh,
                const std::filesystem::path& folder) {
  const io::ResultsFolder out(folder);
  out.write_text("nodes.csv", meshes::nodes_csv(mesh));
  out.write_text("elements.csv", meshes::elements_csv(m, mesh));
  out.write_text("stations.csv", meshes::stations_csv(mesh));
  for (const plot::Figure& f : plot::draw_model(m, mesh, meshes::make_scene(m, mesh)))
    out.write_text(f.name + ".svg", plot::render_svg(f));
}

/// The same deck with a key set otherwise.
std::function<model::Model(const std::string&)> variants_of(const std::filesystem::path& deck,
                                                            const deck::ReadOptions& options) {
  return [deck, options](const std::string& setting) {
    deck::ReadOptions read = options;
    read.set.push_back(setting);
    return deck::load_model(deck, read);
  };
}

/// The same with several.
std::function<model::Model(const std::vector<std::string>&)> builds_of(
    const std::filesystem::path& deck, const deck::ReadOptions& options) {
  return [deck, options](const std::vector<std::string>& settings) {
    deck::ReadOptions read = options;
    read.set.insert(read.set.end(), settings.begin(), settings.end());
    return deck::load_model(deck, read);
  };
}

/// Mesh and whatever else a run would refuse. Error: what it would.
meshes::Mesh prepare(const deck::Deck& d, const CheckOptions& o) {
  run::RunOptions run;
  run.max_memory = o.max_memory;
  run.max_disk = o.max_disk;
  run::check_memory(d.model, run);
  meshes::Mesh mesh = meshes::make_mesh(d.model);
  if (d.model.steps.empty()) return mesh;
  run.variant = variants_of(o.deck, o.read);
  run.build = builds_of(o.deck, o.read);
  run::states_to_keep(d.model, d.model.output.directory);
  steps::check_steps(d.model, mesh, run);
  return mesh;
}

}  // namespace

int check_deck(const CheckOptions& o) {
  const deck::Deck d = deck::read_deck(o.deck, o.read);
  if (!d.ok()) {
    if (o.json) {
      io::Value v = io::Value::object();
      v["ok"] = false;
      v["diagnostics"] = run::to_value(d.diagnostics);
      std::fputs(io::to_json(v).c_str(), stdout);
    } else {
      run::print_diagnostics(d, o.quiet);
    }
    return static_cast<int>(deck::exit_of(d.diagnostics));
  }
  meshes::Mesh mesh;
  try {
    mesh = prepare(d, o);
  } catch (const Error& e) {
    if (!o.json) throw;
    io::Value v = io::Value::object();
    v["ok"] = false;
    v["diagnostics"] = run::to_value(e.diagnostics());
    std::fputs(io::to_json(v).c_str(), stdout);
    return static_cast<int>(e.exit());
  }
  if (!o.mesh.empty()) write_mesh(d.model, mesh, o.mesh);
  if (o.resolved) {
    run::print_diagnostics(d, o.quiet);
    std::fputs(d.model.resolved.c_str(), stdout);
  } else if (o.json) {
    io::Value v = io::Value::object();
    v["ok"] = true;
    v["diagnostics"] = run::to_value(d.diagnostics);
    v["model"] = summary_value(d.model, mesh);
    std::fputs(io::to_json(v).c_str(), stdout);
  } else {
    run::print_diagnostics(d, o.quiet);
    if (!o.quiet)
      std::fputs((summary(d.model, mesh) + "\n" + meshes::station_table(d.model, mesh) + "\n" +
                  meshes::mass_table(d.model))
                     .c_str(),
                 stdout);
  }
  return static_cast<int>(Exit::ok);
}

int run_command(const RunCommand& o) {
  const deck::Deck d = deck::read_deck(o.deck, o.read);
  if (!d.ok() && o.run.json) {
    io::Value v = io::Value::object();
    v["ok"] = false;
    v["diagnostics"] = run::to_value(d.diagnostics);
    std::fputs(io::to_json(v).c_str(), stdout);
  } else {
    run::print_diagnostics(d, o.run.quiet);
  }
  if (!d.ok()) return static_cast<int>(deck::exit_of(d.diagnostics));
  if (d.model.steps.empty()) {
    Diagnostic e;
    e.code = "E35";
    e.message = "the deck has no step: there is nothing to run";
    e.hint = "add a [[step]]; `whirl check` looks at a model without steps";
    e.where.file = d.model.deck_path;
    throw Error(Exit::deck, std::move(e));
  }
  run::RunOptions run = o.run;
  run.variant = variants_of(o.deck, o.read);
  run.build = builds_of(o.deck, o.read);
  // the first one is the deck itself, which a run may stand beside
  for (int i = 1; i < d.sources.size(); ++i)
    run.inputs.emplace_back(d.sources[i].name);
  return steps::run_deck(d.model, run);
}

}  // namespace whirl::app
