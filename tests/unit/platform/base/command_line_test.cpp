#include "platform/base/command_line.hpp"

#include <gtest/gtest.h>

namespace gannet {
namespace {

using Words = std::vector<std::string>;

const Command kCommand = {
    .name = "fish find",
    .summary = "a fish in a picture",
    .description = "Looks for a fish.\n\nTakes its time.",
    .options = {{.name = "photo", .letter = 'p', .value = "FILE", .required = true, .help = "A."},
                {.name = "json", .kind = ArgumentKind::kFlag, .help = "Print JSON."},
                {.name = "z-mm",
                 .kind = ArgumentKind::kNumbers,
                 .value = "NEAR:FAR",
                 .count = 2,
                 .min = 10,
                 .max = 9000,
                 .unit = "mm",
                 .preset = "400:1000",
                 .help = "Depths."},
                {.name = "roi",
                 .kind = ArgumentKind::kIntegers,
                 .value = "X,Y,W,H",
                 .count = 4,
                 .help = "Where."},
                {.name = "method",
                 .value = "NAME",
                 .choices = {"rm_ga", "gannet"},
                 .preset = "gannet",
                 .help = "How."},
                {.name = "seed",
                 .kind = ArgumentKind::kInteger,
                 .value = "N",
                 .min = 0,
                 .preset = "1",
                 .help = "Of chance."},
                {.name = "model", .value = "FILE", .repeats = true, .help = "What."}},
    .positionals = {{.name = "where", .help = "A place."},
                    {.name = "more", .repeats = true, .help = "More places."}},
    .example = "fish find -p a.png",
    .exit_codes = "0  found\n1  not found"};

Result<Arguments> parsed(const Words& words) { return parse(kCommand, words); }

std::string error_of(const Words& words) {
  const auto result = parsed(words);
  EXPECT_FALSE(result);
  return result ? "" : result.error().text;
}

TEST(CommandLine, presets_hold_where_nothing_is_given) {
  const auto sut = parsed({"-p", "a.png"});
  ASSERT_TRUE(sut) << sut.error().text;
  EXPECT_EQ(sut->text("photo"), "a.png");
  EXPECT_EQ(sut->numbers("z-mm"), (std::vector<double>{400, 1000}));
  EXPECT_EQ(sut->text("method"), "gannet");
  EXPECT_EQ(sut->integer("seed"), 1);
  EXPECT_FALSE(sut->given("seed"));
  EXPECT_FALSE(sut->flag("json"));
  EXPECT_TRUE(sut->integers("roi").empty());
  EXPECT_TRUE(sut->texts("model").empty());
  EXPECT_EQ(sut->text("where"), "");
}

TEST(CommandLine, values_are_taken_in_every_spelling) {
  const auto sut = parsed({"--photo=a.png", "--z-mm", "300.5:2e3", "--roi=1,2,-3,4", "--json",
                           "--model", "x", "--model=y", "here", "-1,2", "--", "--there"});
  ASSERT_TRUE(sut) << sut.error().text;
  EXPECT_EQ(sut->numbers("z-mm"), (std::vector<double>{300.5, 2000}));
  EXPECT_EQ(sut->integers("roi"), (std::vector<int>{1, 2, -3, 4}));
  EXPECT_EQ(sut->texts("model"), (Words{"x", "y"}));
  EXPECT_EQ(sut->text("where"), "here");
  EXPECT_EQ(sut->texts("more"), (Words{"-1,2", "--there"}));
  EXPECT_TRUE(sut->flag("json"));
}

TEST(CommandLine, all_problems_are_told_at_once_a_line_each) {
  EXPECT_EQ(error_of({"--seed", "-3", "--metod", "x", "--method", "rm_gaa", "--z-mm", "400"}),
            "fish find: --seed: -3 is not at least 0\n"
            "fish find: unknown option --metod (did you mean --method?)\n"
            "fish find: --method: 'rm_gaa' is none of rm_ga, gannet (did you mean rm_ga?)\n"
            "fish find: --z-mm: '400' is not of the form NEAR:FAR\n"
            "fish find: --photo is missing: A.");
}

TEST(CommandLine, wrong_values_are_refused) {
  const Words good = {"-p", "a.png"};
  const auto error = [&](Words more) {
    more.insert(more.begin(), good.begin(), good.end());
    return error_of(more).substr(11);
  };
  EXPECT_EQ(error({"--seed", "x"}), "--seed: 'x' is not a number");
  EXPECT_EQ(error({"--seed", "1.5"}), "--seed: '1.5' is not a whole number");
  EXPECT_EQ(error({"--seed", "99999999999"}), "--seed: '99999999999' is not a whole number");
  EXPECT_EQ(error({"--z-mm", "nan:1"}), "--z-mm: 'nan' is not a number");
  EXPECT_EQ(error({"--z-mm", "5:50"}), "--z-mm: 5 mm is not 10 to 9000");
  EXPECT_EQ(error({"--z-mm", "50:1e300"}), "--z-mm: 1e300 mm is not 10 to 9000");
  EXPECT_EQ(error({"--seed"}), "--seed needs a value: N");
  EXPECT_EQ(error({"--seed", "--json"}), "--seed needs a value: N");
  EXPECT_EQ(error({"--json=1"}), "--json takes no value");
  EXPECT_EQ(error({"--seed", "1", "--seed", "2"}), "--seed is given twice");
  EXPECT_EQ(error({"-x"}), "unknown option -x");
  EXPECT_EQ(error({"--model="}), "--model: is empty");
}

TEST(CommandLine, one_argument_too_many_is_refused) {
  const Command none = {.name = "fish", .summary = "s"};
  const auto result = parse(none, Words{"a"});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().text, "fish: 'a' is one argument too many");
}

TEST(CommandLine, help_tells_each_option_with_unit_range_and_example) {
  const std::string help = help_text(kCommand);
  for (const Argument& a : kCommand.options)
    EXPECT_NE(help.find("--" + a.name), std::string::npos) << a.name;
  EXPECT_NE(help.find("[mm, 10 to 9000; default 400:1000]"), std::string::npos) << help;
  EXPECT_NE(help.find("fish find -p a.png"), std::string::npos);
  EXPECT_NE(help.find("Usage: fish find --photo FILE [options] [where] [more …]"),
            std::string::npos)
      << help;
}

TEST(CommandLine, man_page_has_its_sections_and_escapes_what_roff_would_take) {
  Command command = kCommand;
  command.description = ".dot at the start\n'quote and a \\ backslash";
  const std::string page = man_page(command);
  EXPECT_NE(page.find(".TH fish-find 1"), std::string::npos);
  for (const char* section : {"NAME", "SYNOPSIS", "OPTIONS", "EXIT STATUS", "EXAMPLE"})
    EXPECT_NE(page.find(std::string(".SH ") + section), std::string::npos) << section;
  EXPECT_NE(page.find("\n\\&.dot"), std::string::npos);
  EXPECT_NE(page.find("\n\\&'quote and a \\e backslash"), std::string::npos);
  EXPECT_NE(page.find("\\-\\-z\\-mm NEAR:FAR"), std::string::npos);
}

}  // namespace
}  // namespace gannet
