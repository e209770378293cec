#include "src/config/loader.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "platform/base/random.hpp"
#include "src/config/printer.hpp"

namespace gannet::demo {

struct Fin {
  double x_m = 0.25;
  std::string side = "left";
  int joints = 3;
};
void describe(Visitor& v, Fin& c) {
  v.field("x_m", c.x_m, {.min = -2, .max = 2, .unit = "m", .help = "Position."});
  v.field("side", c.side, {.choices = {"left", "right"}, .help = "Side of the body."});
  v.field("joints", c.joints, {.min = 1, .help = "Joints | bends."});
}

struct Inner {
  bool wild = false;
  std::vector<double> weights = {0.1, 0.2};
};
void describe(Visitor& v, Inner& c) {
  v.field("wild", c.wild, {.help = "Whether it bites."});
  v.field("weights", c.weights, {.min = 0, .size = 2, .unit = "kg", .help = "Weights."});
}

struct Search {
  int population = 60;
  Inner inner;
  double share = 1.0 / 3;  // described after the group: a printer must put it before
};
void describe(Visitor& v, Search& c) {
  v.field("population", c.population,
          {.min = 4, .max = 4096, .unit = "individuals", .help = "Individuals kept."});
  v.group("inner", c.inner, "What is inside.");
  v.field("share", c.share, {.min = 0, .max = 1, .help = "Share."});
}

struct Fish {
  std::string name = "crab";
  std::vector<int> counts;
  std::vector<std::string> words = {"a"};
  Search search;
  std::vector<Fin> fins;
};
void describe(Visitor& v, Fish& c) {
  v.group("search", c.search, "The search.");
  v.list("fin", c.fins, "One table for each fin.");
  v.field("name", c.name, {.help = "Name."});
  v.field("counts", c.counts, {.help = "Counts."});
  v.field("words", c.words, {.help = "Words."});
}

}  // namespace gannet::demo

namespace gannet::config {
namespace {

using demo::Fish;

struct Loaded {
  Fish fish;
  Origins origins;
  std::string problems;
};

void load_text(const std::string& text, const std::string& name, Loaded& into) {
  const auto tree = parse_toml(text, name);
  if (!tree) {
    into.problems = tree.error().text;
    return;
  }
  Problems problems;
  load(*tree, name, into.fish, into.origins, problems);
  into.problems = problems.empty() ? "" : problems.error().text;
}

Loaded loaded(const std::string& text) {
  Loaded result;
  load_text(text, "demo.toml", result);
  return result;
}

TEST(Loader, reads_values_of_every_kind) {
  const Loaded sut = loaded(
      "format = 1\nname = \"eel\"\ncounts = [1, -2]\nwords = []\n"
      "search.population = 10\n[search.inner]\nwild = true\nweights = [1, 2.5]\n"
      "[[fin]]\nx_m = 1\n[[fin]]\nside = \"right\"\n");
  EXPECT_EQ(sut.problems, "");
  EXPECT_EQ(sut.fish.name, "eel");
  EXPECT_EQ(sut.fish.counts, (std::vector<int>{1, -2}));
  EXPECT_TRUE(sut.fish.words.empty());
  EXPECT_EQ(sut.fish.search.population, 10);
  EXPECT_TRUE(sut.fish.search.inner.wild);
  EXPECT_EQ(sut.fish.search.inner.weights, (std::vector<double>{1, 2.5}));
  ASSERT_EQ(sut.fish.fins.size(), 2u);
  EXPECT_EQ(sut.fish.fins[0].x_m, 1);
  EXPECT_EQ(sut.fish.fins[1].side, "right");
}

TEST(Loader, out_of_range_is_told_with_file_line_and_unit) {
  EXPECT_EQ(loaded("[search]\npopulation = 2\n").problems,
            "demo.toml:2: search.population: 2 individuals is outside [4, 4096]");
}

TEST(Loader, tells_all_problems_at_once_in_the_order_of_lines) {
  EXPECT_EQ(loaded("nam = \"x\"\n"
                   "words = [\"a\", 3]\n"
                   "counts = 1.5\n"
                   "[[fin]]\nx_m = inf\nside = \"lefty\"\n"
                   "[search]\npopulation = 99999999999\nshare = \"much\"\n"
                   "[search.inner]\nwild = 1\nweights = [1.0]\ncolour = 1\n")
                .problems,
            "demo.toml:1: nam: unknown key (did you mean name?)\n"
            "demo.toml:2: words[1]: expects a string, found a whole number\n"
            "demo.toml:3: counts: expects an array, found a number\n"
            "demo.toml:5: fin[0].x_m: is not a finite number\n"
            "demo.toml:6: fin[0].side: \"lefty\" is none of left, right (did you mean left?)\n"
            "demo.toml:8: search.population: 99999999999 individuals is outside [4, 4096]\n"
            "demo.toml:9: search.share: expects a number, found a string\n"
            "demo.toml:11: search.inner.wild: expects true or false, found a whole number\n"
            "demo.toml:12: search.inner.weights: has 1 elements instead of 2\n"
            "demo.toml:13: search.inner.colour: unknown key");
}

TEST(Loader, refuses_wrong_shapes) {
  EXPECT_EQ(loaded("search = 3\n").problems,
            "demo.toml:1: search: expects a table, found a whole number");
  EXPECT_EQ(loaded("[fin]\nx_m = 1\n").problems,
            "demo.toml:1: fin: expects an array, found a table");
  EXPECT_EQ(loaded("fin = [1]\n").problems,
            "demo.toml:1: fin[0]: expects a table, found a whole number");
  EXPECT_EQ(loaded("name = 2020-01-01\n").problems,
            "demo.toml:1: name: expects a string, found a date or time");
  EXPECT_EQ(loaded("counts = [3000000000]\n").problems,
            "demo.toml:1: counts[0]: 3000000000 is too large a number");
}

TEST(Loader, another_format_is_refused) {
  EXPECT_EQ(loaded("format = 2\n").problems,
            "demo.toml:1: format: 2 is not known; this program reads format 1");
  EXPECT_EQ(loaded("format = \"1\"\n").problems,
            "demo.toml:1: format: expects a whole number, found a string");
}

TEST(Loader, a_key_that_stands_twice_is_told_with_its_line) {
  const std::string problem = loaded("name = \"a\"\n\nname = \"b\"\n").problems;
  EXPECT_EQ(problem.substr(0, 12), "demo.toml:3:") << problem;
  EXPECT_EQ(problem.find('\n'), std::string::npos);
}

TEST(Loader, broken_toml_is_told_with_its_line) {
  for (const char* text :
       {"\n\nname = \n", "\n\n[search\n", "\n\nname = \"\x01\"\n", "\n\na b\n"}) {
    const std::string problem = loaded(text).problems;
    EXPECT_EQ(problem.substr(0, 11), "demo.toml:3") << problem;
  }
}

TEST(Loader, a_later_file_overrules_and_origins_tell_which) {
  Loaded sut;
  load_text("name = \"eel\"\n[[fin]]\nx_m = 1\njoints = 9\n[[fin]]\nx_m = 2\n", "one.toml", sut);
  load_text("\n\n[[fin]]\nx_m = 0.5\n", "two.toml", sut);
  EXPECT_EQ(sut.problems, "");
  ASSERT_EQ(sut.fish.fins.size(), 1u);
  EXPECT_EQ(sut.fish.fins[0].joints, 3) << "a new list begins from defaults";
  EXPECT_EQ(sut.origins.at("name").text(), "one.toml:1");
  EXPECT_EQ(sut.origins.at("fin[0].x_m").text(), "two.toml:4");
  EXPECT_EQ(sut.origins.count("fin[0].joints"), 0u);
  EXPECT_EQ(sut.origins.count("fin[1].x_m"), 0u);
  const std::string shown = values_with_origins(sut.fish, sut.origins);
  EXPECT_NE(shown.find("name = \"eel\"  # one.toml:1\n"), std::string::npos) << shown;
  EXPECT_NE(shown.find("fin[0].x_m = 0.5  # two.toml:4\n"), std::string::npos) << shown;
  EXPECT_NE(shown.find("search.population = 60  # built-in\n"), std::string::npos) << shown;
}

Fish random_fish(Random& random) {
  const auto number = [&] {
    const double scale[] = {1e-7, 1e-3, 1, 1e6, 1e18};
    return scale[random.below(5)] * (2 * random.uniform() - 1);
  };
  const char* const texts[] = {"", "a b", "\"quoted\" \\ back", "tab\tand\nline", "é ∞", "#"};
  Fish fish;
  fish.name = texts[random.below(6)];
  for (int i = random.below(4); i > 0; --i) fish.counts.push_back(random.below(2000) - 1000);
  for (int i = random.below(4); i > 0; --i) fish.words.push_back(texts[random.below(6)]);
  fish.search.population = 4 + random.below(4000);
  fish.search.share = random.uniform();
  fish.search.inner.wild = random.below(2) == 1;
  fish.search.inner.weights = {std::abs(number()), std::abs(number())};
  for (int i = random.below(3); i > 0; --i)
    fish.fins.push_back(
        {2 * random.uniform(), random.below(2) == 1 ? "left" : "right", 1 + random.below(9)});
  return fish;
}

TEST(FilePrinter, what_it_prints_loads_back_to_the_same_values) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Fish fish = random_fish(random);
    const std::string text = commented_file(fish);
    const Loaded sut = loaded(text);
    ASSERT_EQ(sut.problems, "") << text;
    EXPECT_EQ(commented_file(sut.fish), text);
    EXPECT_EQ(sut.fish.search.share, fish.search.share);
    EXPECT_EQ(sut.fish.search.inner.weights, fish.search.inner.weights);
    EXPECT_EQ(sut.fish.name, fish.name);
    EXPECT_EQ(sut.fish.fins.size(), fish.fins.size());
  }
}

TEST(FilePrinter, an_empty_list_is_shown_as_a_comment_to_copy) {
  const std::string text = commented_file(Fish{});
  EXPECT_NE(text.find("# [[fin]]\n"), std::string::npos) << text;
  EXPECT_NE(text.find("# x_m = 0.25\n"), std::string::npos) << text;
  EXPECT_NE(text.find("# Individuals kept. (individuals; 4 … 4096)\npopulation = 60\n"),
            std::string::npos)
      << text;
}

TEST(MarkdownPrinter, has_a_row_for_each_key) {
  const std::string text = markdown_reference(Fish{});
  EXPECT_NE(text.find("## `[search.inner]`"), std::string::npos) << text;
  EXPECT_NE(text.find("| `population` | int | `60` | individuals; 4 … 4096 | Individuals kept. |"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("## `[[fin]]`"), std::string::npos) << text;
  EXPECT_NE(text.find("Joints \\| bends."), std::string::npos) << text;
}

TEST(ManPrinter, has_an_entry_for_each_key) {
  const std::string text = man_reference(Fish{});
  EXPECT_NE(text.find(".SS [[fin]]\nOne table for each fin.\n"), std::string::npos) << text;
  EXPECT_NE(text.find(".TP\n.B population = 60\nIndividuals kept. (individuals; 4 … 4096)\n"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace gannet::config
