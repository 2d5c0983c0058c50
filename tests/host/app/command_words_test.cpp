#include "host/app/command_words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "host/app/command_line.h"
#include "sw_model/base/error.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

using Words = std::vector<std::string>;

class CommandWords : public testing::Test {
 protected:
  CommandWords() {
    CLI::App& make = *app_.add_subcommand("make");
    make.add_option("FILE", file_);
    make.add_option("-o,--output", output_);
    make.add_option("--max-error", error_);
    make.add_flag("--polish,!--no-polish", polish_);
    app_.add_subcommand("verify");
  }

  Words checked(Words words) {
    words.insert(words.begin(), "program");
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    return checked_words(app_, pointers);
  }
  std::string refusal(const Words& words) {
    try {
      checked(words);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  CLI::App app_;
  std::string file_, output_, error_;
  bool polish_ = true;
};

TEST_F(CommandWords, ShortOptionsTakeTheirValueBehindAnEqualsSign) {
  EXPECT_EQ(checked({"make", "-o=x.ply", "in.ply"}), (Words{"make", "-o", "x.ply", "in.ply"}));
  EXPECT_EQ(checked({"make", "-o="}), (Words{"make", "-o", ""}));
  EXPECT_EQ(checked({"make", "-o=a=b"}), (Words{"make", "-o", "a=b"}));
  for (const Words& same : std::vector<Words>{{"make", "-o", "x.ply"},
                                              {"make", "-ox.ply"},
                                              {"make", "-o", "-o=x"},
                                              {"make", "--output=x.ply"},
                                              {"make", "--max-error", "-1", "--no-polish"},
                                              {"make", "--max-error", "--max-eror"},
                                              {"make", "--", "-o=x", "--max-eror"},
                                              {"make", "-1", "-"},
                                              {"make", "--help"},
                                              {"--help"},
                                              {}}) {
    EXPECT_EQ(checked(same), same);
  }
}

TEST_F(CommandWords, NamesTheOptionThatWasMeant) {
  EXPECT_EQ(refusal({"make", "--max-eror", "1%"}),
            "there is no option --max-eror: did you mean --max-error?; see emax make --help");
  EXPECT_EQ(refusal({"make", "--max-eror=1%"}), refusal({"make", "--max-eror", "1%"}));
  EXPECT_NE(refusal({"make", "--out", "x"}).find("did you mean --output?"), std::string::npos);
  EXPECT_NE(refusal({"make", "--unlike"}).find("--unlike; see"), std::string::npos);
  EXPECT_NE(refusal({"make", "-max-error", "1%"}).find("did you mean --max-error?"),
            std::string::npos);
  EXPECT_NE(refusal({"make", "--no-polsih"}).find("did you mean --no-polish?"), std::string::npos);
  EXPECT_NE(refusal({"make", "-x"}).find("-x"), std::string::npos);
  EXPECT_NE(refusal({"make", "--no\nsuch"}).find("no?such"), std::string::npos);
  EXPECT_EQ(refusal({"--hlep"}),
            "there is no option --hlep: did you mean --help?; see emax --help");
}

TEST_F(CommandWords, NamesTheCommandThatWasMeant) {
  EXPECT_EQ(refusal({"verfiy", "c.json"}),
            "there is no command 'verfiy': did you mean verify?; the commands are make, verify, "
            "see emax --help");
  EXPECT_EQ(refusal({"reconstruct"}),
            "there is no command 'reconstruct'; the commands are make, verify, see emax --help");
}

TEST(Closest, IsAtMostAThirdAway) {
  const Words names = {"--time", "--seed", "--budget"};
  EXPECT_EQ(closest("--tiem", names), "--time");
  EXPECT_EQ(closest("--buget", names), "--budget");
  EXPECT_EQ(closest("--sead", names), "--seed");
  EXPECT_EQ(closest("--colour", names), "");
  EXPECT_EQ(closest("--b", names), "") << "too little to tell";
  EXPECT_EQ(closest("--bu", names), "--budget");
  EXPECT_EQ(closest("", names), "");
  EXPECT_EQ(closest("ab", Words{"ac", "bb"}), "ac") << "the first of equals";
}

// All words one step away from `word` over the letters a and b.
std::set<std::string> one_step(const std::string& word) {
  std::set<std::string> words;
  for (std::size_t i = 0; i <= word.size(); ++i) {
    for (const char c : {'a', 'b'}) words.insert(word.substr(0, i) + c + word.substr(i));
    if (i == word.size()) continue;
    words.insert(word.substr(0, i) + word.substr(i + 1));
    for (const char c : {'a', 'b'}) words.insert(word.substr(0, i) + c + word.substr(i + 1));
    if (i + 1 < word.size()) {
      std::string exchanged = word;
      std::swap(exchanged[i], exchanged[i + 1]);
      words.insert(exchanged);
    }
  }
  words.erase(word);
  return words;
}

TEST(EditDistance, IsOneExactlyForTheWordsOneStepAway) {
  Words all = {""};
  for (std::size_t i = 0; all[i].size() < 5; ++i) {
    for (const char c : {'a', 'b'}) all.push_back(all[i] + c);
  }
  for (const std::string& a : all) {
    const std::set<std::string> near = one_step(a);
    for (const std::string& b : all) {
      const std::size_t distance = edit_distance(a, b);
      EXPECT_EQ(distance == 0, a == b) << a << ' ' << b;
      EXPECT_EQ(distance == 1, near.contains(b)) << a << ' ' << b;
      EXPECT_EQ(distance, edit_distance(b, a)) << a << ' ' << b;
    }
  }
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("ca", "abc"), 3u) << "no step changes what another has exchanged";
}

// Each is parsed as a person would give it; nothing runs.
TEST(Examples, OfEveryHelpAreCommands) {
  std::size_t examples = 0;
  CLI::App all;
  CommandLine all_lines;
  add_commands(all, all_lines);
  for (const CLI::App* command : all.get_subcommands({})) {
    std::istringstream footer(command->get_footer());
    for (std::string text; std::getline(footer, text);) {
      if (!text.starts_with("  emax ")) continue;
      const std::string example = text.substr(7, text.find("  ", 7) - 7);
      SCOPED_TRACE(example);
      EXPECT_TRUE(example.starts_with(command->get_name()));
      EXPECT_LE(text.size(), 100u);
      CLI::App app;
      CommandLine line;
      add_commands(app, line);
      EXPECT_NO_THROW(app.parse(example));
      EXPECT_TRUE(line.chosen);
      ++examples;
    }
  }
  EXPECT_GE(examples, 12u);
}

}  // namespace
}  // namespace emax::test
