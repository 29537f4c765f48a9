// One self-contained page of a run: no network, no third-party script. Figures are inline SVG; a
// small script of our own adds readout, zoom, pan, legend toggles and turning of 3-D figures.
// Without scripts it is still a complete page.
#pragma once
#include <plot/plot.hpp>
#include <io/results.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace whirl::io {

struct ReportSection {
  std::string title;  ///< "Step 'run_up': transient"
  std::string text;   ///< plain paragraphs, blank line between them
  std::vector<Table> tables;
  std::vector<plot::Figure> figures;
  std::vector<std::pair<std::string, std::string>> files;  ///< title, path relative to the report
};

struct Report {
  std::string title;
  std::string subtitle;  ///< deck name, date, version
  std::vector<std::pair<std::string, std::string>>
      title_block;  ///< name and text: project, machine, author, ..
  std::vector<std::pair<std::string, std::string>>
      facts;  ///< headline numbers: name, value with unit
  std::vector<std::string> warnings;
  std::vector<ReportSection> sections;  ///< in the order of the steps
  std::string deck;                     ///< resolved deck, shown folded
  Value summary;                        ///< shown as nested tables, folded
};

/// threads: that draw figures side by side; 0 = all processors. The page does not depend on it.
std::string render_report(const Report& report, int threads = 1);
/// Writes it atomically.
/// @throws Error (Exit::io) when it cannot be written.
void write_report(const std::filesystem::path& file, const Report& report, int threads = 1);

}  // namespace whirl::io
