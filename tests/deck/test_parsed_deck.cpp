// A deck parsed once: every reading of it is that of the file.
#include <deck/parsed_deck.hpp>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace whirl::deck {
namespace {

namespace fs = std::filesystem;

constexpr const char* text = R"(format = 1
[parameters]
length = 300
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["left", "${length} mm", 20], ["right", 300, 20]]
[[disk]]
name = "disk"
at = "left:end"
mass = "3 kg"
)";

class ParsedDeckTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path write(const std::string& content) const {
    std::ofstream(folder_ / "d.toml") << content;
    return folder_ / "d.toml";
  }
  fs::path folder_ = fs::temp_directory_path() / ("whirl_parsed_" + std::to_string(::getpid()));
};

TEST_F(ParsedDeckTest, EveryReadingIsThatOfTheFile) {
  const fs::path file = write(text);
  const ParsedDeck parsed(file);
  const std::vector<std::vector<std::string>> readings{{},
                                                       {"disk.disk.mass=5 kg"},
                                                       {"parameters.length=400"},
                                                       {"disk.disk.mass=much"},
                                                       {"disk.disc.mass=5 kg"},
                                                       {}};
  for (const std::vector<std::string>& set : readings) {
    const Deck once = parsed.read(set), anew = read_deck(file, {set});
    EXPECT_EQ(once.report(), anew.report());
    EXPECT_EQ(once.errors, anew.errors);
    EXPECT_EQ(once.model.resolved, anew.model.resolved);
    EXPECT_EQ(once.model.deck_path, anew.model.deck_path);
  }
  EXPECT_THROW((void)parsed.load({"disk.disk.mass=much"}), Error);
}

TEST_F(ParsedDeckTest, EveryReadingSaysWhatIsWrongWithTheText) {
  for (const char* wrong : {"format = 1\n[shaft\n", "format = 1\ninclude = [\"none.toml\"]\n",
                            "format = 1\n[shaft]\nlenght = 3\n", ""}) {
    const fs::path file = write(wrong);
    const ParsedDeck parsed(file);
    const std::string said = read_deck(file).report();
    EXPECT_FALSE(said.empty());
    for (int time = 0; time < 2; ++time)
      EXPECT_EQ(parsed.read({}).report(), said);
  }
  EXPECT_EQ(ParsedDeck(folder_ / "none.toml").read({}).report(),
            read_deck(folder_ / "none.toml").report());
}

}  // namespace
}  // namespace whirl::deck
