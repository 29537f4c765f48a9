// Rows on the disk, statistics, and processes that crash or hang.
#include <sweep/confidence.hpp>
#include <sweep/outcome.hpp>
#include <sweep/response.hpp>
#include <sweep/rows.hpp>
#include <sweep/workers.hpp>
#include <core/error.hpp>
#include <core/types.hpp>
#include <gtest/gtest.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <thread>
#include <unistd.h>

namespace whirl::sweep {
namespace {

namespace fs = std::filesystem;

Row row_number(std::int64_t run) {
  return {
      run, 4, "E77", "a message\twith a tab", 0.25, {{1.0 / 3, "rpm", ""}, {nan, "", "no row"}}};
}

TEST(SweepRows, ReadBackWhatWasWritten) {
  const std::string line = line_of(row_number(12));
  const auto row = row_of(std::string_view(line).substr(0, line.size() - 1));
  ASSERT_TRUE(row);
  EXPECT_EQ(row->run, 12);
  EXPECT_EQ(row->exit, 4);
  EXPECT_EQ(row->code, "E77");
  EXPECT_EQ(row->message, "a message with a tab");
  ASSERT_EQ(row->answers.size(), 2u);
  EXPECT_EQ(row->answers[0].value, 1.0 / 3);
  EXPECT_EQ(row->answers[0].unit, "rpm");
  EXPECT_TRUE(std::isnan(row->answers[1].value));
  EXPECT_EQ(row->answers[1].failure, "no row");
}

TEST(SweepRows, DamagedAndUnfinishedLinesEndTheFile) {
  const fs::path file = fs::temp_directory_path() / ("whirl_rows_" + std::to_string(::getpid()));
  std::string text;
  for (int k = 0; k < 5; ++k)
    text += line_of(row_number(k));
  const std::string whole = text;
  for (std::size_t cut = 0; cut < text.size(); cut += 7) {
    std::ofstream(file, std::ios::binary) << text.substr(0, cut);
    const RowsRead read = read_rows(file);
    EXPECT_LE(read.bytes, cut);
    EXPECT_EQ(read.rows.size(),
              static_cast<std::size_t>(
                  std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(cut), '\n')));
  }
  text[text.find("E77", text.size() / 2)] = 'W';
  std::ofstream(file, std::ios::binary) << text;
  EXPECT_LT(read_rows(file).rows.size(), 4u);
  fs::remove(file);
}

TEST(SweepResponses, PickNumbersOutOfTables) {
  const fs::path folder =
      fs::temp_directory_path() / ("whirl_answers_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "t.csv") << "name [-],speed [rpm],gap\na,-3,1\nb,1,nan\nc,2,2\n";
  const auto value = [&](const char* text) { return answer(read_response(text), folder); };
  EXPECT_EQ(value("t:speed").value, -3);
  EXPECT_EQ(value("t:speed").unit, "rpm");
  EXPECT_EQ(value("x=t.csv:speed [rpm]:3").value, 2);
  EXPECT_EQ(value("t:speed:last").value, 2);
  EXPECT_EQ(value("t:speed:min").value, -3);
  EXPECT_EQ(value("t:speed:max").value, 2);
  EXPECT_EQ(value("t:speed:absmax").value, 3);
  EXPECT_EQ(value("t:speed:mean").value, 0);
  for (const char* text : {"t:gap:2", "t:speed:4", "t:sped", "u:speed", "t:name:max"})
    EXPECT_FALSE(value(text).failure.empty()) << text;
  EXPECT_EQ(value("t:name").word, "a");
  EXPECT_EQ(value("t:name:last").word, "c");
  EXPECT_TRUE(std::isnan(value("t:name").value));
  std::ofstream(folder / "summary.json")
      << R"({"steps": {"a": {"outcome": "end", "t_end [s]": 0.5, "ok": true, "x": "nan"}}, "l": [3, "w"]})";
  EXPECT_EQ(value("summary:steps.a.outcome").word, "end");
  EXPECT_EQ(value("summary:steps.a.t_end").value, 0.5);
  EXPECT_EQ(value("summary:steps.a.t_end [s]").unit, "s");
  EXPECT_EQ(value("summary:steps.a.ok").word, "true");
  EXPECT_EQ(value("summary:l.1").value, 3);
  EXPECT_EQ(value("summary:l.2").word, "w");
  for (const char* text : {"summary:steps", "summary:steps.a.x", "summary:steps.b.outcome"})
    EXPECT_FALSE(value(text).failure.empty()) << text;
  for (const char* text : {"t", ":speed", "t:", "t:speed:0", "t:speed:first", "../t:speed", "=t:x"})
    EXPECT_THROW(read_response(text), Error) << text;
  fs::remove_all(folder);
}

class ReducedColumns : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("whirl_reduced_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    std::ofstream(folder_ / "t.csv")
        << "a [-],b [-],c [-],d [-]\n1,1,nan,1\nnan,,nan,inf\n3,3,nan,2\nnan,word,nan,3\n";
  }
  void TearDown() override { fs::remove_all(folder_); }
  Answer value(const std::string& text, const NanMeaning& nan = {}) const {
    return answer(read_response(text), folder_, {{"t.csv", nan}});
  }
  fs::path folder_;
};

TEST_F(ReducedColumns, HaveNoValueWhereARowHasNone) {
  for (const char* pick : {"min", "max", "absmax", "mean"}) {
    const Answer a = value(std::string("t:a:") + pick, {"it is unstable", false});
    EXPECT_TRUE(std::isnan(a.value)) << pick;
    EXPECT_EQ(a.failure, "no finite value in 2 of 4 rows: it is unstable") << pick;
  }
  EXPECT_EQ(value("t:a:max").failure, "no finite value in 2 of 4 rows");
}

TEST_F(ReducedColumns, PassRowsByThatHaveNothingToGive) {
  EXPECT_EQ(value("t:a:max", {"no such mode", true}).value, 3);
  EXPECT_EQ(value("t:a:mean", {"no such mode", true}).value, 2);
  EXPECT_EQ(value("t:c:max", {"no such mode", true}).failure,
            "no value in the column is finite: no such mode");
}

TEST_F(ReducedColumns, TakeAnEmptyCellForNothingAndAWordForNoValue) {
  EXPECT_EQ(value("t:b:max").failure, "no finite value in 1 of 4 rows");
}

TEST_F(ReducedColumns, HaveNoValueWhereARowIsInfinite) {
  EXPECT_EQ(value("t:d:min", {"no such mode", true}).failure,
            "no finite value in 1 of 4 rows: no such mode");
}

TEST(SweepRows, WordsComeBack) {
  Row row;
  row.run = 3;
  for (const char* word : {"end time reached", "\"quoted\"", "nan", "3.5", "a,b"})
    row.answers.push_back({nan, "", "", word});
  row.answers.push_back({2.5, "m", ""});
  const std::string line = line_of(row);
  const auto again = row_of(std::string_view(line).substr(0, line.size() - 1));
  ASSERT_TRUE(again);
  for (std::size_t k = 0; k < row.answers.size(); ++k)
    EXPECT_EQ(again->answers[k].word, row.answers[k].word);
  EXPECT_EQ(again->answers.back().value, 2.5);
}

// L. D. Brown, T. T. Cai, A. DasGupta, Stat. Sci. 16 (2001) 101: the interval of Wilson.
TEST(SweepStatistics, BoundsOfShares) {
  const Interval half = bounds_of_share(5, 10), none = bounds_of_share(0, 10);
  EXPECT_NEAR(half.low, 0.236593, 1e-6);
  EXPECT_NEAR(half.high, 0.763407, 1e-6);
  EXPECT_EQ(none.low, 0);
  EXPECT_NEAR(none.high, 0.277533, 1e-6);
  EXPECT_EQ(bounds_of_share(7, 7).high, 1);
}

TEST(SweepStatistics, OfKnownSamples) {
  const Statistics s = statistics_of({4, 1, 3, 2, 5});
  EXPECT_DOUBLE_EQ(s.mean, 3);
  EXPECT_DOUBLE_EQ(s.deviation, std::sqrt(2.5));
  EXPECT_DOUBLE_EQ(s.median, 3);
  EXPECT_DOUBLE_EQ(s.p05, 1.2);
  EXPECT_DOUBLE_EQ(s.p95, 4.8);
  EXPECT_DOUBLE_EQ(s.least, 1);
  EXPECT_DOUBLE_EQ(s.largest, 5);
}

double plain_correlation(const std::vector<double>& x, const std::vector<double>& y) {
  return rank_correlation(x, y, std::vector<double>(x.size(), 1.0));
}

TEST(RankCorrelation, OfKnownSamples) {
  EXPECT_DOUBLE_EQ(plain_correlation({1, 2, 3, 4}, {1, 8, 27, 64}), 1);
  EXPECT_DOUBLE_EQ(plain_correlation({1, 2, 3, 4}, {4, 3, 2, 1}), -1);
  EXPECT_DOUBLE_EQ(plain_correlation({1, 2, 2, 3}, {1, 2, 2, 3}), 1);
  EXPECT_NEAR(plain_correlation({1, 2, 3}, {2, 1, 3}), 0.5, 1e-15);
  EXPECT_TRUE(std::isnan(plain_correlation({1, 1, 1}, {1, 2, 3})));
}

// A run of weight 3 is three runs.
TEST(RankCorrelation, CountsRunsByTheirWeights) {
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {2, 1, 4, 3}, {3, 1, 2, 0}),
              plain_correlation({1, 1, 1, 2, 3, 3}, {2, 2, 2, 1, 4, 4}), 1e-15);
}

TEST(SweepWorkers, CrashesAndHangsCostTheirOwnRun) {
  const std::vector<std::int64_t> tasks{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  std::map<std::int64_t, std::pair<Ended, int>> ended;
  std::map<std::int64_t, std::string> texts;
  const auto run = [](std::int64_t task, int) -> std::string {
    if (task == 3) {
      std::signal(SIGABRT, SIG_DFL);
      std::abort();
    }
    if (task == 5) std::this_thread::sleep_for(std::chrono::hours(1));
    if (task == 6) ::_exit(7);
    return "task " + std::to_string(task) + std::string(20000, 'x');  // more than a pipe's buffer
  };
  run_in_workers(tasks, {3, 2.0}, run,
                 [&](std::int64_t task, Ended how, const std::string& text, int signal) {
                   ended[task] = {how, signal};
                   texts[task] = text;
                 });
  ASSERT_EQ(ended.size(), tasks.size());
  for (const auto& [task, how] : ended) {
    if (task == 3)
      EXPECT_EQ(how, (std::pair{Ended::crashed, SIGABRT}));
    else if (task == 5)
      EXPECT_EQ(how.first, Ended::out_of_time);
    else if (task == 6)
      EXPECT_EQ(how, (std::pair{Ended::crashed, 0}));
    else
      EXPECT_EQ(texts[task], "task " + std::to_string(task) + std::string(20000, 'x'));
  }
}

TEST(SweepWorkers, TasksThatWaitBehindACrashAreDoneOnce) {
  std::vector<std::int64_t> tasks(300);
  std::iota(tasks.begin(), tasks.end(), std::int64_t{0});
  const auto crashes = [](std::int64_t task) { return task % 7 == 3; };
  const auto run = [&](std::int64_t task, int) -> std::string {
    if (crashes(task)) ::_exit(7);
    return std::to_string(task);
  };
  std::map<std::int64_t, int> seen;
  run_in_workers(tasks, {2, 0}, run,
                 [&](std::int64_t task, Ended how, const std::string& text, int) {
                   ++seen[task];
                   EXPECT_EQ(how, crashes(task) ? Ended::crashed : Ended::answered) << task;
                   EXPECT_EQ(text, crashes(task) ? "" : std::to_string(task));
                 });
  ASSERT_EQ(seen.size(), tasks.size());
  for (const auto& [task, times] : seen)
    EXPECT_EQ(times, 1) << task;
}

}  // namespace
}  // namespace whirl::sweep
