// What a run will need of the memory, before it is meshed. Against what runs take:
// tests/app/test_memory_limits.cpp.
#include <core/error.hpp>
#include <deck/deck.hpp>
#include <gtest/gtest.h>

using namespace whirl;

namespace {

std::string bearing(const std::string& name, const std::string& end) {
  return "[[bearing]]\nname = \"" + name + "\"\nat = \"a:" + end +
         "\"\ntype = \"linear\"\nkxx = \"1e7 N/m\"\nkyy = \"1e7 N/m\"\nkzz = \"1e7 N/m\"\n";
}

deck::Deck shaft_of(const std::string& elements, const std::string& step) {
  return deck::read_deck_text(
      "format = 1\n[shaft]\nname = \"rotor\"\nmaterial = \"steel\"\n"
      "columns = [\"name\", \"length[mm]\", \"od[mm]\", \"min_elements\"]\n"
      "rows = [[\"a\", 300, 40, " +
      elements + "]]\n" + bearing("A", "start") + bearing("B", "end") +
      "[output]\nreport = false\n[[step]]\nname = \"s\"\n" + step);
}

double megabytes(const std::string& elements, const std::string& step, int threads = 1) {
  const deck::Deck d = shaft_of(elements, step);
  EXPECT_TRUE(d.ok()) << d.report();
  return deck::estimate_memory(d.model, threads).total / 1e6;
}

const std::string still = "type = \"static\"\n";
const std::string response =
    "type = \"unbalance_response\"\nspeed = { start = \"1 rpm\", stop = \"9 rpm\", points = 100 "
    "}\n";

}  // namespace

TEST(MemoryEstimate, GrowsWithNodesThreadsAndSpeeds) {
  EXPECT_NEAR(megabytes("10000", still) - megabytes("1000", still), 9000 * 39e-3, 1.0);
  EXPECT_GT(megabytes("1000", response), 1.8 * megabytes("1000", still));
  EXPECT_GT(megabytes("1000", response, 4), 1.2 * megabytes("1000", response));
  std::string many = response;
  many.replace(many.find("100 }"), 3, "100000");
  EXPECT_GT(megabytes("10", many), megabytes("10", response) + 50);
  EXPECT_NEAR(megabytes("10", still), 15, 2);  // the program itself
}

// Several steps take what the largest takes, one after the other.
TEST(MemoryEstimate, IsThatOfTheLargestStep) {
  const std::string both = still + "[[step]]\nname = \"r\"\n" + response;
  EXPECT_DOUBLE_EQ(megabytes("1000", both), megabytes("1000", response));
}

TEST(MemoryEstimate, RefusesWithWhatTakesMost) {
  const deck::Deck d = shaft_of("10000", still);
  ASSERT_TRUE(d.ok()) << d.report();
  EXPECT_TRUE(deck::check_memory(d.model, 1, 8e8).empty());
  EXPECT_TRUE(deck::check_memory(d.model, 1, infinity).empty());
  const auto problems = deck::check_memory(d.model, 1, 1e8, true);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(format(problems[0]),
            "deck.toml:23:1: error[E44]: the run would take about 404.1 MB of memory (matrices of "
            "10003 nodes, 39 kB each: 390.1 MB), but the limit is 100.0 MB (--max-memory)\n"
            "     = hint: section 'a' of shaft 'rotor' alone has 10000 elements; --max-memory sets "
            "another limit, or none\n");
  const auto by_the_machine = deck::check_memory(d.model, 1, 1e8);
  ASSERT_EQ(by_the_machine.size(), 1u);
  EXPECT_NE(by_the_machine[0].message.find("only 100.0 MB are available"), std::string::npos);
}
