// The benchmark: all groups in one run, ratios first; `make bench`.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "tests/bench/benches.hpp"

namespace {

constexpr const char* kHelp =
    "run [--quick] [--only GROUP] [--scenes N] [--trials N] [--json FILE] [--flags TEXT] [--commit "
    "TEXT]\n"
    "  --quick   small pictures, few turns: does it run? The figures mean nothing.\n"
    "  --only    kernels | fitness | handover | frame | acquisition | decision | accuracy | relief "
    "|\n"
    "            refraction | footprint | render | jitter\n"
    "  --scenes  of the acquisition and the decision, 60 unless told; each method sees all of "
    "them\n"
    "  --trials  of the accuracy, 16 for each pose and noise unless told\n"
    "  --json    writes the results to this file, too\n"
    "  --flags, --commit   how this was built, kept with the results\n";

struct Group {
  const char* name;
  void (*run)(const gannet::bench::Options&, gannet::bench::Results&);
};
constexpr Group kGroups[] = {{"kernels", gannet::bench::bench_kernels},
                             {"fitness", gannet::bench::bench_fitness},
                             {"handover", gannet::bench::bench_handover},
                             {"frame", gannet::bench::bench_frame},
                             {"acquisition", gannet::bench::bench_acquisition},
                             {"accuracy", gannet::bench::bench_accuracy},
                             {"relief", gannet::bench::bench_relief},
                             {"decision", gannet::bench::bench_decision},
                             {"refraction", gannet::bench::bench_refraction},
                             {"footprint", gannet::bench::bench_footprint},
                             {"render", gannet::bench::bench_render},
                             {"jitter", gannet::bench::bench_jitter}};

}  // namespace

int main(int argc, char** argv) {
  gannet::bench::Options options;
  std::string json, flags, commit, only;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    std::string* text = word == "--json"     ? &json
                        : word == "--flags"  ? &flags
                        : word == "--commit" ? &commit
                        : word == "--only"   ? &only
                                             : nullptr;
    if (word == "--quick") {
      options.quick = true;
    } else if (word == "--scenes" && i + 1 < argc && std::atoi(argv[i + 1]) > 0) {
      options.scenes = std::atoi(argv[++i]);
    } else if (word == "--trials" && i + 1 < argc && std::atoi(argv[i + 1]) > 1) {
      options.trials = std::atoi(argv[++i]);
    } else if (text != nullptr && i + 1 < argc) {
      *text = argv[++i];
    } else {
      std::fputs(kHelp, stderr);
      return 2;
    }
  }
  gannet::bench::Results results(gannet::bench::this_machine(flags, commit));
  bool known = only.empty();
  for (const Group& group : kGroups) {
    if (!only.empty() && only != group.name) continue;
    known = true;
    group.run(options, results);
  }
  if (!known) {
    std::fputs(kHelp, stderr);
    return 2;
  }
  results.tell_goals();
  if (json.empty()) return 0;
  if (results.write_json(json)) {
    std::printf("\nwritten to %s\n", json.c_str());
    return 0;
  }
  std::fprintf(stderr, "%s: cannot be written\n", json.c_str());
  return 1;
}
