// Results of two things in one file: the first ones would be gone without a word.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>

using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

std::string deck(const std::string& rest) {
  return "format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 m/s^2\"\n"
         "[[shaft]]\nname = \"s\"\nmaterial = \"steel\"\ncolumns = [\"name\", \"length[mm]\", "
         "\"od[mm]\"]\n"
         "rows = [[\"a\", 500, 40]]\n"
         "[[bearing]]\nat = \"a:start\"\ntype = \"linear\"\nkxx = \"1e8 N/m\"\nkyy = \"1e7 "
         "N/m\"\nkzz = \"1e7 "
         "N/m\"\ncyy = \"500 N.s/m\"\nczz = \"500 N.s/m\"\n"
         "[[bearing]]\nat = \"a:end\"\ntype = \"linear\"\nkyy = \"1e7 N/m\"\nkzz = \"1e7 N/m\"\n"
         "[[unbalance]]\nat = \"a:mid\"\namount = \"20 g.mm\"\n" +
         rest;
}

std::string probe(const std::string& name) {
  return fmt::format("[[probe]]\nname = \"{}\"\nat = \"a:mid\"\n", name);
}

std::string transient(const std::string& name) {
  return fmt::format("[[step]]\nname = \"{}\"\ntype = \"transient\"\nduration = \"5 ms\"\n", name);
}

std::string modal(const std::string& name, const std::string& speed) {
  return fmt::format("[[step]]\nname = \"{}\"\ntype = \"modal\"\nspeed = \"{}\"\nmodes = 4\n", name,
                     speed);
}

}  // namespace

TEST(FileNames, NamesOfAnyScriptHaveFilesOfTheirOwn) {
  const DeckRun run(deck(probe("опора А") + probe("опора Б") + modal("加速", "0 rpm") +
                         modal("减速", "60000 rpm") + transient("разгон") + transient("выбег")));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns still = run.csv("加速_modes.csv"), fast = run.csv("减速_modes.csv");
  const std::size_t frequency = still.column("frequency [Hz]");
  EXPECT_GT(fast.rows.back()[frequency], still.rows.back()[frequency]);
  for (const char* name : {"разгон", "выбег"})
    EXPECT_TRUE(
        std::filesystem::exists(run.folder / "r" / "checkpoint" / fmt::format("{}.whirl", name)))
        << name;
}

TEST(FileNames, NamesThatBecomeOneAreRefused) {
  for (const std::string& rest :
       {modal("3000 rpm", "0 rpm") + modal("3000_rpm", "1 rpm"),
        probe("A 1") + probe("A_1") + modal("m", "0 rpm"),
        modal("x", "0 rpm") + transient("x_modes"), transient("t") + transient("t_peaks"),
        std::string("[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { start = \"10 "
                    "rpm\", stop = "
                    "\"90 rpm\", points = 2 }\n") +
            transient("u_response")}) {
    const DeckRun run(deck(rest));
    EXPECT_EQ(run.exit, 3) << rest << run.log;
    EXPECT_TRUE(run.says("E16")) << rest << run.log;
  }
  // alike, but never one file
  const DeckRun run(deck(modal("run", "0 rpm") + transient("run_up") + transient("run_peaks")));
  EXPECT_EQ(run.exit, 0) << run.log;
}
