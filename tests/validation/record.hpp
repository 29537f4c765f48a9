// Checks whose numbers go into docs/validation.md: each test leaves a file in $WHIRL_VALIDATION_DIR
// (if that is set) with what it compared; tests/validation/manual.py puts the files together.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace whirl::test {

class Record {
 public:
  /// case_name: heading of the manual. source: where the reference values come from.
  Record(const char* case_name, const char* source) {
    for (const char* part : {"# ", case_name, "\n> ", source, "\n"})
      text_ += part;
  }
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;
  ~Record() {
    const char* folder = std::getenv("WHIRL_VALIDATION_DIR");
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    if (!folder || !test) return;
    const std::string path =
        std::string(folder) + "/" + test->test_suite_name() + "." + test->name() + ".txt";
    if (std::FILE* f = std::fopen(path.c_str(), "w")) {
      std::fputs(text_.c_str(), f);
      std::fclose(f);
    } else {
      ADD_FAILURE() << "cannot write " << path;
    }
  }
  /// computed against reference, |difference| <= tolerance. what: one row of the manual; unit "-"
  /// for none. The computed value is written with the digits the tolerance lets mean something.
  void check(const std::string& what, const char* unit, double computed, double reference,
             double tolerance) {
    EXPECT_NEAR(computed, reference, tolerance) << what;
    const double size = std::max(std::abs(reference), tolerance);
    const int digits =
        std::clamp(static_cast<int>(std::ceil(std::log10(size / tolerance) - 1e-9)), 1, 12);
    char row[400];
    std::snprintf(row, sizeof row, "%s\t%s\t%.10g\t%#.*g\t%.1e\n", what.c_str(), unit, reference,
                  digits, computed, tolerance / size);
    text_ += row;
  }
  /// value that must stay below a limit (an error, a defect).
  void below(const std::string& what, const char* unit, double value, double limit) {
    EXPECT_LT(value, limit) << what;
    char row[400];
    std::snprintf(row, sizeof row, "%s\t%s\t< %.3g\t%s\t\n", what.c_str(), unit, limit,
                  std::abs(value) < limit ? "below" : "above");
    text_ += row;
  }

 private:
  std::string text_;
};

}  // namespace whirl::test
