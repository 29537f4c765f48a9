// The steps of a study that are no transients: the same deck on finer and finer meshes. What they
// write is compared: every table whose rows do not belong to nodes, column by column, relative to
// the largest value of its unit in the table; angles are left out, being anything where an
// amplitude vanishes.
#include <study/study_parts.hpp>
#include <steps/run_deck.hpp>
#include <study/study.hpp>
#include <core/error.hpp>
#include <io/results.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <set>

namespace whirl::study {

namespace {

/// Steps that a mesh study runs.
std::vector<model::Step> mesh_steps(const model::Model& m) {
  std::vector<model::Step> out;
  std::set<std::string> left_out;
  for (const model::Step& s : m.steps) {
    if (std::holds_alternative<model::TransientStep>(s.law) || left_out.count(s.from)) {
      left_out.insert(s.name);
      continue;
    }
    out.push_back(s);
    if (auto* stability = std::get_if<model::StabilityStep>(&out.back().law))
      stability->map.reset();
  }
  return out;
}

/// The numbers of all tables of a results folder.
std::vector<analysis::Quantity> quantities_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& f : std::filesystem::directory_iterator(folder))
    if (f.path().extension() == ".csv") files.push_back(f.path());
  std::sort(files.begin(), files.end());
  std::vector<analysis::Quantity> out;
  for (const auto& file : files) {
    const io::Columns c = io::read_csv(file);
    std::map<std::string, double> largest;
    for (std::size_t k = 0; k < c.names.size(); ++k)
      for (const double x : c.values[k])
        if (std::isfinite(x)) largest[c.units[k]] = std::max(largest[c.units[k]], std::abs(x));
    for (std::size_t k = 0; k < c.names.size(); ++k) {
      if (c.units[k] == "deg" || !(largest[c.units[k]] > 0)) continue;
      analysis::Quantity q{file.stem().string() + ": " + c.names[k], c.units[k], c.values[k],
                           largest[c.units[k]]};
      for (double& x : q.values)
        if (!std::isfinite(x)) x = 0.0;  // texts, and values that a row does not have
      out.push_back(std::move(q));
    }
  }
  return out;
}

}  // namespace

bool has_mesh_study(const model::Model& model) {
  return !mesh_steps(model).empty() && !meshes::make_mesh(model).elements.empty();
}

StudyPart study_meshes(const model::Model& model, const StudyOptions& options,
                       const std::filesystem::path& root) {
  model::Model base = model;
  base.steps = mesh_steps(model);
  base.output.report = base.output.binary = false;
  base.output.csv = true;
  base.output.vtk.clear();
  const meshes::Mesh mesh = meshes::make_mesh(model);
  run::RunOptions run = options.run;
  run.quiet = true;
  run.json = run.terminal = false;
  run.output = root / "mesh_study";
  const bool talk = !options.run.quiet;

  const auto elements = static_cast<long>(mesh.elements.size());
  int finest = 16;
  while (finest > 2 && finest * elements > 3000)
    finest /= 2;  // beyond, rounding is what is seen
  analysis::StudyOptions o;
  o.reference = {"", 0.0, 0.0, finest};
  o.cross_check = {"", 0.0, 0.0, finest / 2};
  for (int factor = 1; factor < finest; factor *= 2)
    o.ladder.push_back({"", 0.0, 0.0, factor});
  if (talk) print_study_head();
  o.progress = [&](const analysis::StudySample& s) {
    if (talk) print_study_sample(s);
  };

  const auto run_on = [&](int factor) {
    std::filesystem::remove_all(run.output);
    analysis::StudySample s;
    s.steps = elements * factor;
    const model::Model m = refined(base, mesh, factor);
    const std::clock_t start = std::clock();
    steps::run_deck(m, run);
    s.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    s.quantities = quantities_of(run.output);
    return s;
  };
  // tables with as many rows on every mesh: the others belong to nodes
  std::map<std::string, std::size_t> rows;
  for (const auto& q : run_on(1).quantities)
    rows[q.name] = q.values.size();
  bool first = true;
  const auto result = analysis::run_study(
      [&](const analysis::StudyCase& c) {
        analysis::StudySample s;
        try {
          s = run_on(c.mesh_factor);
          if (first)
            std::erase_if(rows, [&](const auto& r) {
              return std::none_of(s.quantities.begin(), s.quantities.end(), [&](const auto& q) {
                return q.name == r.first && q.values.size() == r.second;
              });
            });
          first = false;
          std::erase_if(s.quantities, [&](const auto& q) { return rows.count(q.name) == 0; });
        } catch (const Error& e) {
          s.ok = false;
          s.note = e.what();
        }
        return s;
      },
      o);
  std::filesystem::remove_all(run.output);
  StudyText text;
  text.stem = "study_mesh";
  text.heading = "Error of the mesh against run time";
  text.title = fmt::format("{}: error of the mesh against run time",
                           model.title.empty() ? model.deck_name : model.title);
  text.reference =
      fmt::format("{} elements, checked by {}", finest * elements, finest * elements / 2);
  return write_study(root, result, text, talk);
}

}  // namespace whirl::study
