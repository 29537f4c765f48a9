// The parts a study is made of: the deck's first transient over integrators, accuracies, steps and
// meshes; its other steps over meshes.
#pragma once
#include <analysis/study/study.hpp>
#include <run/options.hpp>
#include <study/study.hpp>
#include <io/report.hpp>
#include <io/value.hpp>
#include <meshes/mesh.hpp>

namespace whirl::study {

struct StudyPart {
  io::ReportSection section;
  io::Value json;
};

/// How a study is called and printed.
struct StudyText {
  std::string stem;  ///< of its files
  std::string heading, title;
  std::string reference;  ///< what the settings are measured against
  double target = 0;      ///< accuracy the deck asks for; 0: none
};
/// Writes stem.csv, stem.json and plots/stem.svg; prints orders and advice.
StudyPart write_study(const std::filesystem::path& root, const analysis::StudyResult& r,
                      const StudyText& text, bool talk);

/// One line a sample, as they come.
void print_study_head();
void print_study_sample(const analysis::StudySample& s);

/// The model with every flexible section split into `factor` times as many elements as the mesh has
/// there.
model::Model refined(const model::Model& m, const meshes::Mesh& mesh, int factor);

/// Step `which` must be a transient that starts by itself. Errors: E96, exact solution.
StudyPart study_transient(const model::Model& model, std::size_t which, const StudyOptions& options,
                          const run::RunOptions& run, const std::filesystem::path& root);
/// All steps that neither are transients nor start from one, over meshes; the tables they write are
/// compared with those of the finest.
StudyPart study_meshes(const model::Model& model, const StudyOptions& options,
                       const std::filesystem::path& root);
/// There are such steps, on elements.
bool has_mesh_study(const model::Model& model);

}  // namespace whirl::study
