// A deck run by the program as a user would, in a folder of its own that goes with the object.
#pragma once
#include "../io/read_json.hpp"
#include "approved_runs.hpp"
#include "figure_faults.hpp"

#include <gtest/gtest.h>
#include <io/value.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace whirl::test {

/// Numbers of a CSV file with one header line; words are nan.
struct Columns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  explicit Columns(const std::filesystem::path& csv) {
    std::ifstream in(csv);
    std::string line;
    std::getline(in, line);
    names = cells_of(line);
    while (std::getline(in, line)) {
      rows.emplace_back();
      for (const std::string& cell : cells_of(line))
        rows.back().push_back(number(cell));
    }
  }
  static std::vector<std::string> cells_of(const std::string& line) { return csv_cells(line); }
  static double number(const std::string& cell) {
    char* end = nullptr;
    const double x = std::strtod(cell.c_str(), &end);
    return end == cell.c_str() ? std::nan("") : x;
  }
  std::size_t column(const std::string& name) const {
    for (std::size_t k = 0; k < names.size(); ++k)
      if (names[k] == name) return k;
    throw std::runtime_error("no column '" + name + "'");
  }
  std::map<std::string, double> named(const std::vector<double>& row) const {
    std::map<std::string, double> out;
    for (std::size_t k = 0; k < names.size() && k < row.size(); ++k)
      out[names[k]] = row[k];
    return out;
  }
  std::map<std::string, double> last() const {
    return rows.empty() ? std::map<std::string, double>{} : named(rows.back());
  }
  /// Mean of each column over the rows whose first cell is in [from, to).
  std::map<std::string, double> means(double from, double to) const {
    std::vector<double> sum(names.size(), 0.0);
    double count = 0;
    for (const auto& row : rows) {
      if (row.size() != names.size() || row[0] < from - 1e-9 || row[0] >= to - 1e-9) continue;
      ++count;
      for (std::size_t k = 0; k < row.size(); ++k)
        sum[k] += row[k];
    }
    for (double& x : sum)
      x /= count;
    return named(sum);
  }
};

/// `whirl run` on a deck given as text; results are in folder/r.
struct DeckRun {
  std::filesystem::path folder;
  int exit = -1;
  std::string log;
  explicit DeckRun(const std::string& deck) {
    make_folder();
    std::ofstream(folder / "d.toml") << deck;
    run("d.toml");
  }
  explicit DeckRun(const char* deck) : DeckRun(std::string(deck)) {}
  /// A deck where it stands, with the tables beside it.
  explicit DeckRun(const std::filesystem::path& deck) {
    make_folder();
    run(deck.string());
  }
  DeckRun(const DeckRun&) = delete;
  DeckRun& operator=(const DeckRun&) = delete;
  ~DeckRun() {
    std::error_code ec;
    std::filesystem::remove_all(folder, ec);
  }
  Columns csv(const std::string& name) const { return Columns(folder / "r" / name); }
  io::Value summary() const { return tests::read_json(folder / "r" / "summary.json"); }
  /// What the summary says of a step.
  io::Value summary(const std::string& step) const { return summary().at("steps").at(step); }
  bool says(const std::string& text) const { return log.find(text) != std::string::npos; }

 private:
  /// Another one for each object: several of one test live at once.
  void make_folder() {
    static int made = 0;
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::temp_directory_path() /
             ("whirl_" + std::string(test->test_suite_name()) + "_" + test->name() + "_" +
              std::to_string(::getpid()) + "_" + std::to_string(made++));
    std::filesystem::create_directories(folder);
  }
  void run(const std::string& deck) {
    const int status = std::system(("cd '" + folder.string() + "' && '" WHIRL_EXE "' run '" + deck +
                                    "' -o r >log.txt 2>&1 </dev/null")
                                       .c_str());
    exit = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    std::ostringstream text;
    text << std::ifstream(folder / "log.txt").rdbuf();
    log = text.str();
    // whatever a test looks at, its figures can be read
    for (const std::string& fault : figure_faults(folder / "r" / "plots"))
      ADD_FAILURE() << fault;
    compare_with_approved(deck);
  }
  /// A number that no test looks at does not change unseen.
  void compare_with_approved(const std::string& deck) const {
    std::ostringstream text;
    text << std::ifstream(folder / deck).rdbuf();
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    for (const std::string& what :
         differences_from_approved(test->test_suite_name(), text.str(), exit, folder / "r", log))
      ADD_FAILURE() << "not as approved: " << what
                    << " (where it is meant, tests/approved/update_runs.py approves it)\n"
                    << text.str();
  }
};

}  // namespace whirl::test
