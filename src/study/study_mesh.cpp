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

/// The deck's steps on meshes of several finenesses.
class MeshRuns {
 public:
  MeshRuns(const model::Model& model, const StudyOptions& options,
           const std::filesystem::path& root);
  ~MeshRuns() { std::filesystem::remove_all(run_.output); }
  MeshRuns(const MeshRuns&) = delete;
  MeshRuns& operator=(const MeshRuns&) = delete;
  long elements() const { return static_cast<long>(mesh_.elements.size()); }
  /// Of the finest mesh: beyond 3000 elements rounding is what is seen.
  int finest() const;
  analysis::StudySample operator()(const analysis::StudyCase& c);

 private:
  analysis::StudySample run_on(int factor) const;
  void drop_rows_unlike(const analysis::StudySample& s);

  model::Model base_;
  meshes::Mesh mesh_;
  run::RunOptions run_;
  /// Tables with as many rows on every mesh: the others belong to nodes.
  std::map<std::string, std::size_t> rows_;
  bool first_ = true;
};

MeshRuns::MeshRuns(const model::Model& model, const StudyOptions& options,
                   const std::filesystem::path& root)
    : base_(model),
      mesh_(meshes::make_mesh(model)),
      run_(options.run) {
  base_.steps = mesh_steps(model);
  base_.output.report = base_.output.binary = false;
  base_.output.csv = true;
  base_.output.vtk.clear();
  run_.quiet = true;
  run_.json = run_.terminal = false;
  run_.output = root / "mesh_study";
  for (const auto& q : run_on(1).quantities)
    rows_[q.name] = q.values.size();
}

int MeshRuns::finest() const {
  int factor = 16;
  while (factor > 2 && factor * elements() > 3000)
    factor /= 2;
  return factor;
}

analysis::StudySample MeshRuns::run_on(int factor) const {
  std::filesystem::remove_all(run_.output);
  analysis::StudySample s;
  s.steps = elements() * factor;
  const model::Model m = refined(base_, mesh_, factor);
  const std::clock_t start = std::clock();
  steps::run_deck(m, run_);
  s.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  s.quantities = quantities_of(run_.output);
  return s;
}

void MeshRuns::drop_rows_unlike(const analysis::StudySample& s) {
  std::erase_if(rows_, [&](const auto& r) {
    return std::none_of(s.quantities.begin(), s.quantities.end(), [&](const auto& q) {
      return q.name == r.first && q.values.size() == r.second;
    });
  });
}

analysis::StudySample MeshRuns::operator()(const analysis::StudyCase& c) {
  analysis::StudySample s;
  try {
    s = run_on(c.mesh_factor);
    if (first_) drop_rows_unlike(s);
    first_ = false;
    std::erase_if(s.quantities, [&](const auto& q) { return rows_.count(q.name) == 0; });
  } catch (const Error& e) {
    s.ok = false;
    s.note = e.what();
  }
  return s;
}

}  // namespace

bool has_mesh_study(const model::Model& model) {
  return !mesh_steps(model).empty() && !meshes::make_mesh(model).elements.empty();
}

StudyPart study_meshes(const model::Model& model, const StudyOptions& options,
                       const std::filesystem::path& root) {
  const bool talk = !options.run.quiet;
  if (talk) print_study_head();
  MeshRuns runs(model, options, root);
  const int finest = runs.finest();
  analysis::StudyOptions o;
  o.reference = {"", 0.0, 0.0, finest};
  o.cross_check = {"", 0.0, 0.0, finest / 2};
  for (int factor = 1; factor < finest; factor *= 2)
    o.ladder.push_back({"", 0.0, 0.0, factor});
  o.progress = [&](const analysis::StudySample& s) {
    if (talk) print_study_sample(s);
  };
  const analysis::StudyResult result =
      analysis::run_study([&](const analysis::StudyCase& c) { return runs(c); }, o);
  StudyText text;
  text.stem = "study_mesh";
  text.heading = "Error of the mesh against run time";
  text.title = fmt::format("{}: error of the mesh against run time",
                           model.title.empty() ? model.deck_name : model.title);
  text.reference = fmt::format("{} elements, checked by {}", finest * runs.elements(),
                               finest * runs.elements() / 2);
  return write_study(root, result, text, talk);
}

}  // namespace whirl::study
